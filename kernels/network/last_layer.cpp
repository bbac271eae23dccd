#include "kernels/network/last_layer.hpp"

#include <cmath>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap::network {
namespace {

constexpr double kLogTwoPi = 1.8378770664093453;

/// sum_i (f_i f_i') x P_i and sum_i f_i x (P_i t_i).
struct Information {
  MatrixXd matrix;
  VectorXd vector;
};

Information calcInformation(const LinearObservations& observations) {
  const Index h = observations.inputs.rows(), p = observations.targets.rows();
  Information information{MatrixXd::Zero(p * h, p * h), VectorXd::Zero(p * h)};
  for (Index i = 0; i < observations.inputs.cols(); ++i) {
    const MatrixXd& precision = observations.precisions[static_cast<std::size_t>(i)];
    const auto inputs = observations.inputs.col(i);
    const VectorXd weighted = precision * observations.targets.col(i);
    for (Index k = 0; k < h; ++k) {
      information.vector.segment(k * p, p) += inputs[k] * weighted;
      for (Index j = k; j < h; ++j) {  // the lower triangle
        information.matrix.block(j * p, k * p, p, p) += inputs[j] * inputs[k] * precision;
      }
    }
  }
  return information;
}

}  // namespace

LastLayerPosterior::LastLayerPosterior(const LinearObservations& observations, double alpha) {
  const Index h = observations.inputs.rows(), p = observations.targets.rows();
  Information information = calcInformation(observations);
  information.matrix.diagonal().array() += alpha;
  lower_ = linalg::calcCholesky(information.matrix).lower;
  mean_ = linalg::solveCholesky(lower_, information.vector).reshaped(p, h);
}

MatrixXd LastLayerPosterior::calcCovariance(const Ref<const VectorXd>& inputs) const {
  const Index p = mean_.rows();
  MatrixXd directions = MatrixXd::Zero(lower_.rows(), p);
  for (Index k = 0; k < inputs.size(); ++k) {
    directions.middleRows(k * p, p).diagonal().setConstant(inputs[k]);
  }
  const MatrixXd half = linalg::solveLower(lower_, directions);
  return half.transpose() * half;
}

LastLayerEvidence::LastLayerEvidence(const LinearObservations& observations) {
  const Information information = calcInformation(observations);
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(information.matrix);
  eigenvalues_ = eigen.values.cwiseMax(0.0);
  projected_ = eigen.vectors.transpose() * information.vector;
  for (Index i = 0; i < observations.targets.cols(); ++i) {
    const MatrixXd& precision = observations.precisions[static_cast<std::size_t>(i)];
    const auto target = observations.targets.col(i);
    constant_ += linalg::calcCholesky(precision).lower.diagonal().array().log().sum() -
                 0.5 * (target.dot(precision * target) + static_cast<double>(target.size()) * kLogTwoPi);
  }
}

double LastLayerEvidence::calculate(double alpha) const {
  const Eigen::ArrayXd precisions = eigenvalues_.array() + alpha;
  return constant_ +
         0.5 * (projected_.array().square() / precisions + std::log(alpha) - precisions.log()).sum();
}

double LastLayerEvidence::maximise() const {
  constexpr double kStep = 1.01, kSmallest = 1e-8, kLargest = 1e8;
  double best = kSmallest, highest = calculate(kSmallest);
  for (double alpha = kSmallest * kStep; alpha <= kLargest; alpha *= kStep) {
    const double evidence = calculate(alpha);
    if (evidence > highest) {
      highest = evidence;
      best = alpha;
    }
  }
  return best;
}

}  // namespace twinmap::network
