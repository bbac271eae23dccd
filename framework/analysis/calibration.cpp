#include "framework/analysis/calibration.hpp"

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "framework/base/random/standard_normal.hpp"

namespace twinmap {
namespace {

namespace constants = boost::math::constants;

double calcNormalProbability(double z) {
  return 0.5 * std::erfc(-z * constants::one_div_root_two<double>());
}

double calcStandardCrps(double z) {
  const double density = std::exp(-0.5 * z * z) * constants::one_div_root_two_pi<double>();
  return z * (2.0 * calcNormalProbability(z) - 1.0) + 2.0 * density - constants::one_div_root_pi<double>();
}

}  // namespace

double calcNormalQuantile(double probability) {
  constexpr double kSmallest = 1e-16;
  return toStandardNormal(std::clamp(probability, kSmallest, 1.0 - kSmallest));
}

double calcTwoSidedQuantile(double probability) {
  return boost::math::quantile(boost::math::normal(), 0.5 * (1.0 + probability));
}

Eigen::ArrayXd calcCrps(const Eigen::ArrayXd& z, const Eigen::ArrayXd& stddev) {
  return stddev * z.unaryExpr(&calcStandardCrps);
}

Eigen::MatrixXd calcPit(const Eigen::MatrixXd& truths, const Estimates& predictions) {
  const Eigen::MatrixXd truth = predictions.repeat(truths);
  if (!predictions.mixtures.empty()) {
    return Eigen::MatrixXd::NullaryExpr(truth.rows(), truth.cols(), [&](Eigen::Index p, Eigen::Index i) {
      return takeMarginal(predictions.mixtures[static_cast<std::size_t>(i)], p).calcProbability(truth(p, i));
    });
  }
  const Eigen::ArrayXXd z = (truth - predictions.mean).array() / predictions.stddev.array();
  return z.unaryExpr(&calcNormalProbability);
}

std::vector<int> countPit(const Eigen::ArrayXd& pit, const Eigen::VectorXd& weights) {
  Eigen::ArrayXd counts = Eigen::ArrayXd::Zero(kPitBins);
  for (Eigen::Index i = 0; i < pit.size(); ++i) {
    if (std::isfinite(pit[i])) {
      counts[std::min(static_cast<int>(pit[i] * kPitBins), kPitBins - 1)] +=
          weights.size() > 0 ? weights[i] : 1.0;
    }
  }
  counts = counts.round().max(0.0);
  return {counts.begin(), counts.end()};
}

}  // namespace twinmap
