#include "framework/surrogate/honest_stddev.hpp"

#include <algorithm>
#include <cmath>

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

/// The upper 97.5 % confidence limit of the same, by the binomial distribution of ranks.
double calcUpperQuantile(const Eigen::VectorXd& sorted, double level) {
  const auto n = static_cast<double>(sorted.size());
  return calcQuantile(sorted, level + kNormal95 * std::sqrt(level * (1.0 - level) / n));
}

}  // namespace

double calcStddevScale(const Eigen::VectorXd& absolute_z) {
  Eigen::VectorXd sorted = absolute_z;
  std::sort(sorted.data(), sorted.data() + sorted.size());
  const double found =
      std::max(calcQuantile(sorted, 0.95) / kNormal95, calcQuantile(sorted, 0.68) / kNormal68);
  const double upper =
      std::max(calcUpperQuantile(sorted, 0.95) / kNormal95, calcUpperQuantile(sorted, 0.68) / kNormal68);
  return std::max(found, std::min(1.0, upper));
}

}  // namespace twinmap
