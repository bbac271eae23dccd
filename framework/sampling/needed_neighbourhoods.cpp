#include "framework/sampling/needed_neighbourhoods.hpp"

#include <algorithm>

#include "framework/design/point_set.hpp"
#include "framework/spec/parameter_box.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Without noise there is no limit (hasInformationLimit).
bool hasNoise(const ExperimentSpec& experiment) {
  const std::vector<Name> outputs = collectOutputs(experiment.features);
  const auto is_silent = [&](const OutputNoiseSpec& noise) {
    return noise.stddev == 0.0 && std::any_of(outputs.begin(), outputs.end(), [&](const Name& output) {
             return output.text == noise.name.text;
           });
  };
  const std::vector<OutputNoiseSpec>& all = experiment.noise.stddev;
  return experiment.noise.scale > 0.0 && std::none_of(all.begin(), all.end(), is_silent);
}

MatrixXd sample(const ExperimentSpec& experiment, const PointSetSpec& design, RandomPurpose purpose) {
  return samplePoints(design, collectSampled(experiment.model), experiment.seed, purpose);
}

}  // namespace

MatrixXd listNeededNeighbourhoods(const ExperimentSpec& experiment) {
  MatrixXd points(countSampled(experiment.model), 0);
  if (experiment.evaluation.limit && hasNoise(experiment)) {
    points = sample(experiment, experiment.design.test, RandomPurpose::kTestDesign);
  }
  if (selectsByFisherInformation(experiment)) {
    const MatrixXd train = sample(experiment, experiment.design.train, RandomPurpose::kTrainDesign);
    const Index first = points.cols(), count = std::min<Index>(train.cols(), kSensitivitySamples);
    points.conservativeResize(Eigen::NoChange, first + count);
    points.rightCols(count) = train.leftCols(count);
  }
  return points;
}

MatrixXd dropFailed(const MatrixXd& points, const TrajectoryStore& samples) {
  std::vector<Index> kept;
  for (Index i = 0; i < points.cols(); ++i) {
    if (!samples.hasFailed(points.col(i))) {
      kept.push_back(i);
    }
  }
  return points(Eigen::all, kept);
}

bool selectsByFisherInformation(const ExperimentSpec& experiment) {
  return std::any_of(experiment.transform.begin(), experiment.transform.end(),
                     [](const TransformStepSpec& step) {
                       const auto* select = std::get_if<SelectSpec>(&step.kind);
                       return select != nullptr && std::holds_alternative<FisherInformationSpec>(*select);
                     });
}

}  // namespace twinmap
