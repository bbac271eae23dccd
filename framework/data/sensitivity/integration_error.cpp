#include "framework/data/sensitivity/integration_error.hpp"

#include <algorithm>
#include <cmath>

#include "framework/data/sensitivity/fisher_information.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double IntegrationError::calcDecades() const {
  constexpr double kNegligible = 0.1;
  // chi-square rises with the square of the error
  return std::max(std::log10(shift / kNegligible), 0.5 * std::log10(rise / kNegligible));
}

IntegrationError boundIntegrationError(const std::vector<FeatureError>& points) {
  IntegrationError largest;
  for (const FeatureError& point : points) {
    const double square = point.error.squaredNorm(), features = static_cast<double>(point.error.size());
    largest.shift = std::max(largest.shift, std::sqrt(square));
    largest.rise = std::max(largest.rise, square / std::sqrt(2.0 * features));
  }
  return largest;
}

IntegrationError calcIntegrationError(const std::vector<FeatureError>& points, Index count) {
  IntegrationError largest = boundIntegrationError(points);
  largest.shift = 0.0;
  for (const FeatureError& point : points) {
    const MatrixXd& jacobian = point.sensitivities;
    const MatrixXd covariance = calcLimitCovariance(jacobian.transpose() * jacobian);
    const VectorXd moved = covariance * (jacobian.transpose() * point.error);
    for (Index k = 0; k < count; ++k) {
      const double shift = std::abs(moved[k]) / std::sqrt(covariance(k, k));
      if (shift > largest.shift) {
        largest.shift = shift;
        largest.parameter = k;
      }
    }
  }
  return largest;
}

}  // namespace twinmap
