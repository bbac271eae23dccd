#include "framework/store/trained_file.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "framework/base/files/temporary_folder.hpp"
#include "framework/base/hdf5/sealed_file.hpp"
#include "framework/estimation/network/online_network.hpp"
#include "framework/estimation/surrogate/online_surrogate.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "tests/case_turns.hpp"
#include "tests/framework/estimation/trained/oscillation.hpp"
#include "tests/framework/test_folder.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Oscillation;

void writeFile(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

constexpr int kFeatures = Oscillation::kSamples;

std::shared_ptr<const Surrogate> makeSurrogate(std::shared_ptr<const ForwardSurrogate> forward) {
  BoxPrior prior = makeUniformPrior(2);  // but for the first, which is normal
  prior.mean[0] = 0.1;
  prior.relative(0, 0) = 4.0;
  prior.within(0, 0) = 12.0;
  prior.shift[0] = 1.2;
  prior.stddev[0] = 0.28;
  Surrogate surrogate{
      std::move(forward), Eigen::Vector2d(0.2, 2.5), Eigen::Vector2d(0.1, 0.5), 2, 2, prior, {}};
  surrogate.validation.stddev_scale = surrogate.validation.limit_scale = VectorXd::Ones(2);
  surrogate.validation.coverage95 = surrogate.validation.limit_ratio = VectorXd::Ones(2);
  surrogate.validation.residual_correlation = MatrixXd::Identity(2, 2);
  return std::make_shared<const Surrogate>(std::move(surrogate));
}

/// Of random weights, with a distribution of those of its last layer.
std::shared_ptr<const NetworkMap> makeNetwork() {
  NetworkMap map;
  map.inputs = {VectorXd::Random(kFeatures), MatrixXd::Random(3, kFeatures), {VectorXd(0), VectorXd(0)}};
  map.center = Eigen::Vector2d(0.2, 2.5);
  map.half_width = Eigen::Vector2d(0.1, 0.5);
  network::Network network;
  network.offset = VectorXd::Random(2);
  network.skip = MatrixXd::Random(2, 3 + 3);
  network.products = {2, 0};
  network.scale = VectorXd::Constant(2, 0.3);
  network.layers = {{MatrixXd::Random(4, 3), VectorXd::Random(4)},
                    {MatrixXd::Random(5, 4), VectorXd::Random(5)}};
  const MatrixXd root = MatrixXd::Random(10, 10);
  map.members = {{network, {}}, {network, {}}};
  map.members.back().last_layer =
      linalg::calcCholesky(root * root.transpose() + MatrixXd::Identity(10, 10)).lower;
  map.validation = makeSurrogate(nullptr)->validation;
  map.validation.interval_factors = {VectorXd::Constant(2, 0.7), VectorXd::Constant(2, 2.5)};
  return std::make_shared<const NetworkMap>(std::move(map));
}

/// Means, standard deviations and p-values of a few measurements.
std::vector<double> inferAll(const TrainedFile& stored) {
  const MatrixXd measured =
      Oscillation::addNoise(Oscillation::calcClean(Oscillation::samplePoints(3, 11)), 12);
  const Estimator& map = *stored.model.map;
  const std::unique_ptr<Estimator::Workspace> inferring = map.makeWorkspace();
  std::vector<double> numbers;
  for (Eigen::Index i = 0; i < measured.cols(); ++i) {
    const Estimate& estimate = map.infer(measured.col(i), VectorXd(0), *inferring);
    numbers.insert(numbers.end(), {estimate.mean[0], estimate.mean[1], estimate.stddev[0], estimate.stddev[1],
                                   estimate.interval_factors.get(1).of95});
    if (stored.model.trust) {
      TrustWorkspace judging(*stored.model.trust);
      const Trust trust = judge(*stored.model.trust, measured.col(i), VectorXd(0), estimate,
                                inferring->findExplanation(), judging);
      numbers.insert(numbers.end(), {trust.p_value, trust.anomaly.score, trust.distance});
    }
  }
  return numbers;
}

class TrainedFileTest : public ::testing::TestWithParam<const char*> {
 protected:
  static void SetUpTestSuite() {
    TrustTraining training = Oscillation().makeTrustTraining();
    training.measured = training.measured.leftCols(50).eval();
    training.known.resize(0, 50);
    const auto forward = std::make_shared<const ForwardSurrogate>(Oscillation::fitSurrogate(training));
    const auto store = [&](const char* kind, std::shared_ptr<const Estimator> map) {
      TrainedFile stored;
      stored.parameters = Oscillation().parameters;
      for (const FeatureInfo& info : Oscillation::makeInfos()) {
        stored.feature_names.push_back(info.name);
      }
      stored.model.trust = fitTrustModel(training, forward, *map, 0.01, {1});
      stored.model.map = std::move(map);
      stored.experiment = "name: oscillation\n";
      writeTrainedFile(getFile(kind), stored);
      expected_[kind] = inferAll(stored);
    };
    store("gp", std::make_shared<const OnlineProcesses>(compressMap(Oscillation().trainMap())));
    store("surrogate", std::make_shared<const OnlineSurrogate>(makeSurrogate(forward)));
    store("network", std::make_shared<const OnlineNetwork>(makeNetwork()));
  }

  static std::filesystem::path getFile(const char* name) {
    static const TemporaryFolder folder;
    return folder.getPath() / name;
  }

  /// What a changed file gives: the same numbers, or an error that names it.
  static void expectTheSameOrAnError(const std::filesystem::path& file) {
    try {
      const TrainedFile stored = readTrainedFile(file);
      EXPECT_EQ(inferAll(stored), expected_[GetParam()]);
    } catch (const std::exception& error) {
      EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos) << error.what();
    }
  }

  static std::map<std::string, std::vector<double>> expected_;
};

