#include "framework/estimation/trained/online_surrogate.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const Inference& OnlineSurrogate::infer(const Eigen::Ref<const VectorXd>& features,
                                        const Eigen::Ref<const VectorXd>& known, Workspace& workspace) const {
  Inference& inference = workspace.inference;
  inference.inputs = makeInputs(features, known);
  const Index r = surrogate_->forward->getScoreCount();
  surrogate_->answer(workspace.inversion.infer(inference.inputs.head(r), inference.inputs.tail(known.size())),
                     inference.mean, inference.stddev);
  surrogate_->shrinkToPrior(inference.mean, inference.stddev);
  inference.limit_stddev = surrogate_->calcLimit(workspace.inversion.getNoiseStddev());
  return inference;
}

MatrixXd OnlineSurrogate::makeInputs(const MatrixXd& features, const MatrixXd& known) const {
  const Index q = known.rows();
  MatrixXd inputs(surrogate_->forward->getScoreCount() + q, features.cols());
  inputs.topRows(inputs.rows() - q) = surrogate_->forward->calcScores(features);
  if (q > 0) {
    inputs.bottomRows(q) = (known.colwise() - surrogate_->center.tail(q)).array().colwise() /
                           surrogate_->half_width.tail(q).array();
  }
  return inputs;
}

}  // namespace twinmap
