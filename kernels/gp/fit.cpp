#include "kernels/gp/fit.hpp"

#include <stdexcept>
#include <string>
#include <utility>

namespace twinmap::gp {

using Eigen::MatrixXd;

std::shared_ptr<const GaussianProcess> fit(const Eigen::Ref<const MatrixXd>& inputs,
                                           const Eigen::Ref<const Eigen::VectorXd>& target,
                                           const ModelStructure& structure,
                                           const Hyperparameters& hyperparameters, int threads) {
  const TrainingSet set(inputs, structure);
  checkHyperparameters(structure, hyperparameters);
  if (target.size() != inputs.cols()) {
    throw std::invalid_argument("fit: the target has " + std::to_string(target.size()) + " values for " +
                                std::to_string(inputs.cols()) + " training samples");
  }
  checkInputs(target, "fit: target");
  LikelihoodWorkspace workspace(set, getTeamSize(set, threads));
  const LikelihoodEvaluation evaluation = evaluateLikelihood(set, target, hyperparameters, workspace);
  if (!evaluation.ok) {
    throw std::runtime_error("fit: the covariance matrix is not positive definite");
  }
  return makeGaussianProcess(set, hyperparameters, evaluation, workspace);
}

std::shared_ptr<const GaussianProcess> makeGaussianProcess(const TrainingSet& set,
                                                           const Hyperparameters& hyperparameters,
                                                           const LikelihoodEvaluation& evaluation,
                                                           const LikelihoodWorkspace& workspace) {
  GaussianProcessParts parts;
  parts.structure = set.getStructure();
  parts.hyperparameters = hyperparameters;
  parts.inputs = set.sharedInputs();
  parts.alpha = workspace.corrections.col(0);
  parts.factor = workspace.factor.topRows(set.size()).triangularView<Eigen::Lower>();
  parts.mean_coefficients = workspace.mean_coefficients;
  parts.nlml = evaluation.nlml;
  parts.jitter = evaluation.jitter;
  return std::make_shared<const GaussianProcess>(std::move(parts));
}

}  // namespace twinmap::gp
