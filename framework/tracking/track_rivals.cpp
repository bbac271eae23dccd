#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/tracking/tracked_twin.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Chi-square that a level and a slope over x leave of values of weights w; infinite where x does not vary.
double calcLeft(const VectorXd& x, const VectorXd& values, const VectorXd& weights) {
  const double total = weights.sum();
  const VectorXd across = x.array() - weights.dot(x) / total;
  const VectorXd off = values.array() - weights.dot(values) / total;
  const double spread = weights.dot(across.cwiseAbs2());
  constexpr double kVaries = 1e-12;
  if (!(spread > kVaries * weights.dot(x.cwiseAbs2()))) {
    return std::numeric_limits<double>::infinity();
  }
  const double along = (weights.array() * across.array() * off.array()).sum();
  return weights.dot(off.cwiseAbs2()) - along * along / spread;
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
  const double left = calcLeft(step, values, weights);
  // of a parameter that scatters by more than its measurements say, differences count for less
  const double scatter = std::max(1.0, left / std::max(1.0, static_cast<double>(n - 3)));
  for (const Covariate& covariate : samples.back()->covariates) {
    const VectorXd x = collect(samples, covariate.name);
    if (x.size() > 0 && calcLeft(x, values, weights) < left + as_likely * scatter) {
      rivals.push_back(covariate.name);
    }
  }
  return rivals;
}

}  // namespace twinmap
