#include "framework/surrogate/forward_surrogate.hpp"

#include "kernels/exact/exact.hpp"

namespace twinmap {

Eigen::MatrixXd ForwardSurrogate::calcScores(const Eigen::MatrixXd& features) const {
  Eigen::MatrixXd found = Eigen::MatrixXd::Zero(getScoreCount(), features.cols());
  for (Eigen::Index i = 0; i < features.cols(); ++i) {
    for (Eigen::Index j = 0; j < features.rows(); ++j) {
      exact::addMultiple(static_cast<int>(found.rows()), features(j, i) - center(j), projection.col(j).data(),
                         found.col(i).data());
    }
  }
  return found;
}

}  // namespace twinmap
