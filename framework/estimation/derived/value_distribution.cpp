#include "framework/estimation/derived/value_distribution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// The places of finite values, by ascending value.
std::vector<Index> orderFinite(const VectorXd& values) {
  std::vector<Index> order;
  for (Index i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) {
      order.push_back(i);
    }
  }
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return values[a] < values[b]; });
  return order;
}

/// y at x of the line through points with ascending x; the outermost y beyond them.
double interpolateAt(const VectorXd& xs, const VectorXd& ys, double x) {
  const Index next = std::lower_bound(xs.begin(), xs.end(), x) - xs.begin();
  if (next == 0 || next == xs.size()) {
    return ys[next == 0 ? 0 : next - 1];
  }
  const double share = (x - xs[next - 1]) / (xs[next] - xs[next - 1]);
  return ys[next - 1] + share * (ys[next] - ys[next - 1]);
}

}  // namespace

ValueDistribution::ValueDistribution(const VectorXd& values, const VectorXd& weights)
    : mean_(std::numeric_limits<double>::quiet_NaN()), stddev_(mean_) {
  const std::vector<Index> order = orderFinite(values);
  if (order.empty()) {
    return;
  }
  values_ = values(order);
  const VectorXd shares = weights(order) / weights(order).sum();
  probabilities_.resize(shares.size());
  std::partial_sum(shares.begin(), shares.end(), probabilities_.begin());
  probabilities_ -= 0.5 * shares;
  mean_ = shares.dot(values_);
  stddev_ = std::sqrt(shares.dot((values_.array() - mean_).square().matrix()));
}

double ValueDistribution::calcQuantile(double probability) const {
  return isDefined() ? interpolateAt(probabilities_, values_, probability) : mean_;
}

double ValueDistribution::calcProbability(double value) const {
  if (!isDefined()) {
    return mean_;
  }
  if (value < values_[0] || value > values_[values_.size() - 1]) {
    return value < values_[0] ? 0.0 : 1.0;
  }
  return interpolateAt(values_, probabilities_, value);
}

}  // namespace twinmap
