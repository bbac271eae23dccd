#include "framework/surrogate/honest_stddev.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "framework/inverse_map/predictions.hpp"

namespace twinmap {
namespace {

constexpr double kNormal50 = 0.674489750196082;
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

/// The share of the errors that are below a value.
double calcShareBelow(const Eigen::VectorXd& sorted, double value) {
  return static_cast<double>(std::lower_bound(sorted.begin(), sorted.end(), value) - sorted.begin()) /
         static_cast<double>(sorted.size());
}

/// The factor between two by which coverage of 50 % and 95 % intervals misses these by opposite amounts,
/// those of 95 % counted twice. Their sum rises with the factor, so that halving finds it.
double calcBalancedScale(const Eigen::VectorXd& sorted, double low, double high) {
  constexpr int kHalvings = 40;
  for (int i = 0; i < kHalvings; ++i) {
    const double scale = 0.5 * (low + high);
    const double excess = calcShareBelow(sorted, kNormal50 * scale) - 0.5 +
                          2.0 * (calcShareBelow(sorted, kNormal95 * scale) - 0.95);
    (excess < 0.0 ? low : high) = scale;
  }
  return high;
}

Eigen::VectorXd sortErrors(Eigen::VectorXd values) {
  std::sort(values.data(), values.data() + values.size());
  return values;
}

}  // namespace

double calcStddevScale(const Eigen::VectorXd& absolute_z) {
  constexpr Eigen::Index kMany = 2000;  // whose factor has a standard error of 2 %
  const Eigen::VectorXd sorted = sortErrors(absolute_z);
  const double scale =
      std::max(calcQuantileScale(sorted, 0.0), std::min(1.0, calcQuantileScale(sorted, kNormal95)));
  return sorted.size() > kMany
             ? calcBalancedScale(sorted, std::min(scale, calcQuantile(sorted, 0.68) / kNormal68), scale)
             : scale;
}

double calcLeastStddevScale(const Eigen::VectorXd& absolute_z) {
  return calcQuantileScale(sortErrors(absolute_z), -1.0);
}

Eigen::VectorXd calcTypicalStddev(const Eigen::MatrixXd& stddev) {
  return stddev.array().log().rowwise().mean().exp();
}

Eigen::VectorXd calcPupilScale(const StddevLack& teacher, const Eigen::VectorXd& typical_stddev) {
  const Eigen::ArrayXd share = (teacher.typical_stddev.array() / typical_stddev.array()).min(1.0).square();
  return (1.0 + share * (teacher.least_scale.array().max(1.0).square() - 1.0)).sqrt();
}

}  // namespace twinmap
