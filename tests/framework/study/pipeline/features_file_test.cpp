#include <gtest/gtest.h>

#include "framework/base/files/temporary_folder.hpp"
#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/data/features/experiment_features.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/study/pipeline/preparation/prepare_data.hpp"
#include "framework/study/pipeline/run_experiment.hpp"
#include "framework/study/samples/model_store.hpp"
#include "framework/study/samples/write_features.hpp"

namespace twinmap {
namespace {

constexpr int kTrain = 30, kTest = 11, kDraws = 2;

ExperimentSpec makeTwoBeams() {
  return loadExperiment(
      std::string(TWINMAP_SOURCE_DIR) + "/experiments/two_beam/table1.yaml",
      {"design.train.samples=" + std::to_string(kTrain), "noise.replicates=2",
       "design.test.samples=" + std::to_string(kTest), "simulation.duration=1",
       "features=[{samples: {outputs: [y, theta], start: 0.1, interval: 0.1, count: 10}}]"});
}

struct TwoBeams {
  ExperimentSpec experiment = makeTwoBeams();
  std::unique_ptr<Simulator> simulator =
      makeSimulator(experiment.model, collectTimes(experiment.features), countModes(experiment.features));
  FeatureExtractor extractor = makeExtractor(experiment, simulator->getLayout());
  TemporaryFolder folder;
  std::unique_ptr<TrajectoryStore> store =
      openStore(experiment.model, simulator->getLayout(), folder.getPath() / "store");
  SampleSource source{*simulator, *store};

  std::filesystem::path write(const std::string& name, Eigen::Index block) {
    writeFeatures(folder.getPath() / name, experiment, extractor, source, {}, block);
    return folder.getPath() / name;
  }
};

TEST(FeaturesFile, HasTheFeaturesThatARunLearnsFrom) {
  TwoBeams beams;
  const Hdf5Reader file(beams.write("features.h5", 7));
  const FeatureNoise noise(beams.extractor,
                           ResponseNoise(beams.experiment.noise, beams.simulator->getLayout()),
                           beams.experiment.seed);
  const Study study{
      beams.experiment, *beams.simulator, beams.extractor, noise, &beams.source, beams.folder.getPath(), {}};
  const LabelledSets expected = prepareData(study, simulateSets(study)).labelled;
  EXPECT_EQ(file.readSamples("/train/features"), expected.train.features);
  EXPECT_EQ(file.readSamples("/train/parameters"), expected.train.parameters.leftCols(kTrain));
  EXPECT_EQ(file.readSamples("/test/features"), expected.test.features);
  EXPECT_EQ(file.readSamples("/test/parameters"), expected.test.parameters);
  EXPECT_EQ(file.readIntegers("/train/ok"), std::vector<std::int64_t>(kTrain, 1));
  EXPECT_EQ(file.readTexts("/features/name").size(), beams.extractor.getInfos().size());
  EXPECT_EQ(file.readTexts("/experiment").at(0), writeExperiment(beams.experiment));
}

TEST(FeaturesFile, DependsOnNeitherBlocksNorWhatWasStoredBefore) {
  TwoBeams beams;
  const Hdf5Reader one(beams.write("one.h5", 7));
  const Eigen::MatrixXd in_blocks = one.readSamples("/train/features");
  const Hdf5Reader other(beams.write("other.h5", 1000));
  EXPECT_EQ(other.readSamples("/train/features"), in_blocks);
  EXPECT_EQ(beams.store->getSampleCount(), kTrain + kTest);
  EXPECT_EQ(in_blocks.cols(), kDraws * kTrain);
}

TEST(FeaturesFile, NeedsANumberOfSamples) {
  ExperimentSpec experiment = makeTwoBeams();
  experiment.design.train.samples.automatic = true;
  const TemporaryFolder folder;
  RunOptions options;
  options.folder = folder.getPath();
  EXPECT_THROW(runFeatures(experiment, options, {}), ExperimentError);
}

}  // namespace
}  // namespace twinmap
