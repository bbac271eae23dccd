#include "framework/sensitivity/fisher_information.hpp"

#include <Eigen/Cholesky>

namespace twinmap {

using Eigen::MatrixXd;

MatrixXd calcFisherInformation(const NoiseWhitener& noise, const MatrixXd& sensitivities) {
  const MatrixXd whitened = noise.apply(sensitivities);
  return whitened.transpose() * whitened;
}

MatrixXd calcLimitCovariance(const MatrixXd& information) {
  constexpr double kInformationOfTheBox = 12.0;
  const MatrixXd identity = MatrixXd::Identity(information.rows(), information.cols());
  return (information + kInformationOfTheBox * identity).llt().solve(identity);
}

}  // namespace twinmap