std::map<std::string, std::vector<double>> TrainedFileTest::expected_;

TEST_P(TrainedFileTest, InfersTheSameBits) {
  const TrainedFile stored = readTrainedFile(getFile(GetParam()));
  EXPECT_EQ(inferAll(stored), expected_[GetParam()]);
  EXPECT_EQ(stored.parameters[1].name.text, "w");
  EXPECT_EQ(stored.feature_names.size(), kFeatures);
  EXPECT_EQ(stored.experiment, "name: oscillation\n");
  writeTrainedFile(getFile("again"), stored);
  EXPECT_EQ(readFile(getFile("again")), readFile(getFile(GetParam())));
}

TEST_P(TrainedFileTest, DamageIsFound) {
  constexpr int kMutations = 1000;
  const std::string whole = readFile(getFile(GetParam()));
  for (const int i : testing::takeTurn(kMutations)) {
    std::mt19937_64 random(static_cast<std::uint64_t>(i));
    const auto choose = [&](std::size_t most) { return static_cast<std::size_t>(random() % most); };
    std::string bytes = whole;
    switch (i % 4) {
      case 0:
        bytes[choose(bytes.size())] ^= static_cast<char>(1U << choose(8));
        break;
      case 1:
        bytes.resize(choose(bytes.size()));
        break;
      case 2: {
        const std::size_t first = choose(bytes.size());
        std::fill(bytes.begin() + first, bytes.begin() + std::min(bytes.size(), first + 1 + choose(4096)),
                  '\0');
        break;
      }
      default:
        for (int k = 0; k < 8; ++k) {
          bytes[choose(i % 8 == 3 ? 4096 : bytes.size())] = static_cast<char>(random());
        }
    }
    writeFile(getFile("mutated"), bytes);
    expectTheSameOrAnError(getFile("mutated"));
  }
}

/// Where the numbers of a dataset begin in the file, and how many there are.
struct Place {
  std::size_t offset, count;
  bool integers;
};

/// The datasets that say how many of something there are, or which one is meant.
std::map<std::string, Place> findCounts(const std::filesystem::path& path) {
  const auto names = Hdf5Reader(path).listDatasets();
  const auto lock = lockHdf5();
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  std::map<std::string, Place> places;
  for (const std::string& name : names) {
    const std::string last = name.substr(name.rfind('/') + 1);
    const hid_t data = H5Dopen2(file, name.c_str(), H5P_DEFAULT), type = H5Dget_type(data);
    const bool integers = H5Tget_class(type) == H5T_INTEGER;
    for (const char* count : {"count", "steps", "parameters", "unknown", "squared", "cubed", "tried"}) {
      if (integers || last == count) {
        places[name] = {H5Dget_offset(data), H5Dget_storage_size(data) / 8, integers};
      }
    }
    H5Tclose(type);
    H5Dclose(data);
  }
  H5Fclose(file);
  return places;
}

