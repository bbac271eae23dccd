#include "framework/data/sensitivity/fisher_information.hpp"

#include <algorithm>

#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

/// C' O^-1 C.
MatrixXd calcExplained(const MatrixXd& of_others, const MatrixXd& coupling) {
  return coupling.transpose() * linalg::solveCholesky(linalg::calcCholesky(of_others).lower, coupling);
}

}  // namespace

MatrixXd calcFisherInformation(const NoiseWhitener& noise, const MatrixXd& sensitivities) {
  const MatrixXd whitened = noise.apply(sensitivities);
  return whitened.transpose() * whitened;
}

MatrixXd makeUniformInformation(Index parameters) {
  return kUniformInformation * MatrixXd::Identity(parameters, parameters);
}

MatrixXd calcMarginalInformation(const MatrixXd& information, Index count, const MatrixXd& prior) {
  const Index others = information.rows() - count;
  if (others == 0) {
    return information;
  }
  const MatrixXd whole = information + prior;
  const MatrixXd of_itself = prior.topLeftCorner(count, count) - calcMarginalPrior(prior, count);
  return (information.topLeftCorner(count, count) + of_itself) -
         calcExplained(whole.bottomRightCorner(others, others), whole.bottomLeftCorner(others, count));
}

MatrixXd calcMarginalInformation(const MatrixXd& information, Index count) {
  return calcMarginalInformation(information, count, makeUniformInformation(information.rows()));
}

MatrixXd calcMarginalPrior(const MatrixXd& prior, Index count) {
  const Index others = prior.rows() - count;
  return others == 0 ? prior
                     : MatrixXd(prior.topLeftCorner(count, count) -
                                calcExplained(prior.bottomRightCorner(others, others),
                                              prior.bottomLeftCorner(others, count)));
}

MatrixXd calcLimitCovariance(const MatrixXd& information, const MatrixXd& prior) {
  return linalg::invertPositiveDefinite(information + prior);
}

MatrixXd calcLimitCovariance(const MatrixXd& information) {
  return calcLimitCovariance(information, makeUniformInformation(information.rows()));
}

bool asksForInformationLimit(const ExperimentSpec& experiment) {
  const std::vector<Name> outputs = collectOutputs(experiment.features);
  const auto is_silent = [&](const OutputNoiseSpec& noise) {
    return noise.stddev == 0.0 && std::any_of(outputs.begin(), outputs.end(), [&](const Name& output) {
             return output.text == noise.name.text;
           });
  };
  const std::vector<OutputNoiseSpec>& all = experiment.noise.stddev;
  return experiment.evaluation.limit && experiment.noise.scale > 0.0 &&
         std::none_of(all.begin(), all.end(), is_silent);
}

bool hasInformationLimit(const ExperimentSpec& experiment, const LabelledFeatures& samples) {
  return asksForInformationLimit(experiment) && samples.noise_covariance.diagonal().minCoeff() > 0.0;
}

}  // namespace twinmap
