#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "framework/base/hdf5/hdf5_file.hpp"
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