TEST_P(TrainedFileTest, WrongCountsBehindARightChecksumAreRefusedOrHarmless) {
  const std::string whole = readFile(getFile(GetParam()));
  const auto counts = findCounts(getFile(GetParam()));
  ASSERT_GE(counts.size(), 5U);
  std::vector<std::string> mutated;
  for (const auto& [name, place] : counts) {
    for (std::size_t i = 0; i < place.count; ++i) {
      for (const double value : {-1.0, 0.0, 1.0, 2.0, 3.0, 7.0, 61.0, 151.0, 1e5, 1e12, 9e18}) {
        mutated.push_back(whole);
        const auto integer = static_cast<std::int64_t>(value);
        std::memcpy(mutated.back().data() + place.offset + 8 * i,
                    place.integers ? static_cast<const void*>(&integer) : &value, 8);
      }
    }
  }
  const std::vector<int> turn = testing::takeTurn(static_cast<int>(mutated.size()));
  std::size_t refused = 0;
  for (const int i : turn) {
    writeFile(getFile("mutated"), mutated[static_cast<std::size_t>(i)]);
    sealFile(getFile("mutated"));
    try {
      inferAll(readTrainedFile(getFile("mutated")));
    } catch (const std::exception&) {
      ++refused;
    }
  }
  EXPECT_GT(refused * mutated.size(), 40 * turn.size());  // more than 40 of all
}

INSTANTIATE_TEST_SUITE_P(Kinds, TrainedFileTest, ::testing::Values("gp", "surrogate", "network"),
                         [](const auto& kind) { return std::string(kind.param); });

TEST(MapsFile, RestoresProcessesOfEveryKind) {
  const TestFolder folder;
  const MatrixXd features = MatrixXd::Random(3, 30);
  LabelledFeatures samples;
  samples.infos = {{"y(0 s)", "m", 0, 0.0}, {"y(1 s)", "m", 0, 1.0}, {"z(0 s)", "m", 1, 0.0}};
  samples.features = features;
  samples.inputs = MatrixXd::Random(1, 30);
  samples.parameters.resize(2, 30);
  samples.parameters.row(0) = features.row(0).array().sin() + 1.5;
  samples.parameters.row(1) = features.row(1).cwiseProduct(features.row(2)) + samples.inputs;
  samples.noise_covariance = MatrixXd::Identity(3, 3);
  const std::vector<TransformStepSpec> transform{{ZScoreSpec{}, {}}, {PrincipalComponentsSpec{3, {}}, {}}};
  const ParameterSpec input = Oscillation::makeParameter("load", -3.0, 4.0);
  std::vector<GpMapSpec> specs(5);
  specs[0].length_scales = LengthScales::kShared;
  specs[1].length_scales = LengthScales::kPerOutput;
  specs[2].covariance = GpCovariance::kRationalQuadratic;
  specs[2].mean = GpMean::kLinear;
  specs[3].covariance = GpCovariance::kMatern52;
  specs[3].linear_term = true;
  specs[3].mean = GpMean::kZero;
  specs[4].approximation = GpApproximation::kSgpr;
  specs[4].inducing = 10;
  for (const GpMapSpec& spec : specs) {
    TrainedFile stored;
    stored.parameters = Oscillation().parameters;
    stored.inputs = {input};
    const GpMap map = trainGpMap(spec, transform, {"d", "w"}, samples, {1}, {input}).map;
    stored.model.map = std::make_shared<const OnlineProcesses>(map);
    writeTrainedFile(folder / "maps.h5", stored);
    const TrainedFile read = readTrainedFile(folder / "maps.h5");
    EXPECT_EQ(read.inputs.at(0).name.text, "load");
    const Estimates expected = map.predict(features, samples.inputs);
    const Estimates restored =
        dynamic_cast<const OnlineProcesses&>(*read.model.map).getMap().predict(features, samples.inputs);
    EXPECT_EQ(restored.mean, expected.mean);
    EXPECT_EQ(restored.stddev, expected.stddev);
  }
}

TEST(MapsFile, RefusesOtherFiles) {
  const TestFolder folder;
  writeFile(folder / "text", "parameters\n");
  Hdf5Writer other(folder / "other.h5");
  other.write("/number", 1.0);
  other.close();
  Hdf5Writer sealed(folder / "sealed.h5", Hdf5Seal::kDigest);
  sealed.write("/number", 1.0);
  sealed.close();
  for (const char* name : {"text", "other.h5", "sealed.h5", "missing"}) {
    EXPECT_THROW(readTrainedFile(folder / name), std::exception) << name;
  }
}

}  // namespace
}  // namespace twinmap
