#include "framework/report/sections/calibration_tables.hpp"

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>

#include "framework/analysis/calibration.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "framework/report/sections/samples_table.hpp"

namespace twinmap {
namespace {

/// Quantiles of the k-th of n sorted uniform numbers, k = 1 ... n: a beta distribution.
double calcOrderQuantile(int k, int n, double probability) {
  using Double = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
  return boost::math::quantile(boost::math::beta_distribution<double, Double>(k, n - k + 1), probability);
}

/// Quantiles of the number of successes of n trials, which bound the central kConfidence.
CountBand calcBinomialBand(int n, double probability) {
  const boost::math::binomial_distribution<> binomial(n, probability);
  return {boost::math::quantile(binomial, 0.5 * (1.0 - kConfidence)),
          boost::math::quantile(binomial, 0.5 * (1.0 + kConfidence))};
}

std::vector<std::size_t> sortIndices(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = i;
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  return order;
}

struct Scores {
  std::vector<double> samples, z;  ///< finite ones of the drawn samples
};

Scores collectScores(const RunFolder& run, const std::string& parameter) {
  const ParameterPredictions found = collectPredictions(run, parameter);
  Scores scores;
  for (std::size_t i = 0; i < std::min(found.samples.size(), kMaxDrawnSamples); ++i) {
    if (std::isfinite(found.z[i])) {
      scores.samples.push_back(found.samples[i]);
      scores.z.push_back(found.z[i]);
    }
  }
  return scores;
}

/// Long tables, one row per parameter and sample.
struct LongTable {
  std::vector<std::string> parameter;
  std::vector<double> sample, x, y, lower, upper;
};

/// x: the probability of the central interval that just contains the truth; y: the fraction of samples whose
/// interval is no wider, with the band of a calibrated map around x.
void appendReliability(const std::string& parameter, const Scores& scores, LongTable& table) {
  std::vector<double> levels;
  for (const double z : scores.z) {
    levels.push_back(std::abs(2.0 * calcPit(z) - 1.0));
  }
  const int n = static_cast<int>(levels.size());
  int k = 0;
  for (const std::size_t i : sortIndices(levels)) {
    ++k;
    table.parameter.push_back(parameter);
    table.sample.push_back(scores.samples[i]);
    table.x.push_back(levels[i]);
    table.y.push_back(static_cast<double>(k) / n);
  }
}

/// x: the normal quantile of the sample's rank, y: its z, and the band of a calibrated map.
void appendQuantiles(const std::string& parameter, const Scores& scores, LongTable& table) {
  const int n = static_cast<int>(scores.z.size());
  int k = 0;
  for (const std::size_t i : sortIndices(scores.z)) {
    ++k;
    table.parameter.push_back(parameter);
    table.sample.push_back(scores.samples[i]);
    table.x.push_back(calcNormalQuantile((k - 0.5) / n));
    table.y.push_back(scores.z[i]);
    table.lower.push_back(calcNormalQuantile(calcOrderQuantile(k, n, 0.5 * (1.0 - kConfidence))));
    table.upper.push_back(calcNormalQuantile(calcOrderQuantile(k, n, 0.5 * (1.0 + kConfidence))));
  }
}

DataTable makeLongTable(LongTable table, const std::string& x, const std::string& y) {
  DataTable made;
  made.add("parameter", std::move(table.parameter));
  made.add("sample", std::move(table.sample));
  made.add(x, std::move(table.x));
  made.add(y, std::move(table.y));
  if (!table.lower.empty()) {
    made.add("lower", std::move(table.lower));
    made.add("upper", std::move(table.upper));
  }
  return made;
}

}  // namespace

DataTable makeReliabilityTable(const RunFolder& run) {
  LongTable table;
  for (const std::string& name : collectNames(run.experiment.model.parameters)) {
    appendReliability(name, collectScores(run, name), table);
  }
  return makeLongTable(std::move(table), "level", "observed");
}

DataTable makeReliabilityBand(int n) {
  constexpr int kSteps = 50;
  std::vector<double> level, lower, upper;
  for (int i = 0; i <= kSteps; ++i) {
    const double p = static_cast<double>(i) / kSteps;
    level.push_back(p);
    const bool certain = i == 0 || i == kSteps;
    const CountBand band = certain ? CountBand{p * n, p * n} : calcBinomialBand(n, p);
    lower.push_back(band.lower / n);
    upper.push_back(band.upper / n);
  }
  DataTable table;
  table.add("level", level);
  table.add("lower", lower);
  table.add("upper", upper);
  return table;
}

CountBand calcCountBand(int n, int bins) {
  return calcBinomialBand(n, 1.0 / bins);
}

DataTable makeQuantileTable(const RunFolder& run) {
  LongTable table;
  for (const std::string& name : collectNames(run.experiment.model.parameters)) {
    appendQuantiles(name, collectScores(run, name), table);
  }
  return makeLongTable(std::move(table), "quantile", "z");
}

}  // namespace twinmap
