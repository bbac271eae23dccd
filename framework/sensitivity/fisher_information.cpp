#include "framework/sensitivity/fisher_information.hpp"

#include <Eigen/Cholesky>

#include "framework/spec/parameter_box.hpp"

namespace twinmap {

using Eigen::MatrixXd;

MatrixXd calcFisherInformation(const NoiseWhitener& noise, const MatrixXd& sensitivities) {
  const MatrixXd whitened = noise.apply(sensitivities);
  return whitened.transpose() * whitened;
}

MatrixXd calcMarginalInformation(const MatrixXd& information, Eigen::Index count) {
  const Eigen::Index others = information.rows() - count;
  if (others == 0) {
    return information;
  }
  MatrixXd of_others = information.bottomRightCorner(others, others);
  of_others.diagonal().array() += kUniformInformation;
  const MatrixXd coupling = information.bottomLeftCorner(others, count);
  return information.topLeftCorner(count, count) - coupling.transpose() * of_others.llt().solve(coupling);
}

MatrixXd calcLimitCovariance(const MatrixXd& information) {
  const MatrixXd identity = MatrixXd::Identity(information.rows(), information.cols());
  return (information + kUniformInformation * identity).llt().solve(identity);
}

}  // namespace twinmap
