#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/tracking/tracked_twin.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Chi-square that sums of the columns (n x c) leave of values of weights w (Gram and Schmidt). Infinite
/// where the second column does not differ from the first.
double calcLeft(MatrixXd columns, VectorXd values, const VectorXd& weights) {
  constexpr double kVaries = 1e-12;
  for (Index c = 0; c < columns.cols(); ++c) {
    const double before = weights.dot(columns.col(c).cwiseAbs2());
    for (Index done = 0; done < c; ++done) {
      const VectorXd along = columns.col(done);
      columns.col(c) -= (weights.array() * along.array() * columns.col(c).array()).sum() * along;
    }
    const double square = weights.dot(columns.col(c).cwiseAbs2());
    if (!(square > kVaries * before)) {
      if (c == 1) {
        return std::numeric_limits<double>::infinity();
      }
      columns.col(c).setZero();
      continue;
    }
    columns.col(c) /= std::sqrt(square);
    values -= (weights.array() * columns.col(c).array() * values.array()).sum() * columns.col(c);
  }
  return weights.dot(values.cwiseAbs2());
}

/// Of what a step or a line is.
double calcLeftOf(const VectorXd& x, const VectorXd& values, const VectorXd& weights) {
  MatrixXd columns(x.size(), 2);
  columns << VectorXd::Ones(x.size()), x;
  return calcLeft(std::move(columns), values, weights);
}

/// Of a parabola, which has as many numbers as a step with its time.
double calcLeftOfCurve(const VectorXd& x, const VectorXd& values, const VectorXd& weights) {
  MatrixXd columns(x.size(), 3);
  const VectorXd off = x.array() - x.mean();
  columns << VectorXd::Ones(x.size()), off, off.cwiseAbs2();
  return calcLeft(std::move(columns), values, weights);
}

/// The values of a covariate; empty where a measurement lacks it.
VectorXd collect(const std::vector<const CourseSample*>& samples, const std::string& name) {
  VectorXd values(static_cast<Index>(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::vector<Covariate>& covariates = samples[i]->covariates;
    const auto found = std::find_if(covariates.begin(), covariates.end(),
                                    [&](const Covariate& covariate) { return covariate.name == name; });
    if (found == covariates.end()) {
      return {};
    }
    values[static_cast<Index>(i)] = found->value;
  }
  return values;
}

}  // namespace

std::vector<std::string> findRivals(const std::deque<CourseSample>& course, const tracking::Change& change) {
  const double as_likely = 2.0 * std::log(20.0);  // of chi-square
  const Index j = change.parameter;
  std::vector<const CourseSample*> samples;
  for (const CourseSample& sample : course) {
    if (std::isfinite(sample.variances[j])) {
      samples.push_back(&sample);
    }
  }
  std::vector<std::string> rivals;
  if (samples.empty()) {
    return rivals;
  }
  const auto n = static_cast<Index>(samples.size());
  VectorXd values(n), weights(n), step(n);
  for (Index i = 0; i < n; ++i) {
    const CourseSample& sample = *samples[static_cast<std::size_t>(i)];
    values[i] = sample.estimate[j];
    weights[i] = 1.0 / sample.variances[j];
    step[i] = sample.time >= change.time ? 1.0 : 0.0;
  }
  const double left = calcLeftOf(step, values, weights);
  // of a parameter that scatters by more than its measurements say, differences count for less
  const double scatter = std::max(1.0, left / std::max(1.0, static_cast<double>(n - 3)));
  for (const Covariate& covariate : samples.back()->covariates) {
    const VectorXd x = collect(samples, covariate.name);
    if (x.size() > 0 && calcLeftOfCurve(x, values, weights) < left + as_likely * scatter) {
      rivals.push_back(covariate.name);
    }
  }
  return rivals;
}

std::vector<std::string> findRecurringRivals(const std::vector<TrackAlarm>& alarms, double since) {
  constexpr std::ptrdiff_t kRecurs = 2;
  std::vector<std::string> named, recurring;
  for (const TrackAlarm& alarm : alarms) {
    if (alarm.announced >= since) {
      named.insert(named.end(), alarm.rivals.begin(), alarm.rivals.end());
    }
  }
  for (const std::string& name : named) {
    if (std::count(named.begin(), named.end(), name) >= kRecurs &&
        std::find(recurring.begin(), recurring.end(), name) == recurring.end()) {
      recurring.push_back(name);
    }
  }
  return recurring;
}

}  // namespace twinmap
