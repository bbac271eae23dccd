#include "framework/experiment/points/experiment_points.hpp"

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/point_set.hpp"
#include "framework/experiment/points/prior.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A point of the unit cube that is kept with the probability Prior::calcShareWithin(): the given one, or
/// else the first of uniform ones.
VectorXd chooseUnitPoint(const Prior& prior, VectorXd unit, const RandomStream& random,
                         std::uint64_t sample) {
  constexpr std::uint64_t kMaxTries = 10000;  // bounds that leave so little of a prior contradict it
  const auto dimensions = static_cast<std::uint64_t>(unit.size());
  for (std::uint64_t attempt = 0; attempt < kMaxTries; ++attempt) {
    if (random.calcUniform(sample, dimensions, attempt) < prior.calcShareWithin(unit)) {
      break;
    }
    for (std::uint64_t j = 0; j < dimensions; ++j) {
      unit[static_cast<Index>(j)] = random.calcUniform(sample, j, attempt);
    }
  }
  return unit;
}

}  // namespace

MatrixXd placeInPrior(const ModelSpec& model, const MatrixXd& unit, std::uint64_t seed,
                      RandomPurpose purpose) {
  const std::vector<ParameterSpec> unknown = collectUnknown(model);
  MatrixXd points = scaleToBounds(unit, collectSampled(model));
  const Prior prior(unknown, model.priors);
  if (!prior.isUniform()) {
    const auto u = static_cast<Index>(unknown.size());
    const RandomStream random(seed, purpose);
    for (Index i = 0; i < points.cols(); ++i) {
      points.col(i).head(u) =
          prior.calcPoint(chooseUnitPoint(prior, unit.col(i).head(u), random, static_cast<std::uint64_t>(i)));
    }
  }
  return points;
}

MatrixXd sampleTrainPoints(const ExperimentSpec& experiment) {
  const auto count = static_cast<int>(countSampled(experiment.model));
  if (experiment.inverse_map.isNone()) {
    return MatrixXd(count, 0);
  }
  return placeInPrior(
      experiment.model,
      sampleUnitCube(experiment.design.train, count, experiment.seed, RandomPurpose::kTrainDesign),
      experiment.seed, RandomPurpose::kPriorTraining);
}

MatrixXd sampleTestPoints(const ExperimentSpec& experiment) {
  const auto count = static_cast<int>(countSampled(experiment.model));
  return placeInPrior(
      experiment.model,
      sampleUnitCube(experiment.design.test, count, experiment.seed, RandomPurpose::kTestDesign),
      experiment.seed, RandomPurpose::kPriorPoints);
}

}  // namespace twinmap
