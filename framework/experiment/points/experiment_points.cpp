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

MatrixXd sampleTrainPoints(const ExperimentSpec& experiment) {
  if (experiment.inverse_map.isNone()) {
    return MatrixXd(countSampled(experiment.model), 0);
  }
  return samplePoints(experiment.design.train, collectSampled(experiment.model), experiment.seed,
                      RandomPurpose::kTrainDesign);
}

MatrixXd sampleTestPoints(const ExperimentSpec& experiment) {
  const std::vector<ParameterSpec> unknown = collectUnknown(experiment.model);
  const Prior prior(unknown, experiment.model.priors);
  MatrixXd points = samplePoints(experiment.design.test, collectSampled(experiment.model), experiment.seed,
                                 RandomPurpose::kTestDesign);
  if (prior.isUniform()) {
    return points;
  }
  const MatrixXd unit = sampleUnitCube(experiment.design.test, static_cast<int>(points.rows()),
                                       experiment.seed, RandomPurpose::kTestDesign);
  const RandomStream random(experiment.seed, RandomPurpose::kPriorPoints);
  for (Index i = 0; i < points.cols(); ++i) {
    points.col(i).head(static_cast<Index>(unknown.size())) = prior.calcPoint(chooseUnitPoint(
        prior, unit.col(i).head(static_cast<Index>(unknown.size())), random, static_cast<std::uint64_t>(i)));
  }
  return points;
}

}  // namespace twinmap
