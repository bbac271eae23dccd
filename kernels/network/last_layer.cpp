#include "kernels/network/last_layer.hpp"

#include <cmath>
#include <utility>

#include "kernels/linalg/decompositions.hpp"
#include "kernels/network/backpropagation.hpp"
#include "kernels/network/density.hpp"

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

LastLayerPosterior calcLastLayerPosterior(const LinearObservations& observations, double alpha) {
  const Index h = observations.inputs.rows(), p = observations.targets.rows();
  Information information = calcInformation(observations);
  information.matrix.diagonal().array() += alpha;
  LastLayerPosterior posterior;
  posterior.lower = linalg::calcCholesky(information.matrix).lower;
  posterior.mean = linalg::solveCholesky(posterior.lower, information.vector).reshaped(p, h);
  return posterior;
}

MatrixXd LastLayerPosterior::calcCovariance(const Ref<const VectorXd>& inputs) const {
  const Index p = mean.rows();
  MatrixXd directions = MatrixXd::Zero(lower.rows(), p);
  for (Index k = 0; k < inputs.size(); ++k) {
    directions.middleRows(k * p, p).diagonal().setConstant(inputs[k]);
  }
  const MatrixXd half = linalg::solveLower(lower, directions);
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

LinearObservations observeLastLayer(const Network& network, const Ref<const MatrixXd>& inputs,
                                    const Ref<const MatrixXd>& targets) {
  PassWorkspace pass;
  calcLoss(network, inputs, targets, pass);
  const Index n = inputs.cols();
  LinearObservations observations{MatrixXd(pass.outputs.back().rows() + 1, n), std::move(pass.targets), {}};
  observations.inputs << pass.outputs.back(), MatrixXd::Ones(1, n);
  observations.precisions.resize(static_cast<std::size_t>(n));
  for (Index i = 0; i < n; ++i) {
    observations.precisions[static_cast<std::size_t>(i)] = calcPrecision(pass.head.col(i), targets.rows());
  }
  return observations;
}

MatrixXd getMeanWeights(const Network& network) {
  const Layer& head = network.layers.back();
  const Index p = network.countTargets();
  MatrixXd weights(p, head.weights.cols() + 1);
  weights << head.weights.topRows(p), head.biases.head(p);
  return weights;
}

void setMeanWeights(const MatrixXd& weights, Network& network) {
  Layer& head = network.layers.back();
  const Index p = network.countTargets();
  head.weights.topRows(p) = weights.leftCols(head.weights.cols());
  head.biases.head(p) = weights.rightCols(1);
}

}  // namespace twinmap::network
