#include "framework/labelled_sets.hpp"

#include "framework/features/noise.hpp"

namespace twinmap {
namespace {

LabelledFeatures makeLabelledFeatures(const Trajectories& trajectories, const FeatureExtractor& extractor,
                                      const Eigen::VectorXd& row_stddev, const RandomStream& random,
                                      int replicates) {
  const std::vector<int> samples = findSuccessful(trajectories);
  const auto count = static_cast<Eigen::Index>(samples.size());
  LabelledFeatures labelled;
  labelled.infos = extractor.getInfos();
  labelled.features.resize(extractor.getFeatureCount(), count * replicates);
  for (int r = 0; r < replicates; ++r) {
    const Eigen::MatrixXd noisy = addNoise(trajectories.responses, row_stddev, random, r);
    labelled.features.middleCols(r * count, count) = extractor.extract(noisy(Eigen::all, samples));
  }
  labelled.parameters =
      Eigen::MatrixXd(trajectories.parameters(Eigen::all, samples)).replicate(1, replicates);
  labelled.replicates = replicates;
  return labelled;
}

}  // namespace

LabelledSets makeLabelledSets(const ExperimentSpec& experiment, const SimulatedSets& sets,
                              const FeatureExtractor& extractor, const FeatureNoise& noise) {
  const Eigen::VectorXd row_stddev = calcNoiseStddev(experiment.noise, sets.train.layout);
  LabelledSets labelled{
      makeLabelledFeatures(sets.train, extractor, row_stddev, {experiment.seed, RandomPurpose::kTrainNoise},
                           experiment.noise.replicates.value_or(1)),
      makeLabelledFeatures(sets.test, extractor, row_stddev, {experiment.seed, RandomPurpose::kTestNoise},
                           1)};
  labelled.train.noise_covariance = noise.calcMeanCovariance(sets.train.responses);
  labelled.test.noise_covariance = labelled.train.noise_covariance;
  return labelled;
}

}  // namespace twinmap
