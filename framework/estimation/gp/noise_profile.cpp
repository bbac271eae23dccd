#include "framework/estimation/gp/noise_profile.hpp"

#include "framework/estimation/levels.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// L of the directions whose variance is above rounding.
MatrixXd calcDirections(const MatrixXd& covariance) {
  if (covariance.isDiagonal(kRegular)) {
    return covariance.diagonal().cwiseSqrt().asDiagonal();
  }
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(covariance);
  const VectorXd& variances = eigen.values;
  const Index kept = (variances.array() > kRegular * variances[variances.size() - 1]).count();
  return eigen.vectors.rightCols(kept) * variances.tail(kept).cwiseSqrt().asDiagonal();
}

}  // namespace

ArrayXd calcSquaredSlopes(const gp::Process& process, const MatrixXd& directions, const MatrixXd& inputs) {
  const MatrixXd gradient = std::visit(
      [&](const auto& trained) { return trained->getMean().predictMeanGradient(inputs); }, process);
  return (directions.transpose() * gradient).colwise().squaredNorm().transpose();
}

ArrayXd NoiseProfile::calcFactors(const gp::Process& process, Index parameter, const MatrixXd& inputs) const {
  if (isConstant() || !(mean_of_slope[parameter] > 0.0)) {
    return ArrayXd::Ones(inputs.cols());
  }
  return (calcSquaredSlopes(process, directions, inputs) / mean_of_slope[parameter]).max(kSmallestFactor);
}

NoiseProfile fitNoiseProfile(const std::vector<gp::Process>& processes, const MatrixXd& noise_covariance,
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
