#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/estimation/gp/train_gp_map.hpp"
#include "framework/store/estimators/maps_file.hpp"
#include "framework/store/provenance.hpp"
#include "framework/store/samples_file.hpp"
#include "tests/framework/test_folder.hpp"

namespace twinmap {
namespace {

std::vector<ParameterSpec> makeParameters() {
  std::vector<ParameterSpec> parameters(2);
  parameters[0].name = {"k", {}};
  parameters[0].unit = "N/m";
  parameters[0].bounds = {1, 2, {}};
  parameters[1].name = {"d", {}};
  parameters[1].bounds = {3, 4, {}};
  return parameters;
}

Trajectories makeTrajectories(int samples) {
  Trajectories set;
  set.parameters = Eigen::MatrixXd::Random(2, samples);
  set.responses = Eigen::MatrixXd::Random(6, samples);
  set.statuses.resize(samples);
  set.layout.times = Eigen::VectorXd::LinSpaced(3, 0.1, 0.3);
  set.layout.output_names = {"y", "theta"};
  set.layout.output_units = {"m", "rad"};
  return set;
}

TEST(SamplesFile, HoldsBothSetsWithTheirFailures) {
  const TestFolder folder;
  ModelSpec model;
  model.parameters = makeParameters();
  Trajectories train = makeTrajectories(4);
  train.statuses[2] = {false, "body 'b': mass = 0 kg must be positive"};
  train.responses.col(2).setConstant(std::nan(""));
  const Trajectories test = makeTrajectories(3);
  writeSamplesFile(folder / "samples.h5", model, train, test);
  const Hdf5Reader file(folder / "samples.h5");
  EXPECT_EQ(file.readTexts("/parameters/name"), (std::vector<std::string>{"k", "d"}));
  EXPECT_EQ(file.readTexts("/outputs/unit"), (std::vector<std::string>{"m", "rad"}));
  EXPECT_EQ(file.readShape("/train/responses"), (std::vector<std::size_t>{4, 2, 3}));
  EXPECT_EQ(file.readSamples("/train/parameters"), train.parameters);
  EXPECT_EQ(file.readSamples("/train/responses").col(3), train.responses.col(3));
  EXPECT_EQ(file.readSamples("/test/responses"), test.responses);
  EXPECT_EQ(file.readIntegers("/train/ok"), (std::vector<std::int64_t>{1, 1, 0, 1}));
  EXPECT_EQ(file.readTexts("/train/reason")[2], train.statuses[2].reason);
}

TEST(MapsFile, ARestoredMapPredictsTheSameBits) {
  const TestFolder folder;
  const Eigen::MatrixXd features = Eigen::MatrixXd::Random(3, 30);
  Eigen::MatrixXd values(2, 30);
  values.row(0) = features.row(0).array().sin() + 1.5;
  values.row(1) = features.row(1).cwiseProduct(features.row(2));
  const std::vector<FeatureInfo> infos{
      {"y(0 s)", "m", 0, 0.0}, {"y(1 s)", "m", 0, 1.0}, {"z(0 s)", "m", 1, 0.0}};
  const Eigen::MatrixXd noise = Eigen::MatrixXd::Identity(3, 3);
  const std::vector<TransformStepSpec> transform{{ZScoreSpec{}, {}}, {PrincipalComponentsSpec{3, {}}, {}}};
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
    const GpMapTraining training =
        trainGpMap(spec, transform, {"k", "d"}, {infos, features, values, noise, 1, {}}, {1});
    writeMapsFile(folder / "maps.h5", {makeParameters(), {"a", "b", "c"}, training.map});
    const StoredMap stored = readMapsFile(folder / "maps.h5");
    EXPECT_EQ(stored.feature_names, (std::vector<std::string>{"a", "b", "c"}));
    EXPECT_EQ(stored.parameters[0].unit, "N/m");
    const Eigen::MatrixXd at = Eigen::MatrixXd::Random(3, 10);
    const Estimates expected = training.map.predict(at), restored = stored.map.predict(at);
    EXPECT_EQ(restored.mean, expected.mean);
    EXPECT_EQ(restored.stddev, expected.stddev);
    EXPECT_EQ(stored.map.residual_correlation, training.map.residual_correlation);
  }
}

TEST(MapsFile, KeepsTheBoundsThatScaleKnownInputs) {
  const TestFolder folder;
  LabelledFeatures samples;
  samples.infos = {{"y(0 s)", "m", 0, 0.0}};
  samples.features = Eigen::MatrixXd::Random(1, 20);
  samples.inputs = Eigen::MatrixXd::Random(1, 20);
  samples.parameters = samples.features + samples.inputs;
  samples.noise_covariance = Eigen::MatrixXd::Identity(1, 1);
  ParameterSpec input;
  input.name.text = "load";
  input.unit = "kg";
  input.bounds = {-3.0, 4.0, {}};
  const GpMap map = trainGpMap({}, {}, {"k"}, samples, {1}, {input}).map;
  writeMapsFile(folder / "maps.h5", {{makeParameters()[0]}, {"y(0 s)"}, map, {input}});
  const StoredMap stored = readMapsFile(folder / "maps.h5");
  ASSERT_EQ(stored.inputs.size(), 1U);
  EXPECT_EQ(stored.inputs[0].name.text, "load");
  EXPECT_EQ(stored.inputs[0].unit, "kg");
  EXPECT_EQ(stored.map.predict(samples.features, samples.inputs).stddev,
            map.predict(samples.features, samples.inputs).stddev);
}

TEST(MapsFile, RefusesOtherFiles) {
  const TestFolder folder;
  ModelSpec model;
  model.parameters = makeParameters();
  writeSamplesFile(folder / "samples.h5", model, makeTrajectories(2), makeTrajectories(2));
  EXPECT_THROW(readMapsFile(folder / "samples.h5"), std::runtime_error);
}

TEST(Provenance, SaysHowTheRunCameAbout) {
  const nlohmann::json json = nlohmann::json::parse(makeProvenanceJson({"twinmap run \"x\" \xff",
                                                                        7,
                                                                        2,
                                                                        {{"simulate", 1.5}},
                                                                        3,
                                                                        4,
                                                                        200,
                                                                        44.5,
                                                                        83.0,
                                                                        {"parameter 'k': not converged"},
                                                                        {}}));
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["threads"], 2);
  EXPECT_EQ(json["seconds"]["simulate"], 1.5);
  EXPECT_EQ(json["failed_samples"], 3);
  EXPECT_EQ(json["reused_samples"], 4);
  EXPECT_EQ(json["online"]["median_us"], 44.5);
  EXPECT_EQ(json["warnings"][0], "parameter 'k': not converged");
  EXPECT_GT(json["peak_memory_mb"], 0.1);
  for (const auto& [library, version] : json["libraries"].items()) {
    EXPECT_NE(version, "") << library;
  }
  EXPECT_NE(json["build"]["compiler"], "");
  EXPECT_NE(json["machine"]["cpu"], "");
}

}  // namespace
}  // namespace twinmap
