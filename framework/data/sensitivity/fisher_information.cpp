#include "framework/data/sensitivity/fisher_information.hpp"

#include <algorithm>

#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

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
  const MatrixXd solved = linalg::solveCholesky(linalg::calcCholesky(of_others).lower, coupling);
  return information.topLeftCorner(count, count) - coupling.transpose() * solved;
}

MatrixXd calcLimitCovariance(const MatrixXd& information) {
  const MatrixXd identity = MatrixXd::Identity(information.rows(), information.cols());
  return linalg::solveCholesky(linalg::calcCholesky(information + kUniformInformation * identity).lower,
                               identity);
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
