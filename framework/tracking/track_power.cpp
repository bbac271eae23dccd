#include "framework/tracking/track_power.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/random/random.hpp"
#include "framework/base/text/csv.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "kernels/linalg/order.hpp"
#include "kernels/tracking/tracker.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kLives = 20, kBefore = 30, kLongest = 100;
constexpr double kMeasured = 0.01;  // of the prior's width: it is forgotten after the first measurement

tracking::Model makeModel(Index parameters, double false_alarms) {
  tracking::Model model;
  model.drifts.resize(static_cast<std::size_t>(parameters));
  model.mean = VectorXd::Zero(parameters);
  model.covariance = MatrixXd::Identity(parameters, parameters);
  model.false_alarms = false_alarms;
  return model;
}

/// Measurements to the first alarm behind the change; kLongest + 1 of none.
double live(const tracking::Model& model, const AlarmDelay& change, const RandomStream& random,
            std::uint64_t life) {
  const Index p = model.countParameters();
  tracking::Tracker tracker(model);
  tracking::Measurement measurement{0.0, MatrixXd::Identity(p, p) / kMeasured, VectorXd(p),
                                    VectorXd::Constant(p, kMeasured * kMeasured), VectorXd()};
  for (int i = 0; i < kBefore + kLongest; ++i) {
    const int after = i - kBefore + 1;
    measurement.time = i;
    random.drawNormals(life, static_cast<std::uint64_t>(i), measurement.values.data(),
                       static_cast<std::size_t>(p));
    measurement.values[0] += after > 0 ? change.size * (change.is_slope ? after : 1) : 0.0;
    const bool is_alarm = tracker.advance(measurement).change.has_value();
    if (is_alarm && after > 0) {
      return after;
    }
  }
  return kLongest + 1;
}

/// The value that a share of the delays is at most; NaN of none.
double takeQuantile(const std::vector<double>& sorted, double share) {
  const auto place = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size()))) - 1;
  return sorted[place] <= kLongest ? sorted[place] : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::vector<AlarmDelay> calcAlarmDelays(Index parameters, double false_alarms, std::uint64_t seed) {
  const tracking::Model model = makeModel(parameters, false_alarms);
  const RandomStream random(seed, RandomPurpose::kTrustPower);
  std::vector<AlarmDelay> changes{{false, 1.0}, {false, 2.0}, {false, 3.0},
                                  {false, 5.0}, {true, 0.1},  {true, 0.5}};
  std::uint64_t life = 0;
  for (AlarmDelay& change : changes) {
    std::vector<double> delays(kLives);
    for (double& delay : delays) {
      delay = live(model, change, random, life++);
    }
    std::sort(delays.begin(), delays.end());
    change.median = takeQuantile(delays, 0.5);
    change.upper = takeQuantile(delays, 0.95);
    change.found = static_cast<double>(
                       std::count_if(delays.begin(), delays.end(), [](double d) { return d <= kLongest; })) /
                   kLives;
  }
  return changes;
}

namespace {

/// p: standard deviations of a measurement given all other parameters, at the median of the samples.
VectorXd calcStddevs(const Estimates& tests) {
  const Index p = tests.stddev.rows(), n = tests.stddev.cols();
  MatrixXd conditional(p, n);
  for (Index i = 0; i < n; ++i) {
    const std::size_t place = tests.correlations.size() > 1 ? static_cast<std::size_t>(i) : 0;
    const MatrixXd correlation =
        tests.correlations.empty() ? MatrixXd::Identity(p, p) : tests.correlations[place];
    const MatrixXd information = linalg::solveSemidefinite(correlation, MatrixXd::Identity(p, p));
    conditional.col(i) = tests.stddev.col(i).cwiseQuotient(information.diagonal().cwiseMax(1.0).cwiseSqrt());
  }
  VectorXd stddevs(p);
  for (Index j = 0; j < p; ++j) {
    stddevs[j] = calcMedian(VectorXd(conditional.row(j)));
  }
  return stddevs;
}

std::string write(double number) {
  return std::isfinite(number) ? fmt::format("{}", number) : "";
}

}  // namespace

std::string makeTrackPowerCsv(const std::vector<ParameterSpec>& parameters, const Estimates& tests,
                              std::uint64_t seed) {
  constexpr double kFalseAlarms = 1e-3;
  std::vector<CsvRow> rows{
      {"parameter", "change", "size", "unit", "size_in_sds", "delay_median", "delay_95", "found"}};
  const VectorXd stddevs = calcStddevs(tests);
  const std::vector<AlarmDelay> delays = calcAlarmDelays(tests.stddev.rows(), kFalseAlarms, seed);
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const ParameterSpec& parameter = parameters[j];
    for (const AlarmDelay& change : delays) {
      const double size = change.size * stddevs[static_cast<Index>(j)];
      if (size < parameter.bounds.upper - parameter.bounds.lower) {
        rows.push_back({parameter.name.text, change.is_slope ? "slope" : "step", write(size), parameter.unit,
                        write(change.size), write(change.median), write(change.upper), write(change.found)});
      }
    }
  }
  return makeCsv(rows);
}

}  // namespace twinmap
