#include "framework/surrogate/honest_stddev.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "framework/inverse_map/predictions.hpp"

namespace twinmap {
namespace {

constexpr double kNormal68 = 0.994457883209753;

/// The value below which a further sample lies with probability `level`; the largest if there are too few.
double calcQuantile(const Eigen::VectorXd& sorted, double level) {
  const auto n = static_cast<double>(sorted.size());
  const double rank = std::ceil(level * (n + 1.0));
  return sorted(static_cast<Eigen::Index>(std::clamp(rank, 1.0, n)) - 1);
}

/// The larger of both quantiles over those of the normal distribution; of their confidence limits so many
/// standard errors of the ranks (binomial) above them.
double calcQuantileScale(const Eigen::VectorXd& sorted, double errors_above) {
  const auto n = static_cast<double>(sorted.size());
  double scale = 0.0;
  for (const auto& [level, normal] : {std::pair{0.95, kNormal95}, std::pair{0.68, kNormal68}}) {
    const double error = std::sqrt(level * (1.0 - level) / n);
    scale = std::max(scale, calcQuantile(sorted, level + errors_above * error) / normal);
  }
  return scale;
}

Eigen::VectorXd sortErrors(Eigen::VectorXd values) {
  std::sort(values.data(), values.data() + values.size());
  return values;
}

}  // namespace

double calcStddevScale(const Eigen::VectorXd& absolute_z) {
  const Eigen::VectorXd sorted = sortErrors(absolute_z);
  return std::max(calcQuantileScale(sorted, 0.0), std::min(1.0, calcQuantileScale(sorted, kNormal95)));
}

double calcLeastStddevScale(const Eigen::VectorXd& absolute_z) {
  return calcQuantileScale(sortErrors(absolute_z), -1.0);
}

}  // namespace twinmap
