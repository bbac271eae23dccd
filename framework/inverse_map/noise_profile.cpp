#include "framework/inverse_map/noise_profile.hpp"

#include <Eigen/Eigenvalues>

namespace twinmap {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// L of the directions whose variance is above rounding.
MatrixXd calcDirections(const MatrixXd& covariance) {
  constexpr double kSmallest = 1e-12;  // of the largest
  if (covariance.isDiagonal(kSmallest)) {
    return covariance.diagonal().cwiseSqrt().asDiagonal();
  }
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(covariance);
  const VectorXd& variances = eigen.eigenvalues();  // increasing
  const Index kept = (variances.array() > kSmallest * variances[variances.size() - 1]).count();
  return eigen.eigenvectors().rightCols(kept) * variances.tail(kept).cwiseSqrt().asDiagonal();
}

}  // namespace

ArrayXd calcSquaredSlopes(const Process& process, const MatrixXd& directions, const MatrixXd& inputs) {
  const auto predict_mean = [&](const MatrixXd& at) {
    return std::visit([&](const auto& trained) { return trained->predictMean(at); }, process);
  };
  ArrayXd slopes = ArrayXd::Zero(inputs.cols());
  for (const auto& direction : directions.colwise()) {
    const VectorXd change =
        0.5 * (predict_mean(inputs.colwise() + direction) - predict_mean(inputs.colwise() - direction));
    slopes += change.array().square();
  }
  return slopes;
}

ArrayXd NoiseProfile::calcFactors(const Process& process, Index parameter, const MatrixXd& inputs) const {
  constexpr double kSmallest = 0.1;
  if (isConstant() || !(mean_of_slope[parameter] > 0.0)) {
    return ArrayXd::Ones(inputs.cols());
  }
  return (calcSquaredSlopes(process, directions, inputs) / mean_of_slope[parameter]).max(kSmallest);
}

NoiseProfile fitNoiseProfile(const std::vector<Process>& processes, const MatrixXd& noise_covariance,
                             const MatrixXd& inputs) {
  NoiseProfile profile;
  const MatrixXd directions = calcDirections(noise_covariance);
  profile.directions = MatrixXd::Zero(inputs.rows(), directions.cols());
  profile.directions.topRows(directions.rows()) = directions;
  profile.mean_of_slope.resize(static_cast<Index>(processes.size()));
  for (std::size_t p = 0; p < processes.size(); ++p) {
    profile.mean_of_slope[static_cast<Index>(p)] =
        calcSquaredSlopes(processes[p], profile.directions, inputs).mean();
  }
  return profile;
}

}  // namespace twinmap
