#include "kernels/surrogate/box_moments.hpp"

#include "kernels/exact/exact.hpp"

namespace twinmap::gp {

Moments calcBoxMoments(const Eigen::MatrixXd& precision, const Eigen::VectorXd& shift) {
  const Eigen::Index u = shift.size();
  Moments found{Eigen::VectorXd(u), Eigen::MatrixXd(u, u)};
  Eigen::VectorXd buffer(u * (u + 3));
  exact::calcBoxMoments(static_cast<int>(u), precision.data(), shift.data(), buffer.data(), found.mean.data(),
                        found.covariance.data());
  return found;
}

}  // namespace twinmap::gp
