#include "framework/experiment/files/experiment_file.hpp"

#include <gtest/gtest.h>

#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/files/resolve_defaults.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/joint_type.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "tests/framework/experiment/experiments.hpp"

namespace twinmap {
namespace {

TEST(ExperimentFile, ReadsTheTwoBeamExperiment) {
  const ExperimentSpec experiment = loadExperiment(kTable1);
  EXPECT_EQ(experiment.name.text, "two_beam_table1");
  ASSERT_EQ(experiment.model.parameters.size(), 4u);
  EXPECT_EQ(experiment.model.parameters[1].name.text, "d_theta");
  EXPECT_EQ(experiment.model.parameters[1].unit, "N m s/rad");
  EXPECT_DOUBLE_EQ(experiment.model.parameters[1].bounds.upper, 2.25e-4);
  EXPECT_EQ(experiment.model.system.bodies[1].joint.type, JointType::kPin);
  EXPECT_EQ(experiment.model.system.bodies[0].joint.parent.text, "ground");
  EXPECT_EQ(experiment.model.system.gravity[2].text, "-g");
  EXPECT_DOUBLE_EQ(experiment.noise.stddev[1].stddev, 0.015);
  EXPECT_EQ(std::get<SamplesFeatureSpec>(experiment.features[0]).count, 100);
  EXPECT_EQ(experiment.inverse_map.findGp()->length_scales, LengthScales::kShared);
}

TEST(ExperimentFile, ResolvedExperimentReadsBackAsItself) {
  const std::string resolved = writeExperiment(loadExperiment(kTable1));
  const std::string again = writeExperiment(readExperiment(parseYaml(resolved, "resolved.yaml")));
  EXPECT_EQ(again, resolved);
  EXPECT_NE(resolved.find("relative_tolerance"), std::string::npos);
}

TEST(ExperimentFile, NuisanceAndInputsAreSampledAfterTheParametersAndUsedLikeThem) {
  const ExperimentSpec experiment = loadExperiment(
      kTable1, {"nuisance={bias: {bounds: [-1e-3, 1e-3], unit: m}}", "inputs={k_set: {bounds: [0, 2]}}",
                "outputs.y.offset=bias", "system.springs[0].stiffness=k_y + k_set"});
  EXPECT_EQ(collectNames(collectSampled(experiment.model)),
            (std::vector<std::string>{"d_y", "d_theta", "k_y", "k_theta", "bias", "k_set"}));
  EXPECT_EQ(collectNames(collectUnknown(experiment.model)).back(), "bias");
  EXPECT_EQ(countSampled(experiment.model), 6);
  const std::string resolved = writeExperiment(experiment);
  EXPECT_EQ(writeExperiment(readExperiment(parseYaml(resolved, "resolved.yaml"))), resolved);
}

TEST(ExperimentFile, AResolvedTableHoldsWhatWasMeasuredAndWhere) {
  const std::string measured = "measured: {file: a.csv, column: 'u [V]', sample_rate: 8, start: 0.5}";
  ExperimentSpec experiment = loadExperiment(kTable1, {"excitation.F.tables=[{" + measured + "}]"});
  TableSpec& table = experiment.model.excitation[0].tables[0];
  EXPECT_TRUE(table.times.empty());
  table.times = {0.0, 0.125, 0.25};
  table.values = {1.0 / 3.0, 0.1, 1e-17};
  const std::string resolved = writeExperiment(experiment);
  const ExperimentSpec again = readExperiment(parseYaml(resolved, "resolved.yaml"));
  const TableSpec& read = again.model.excitation[0].tables[0];
  EXPECT_EQ(read.values, table.values);
  EXPECT_EQ(read.measured->column.text, "u [V]");
  EXPECT_EQ(writeExperiment(again), resolved);
}

TEST(ExperimentFile, OverridesReplaceAddAndIndex) {
  const ExperimentSpec experiment =
      loadExperiment(kTable1, {"seed=7", "noise.scale=1e-1", "parameters.k_y.bounds=[4, 16]",
                               "system.springs[1].rest=0.25", "inverse_map.gp.length_scales=per_output",
                               "system.force_laws=[{coordinate: y, force: -3*y^3 - tanh(y_dot/0.01)}]"});
  EXPECT_EQ(experiment.seed, 7u);
  EXPECT_DOUBLE_EQ(experiment.noise.scale, 0.1);
  EXPECT_DOUBLE_EQ(experiment.model.parameters[2].bounds.lower, 4.0);
  EXPECT_EQ(experiment.model.system.elements.get<Spring>()[1].rest.text, "0.25");
  EXPECT_EQ(experiment.inverse_map.findGp()->length_scales, LengthScales::kPerOutput);
  EXPECT_EQ(experiment.model.system.elements.get<ForceLaw>().size(), 1u);
}

TEST(ExperimentFile, TheLastOverrideOfAKeyWins) {
  EXPECT_EQ(loadExperiment(kTable1, {"seed=7", "seed=8"}).seed, 8u);
}

TEST(ExperimentFile, ReportAxesDefaultToTheLastTwoParameters) {
  const ExperimentSpec experiment = loadExperiment(kTable1, {"report={}"});
  ASSERT_EQ(experiment.report.over.size(), 2u);
  EXPECT_EQ(experiment.report.over[0].text, "k_y");
  EXPECT_EQ(experiment.report.over[1].text, "k_theta");
}

TEST(ExperimentFile, DefaultsAreWhitenedComponentsAndReplicates) {
  const ExperimentSpec experiment = loadExperiment(kCart);
  ASSERT_EQ(experiment.transform.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<WhitenSpec>(experiment.transform[0].kind));
  EXPECT_TRUE(std::holds_alternative<PrincipalComponentsSpec>(experiment.transform[1].kind));
  EXPECT_EQ(takeTrainingSamples(experiment, 250).noise.replicates, 4);
  EXPECT_EQ(loadExperiment(kTable1, {"noise={stddev: {y: 1, theta: 1}}", "design.train.samples=1000"})
                .noise.replicates,
            3);
}

TEST(ExperimentFile, AnAutomaticNumberOfTrainingSamplesStaysAutomaticAndHasADesignThatGrows) {
  for (const std::string design : {"", "design={train: {samples: automatic}}"}) {
    const ExperimentSpec experiment =
        loadExperiment(kCart, design.empty() ? std::vector<std::string>{} : std::vector<std::string>{design});
    EXPECT_TRUE(readResolved(writeExperiment(experiment)).design.train.samples.automatic);
    const PointSetSpec& train = experiment.design.train;
    EXPECT_TRUE(train.samples.automatic);
    EXPECT_EQ(train.samples, 800);  // the most
    EXPECT_EQ(train.method, DesignMethod::kNestedLatinHypercube);
    EXPECT_EQ(train.smallest, 100);
    EXPECT_EQ(train.time, 10.0);
    EXPECT_FALSE(experiment.noise.replicates.has_value());
    const ExperimentSpec taken = takeTrainingSamples(experiment, 1000);
    EXPECT_FALSE(taken.design.train.samples.automatic);
    EXPECT_EQ(taken.design.train.samples, 1000);
    EXPECT_EQ(taken.noise.replicates, 3);
    EXPECT_EQ(writeExperiment(readResolved(writeExperiment(taken))), writeExperiment(taken));
  }
}

TEST(ExperimentFile, ProcessesTakeTwoHundredAndFiftyTrainingSamplesByDefault) {
  const PointSetSpec train = loadExperiment(kCart, {"inverse_map=gp"}).design.train;
  EXPECT_FALSE(train.samples.automatic);
  EXPECT_EQ(train.samples, 250);
  EXPECT_EQ(train.method, DesignMethod::kLatinHypercube);
}

TEST(ExperimentFile, TheSizeOfANetworkFollowsFromTheSimulationsThatAloneTeachIt) {
  const auto find_steps = [](const std::string& network, const std::string& samples) {
    const ExperimentSpec experiment =
        loadExperiment(kCart, {"inverse_map={network: " + network + "}", "design.train.samples=" + samples});
    EXPECT_EQ(writeExperiment(readResolved(writeExperiment(experiment))), writeExperiment(experiment));
    return experiment.inverse_map.findNetwork()->steps;
  };
  EXPECT_EQ(find_steps("{samples_from: simulations}", "250"), 8000);
  EXPECT_EQ(find_steps("{}", "4000"), 18000);
  EXPECT_EQ(find_steps("{}", "100000"), 18000);
  EXPECT_EQ(find_steps("{}", "250"), std::nullopt);  // left to the training
  EXPECT_EQ(find_steps("{batch: 100}", "250"), 8000);
}

TEST(ExperimentFile, WhiteningNeedsNoise) {
  EXPECT_THROW(loadExperiment(kTable1, {"transform=[whiten]", "noise.scale=0"}), ExperimentError);
  EXPECT_THROW(loadExperiment(kTable1, {"transform=[whiten]", "noise.stddev.y=0"}), ExperimentError);
  EXPECT_THROW(loadExperiment(kTable1, {"transform=[whiten, principal_components]",
                                        "inverse_map.gp.length_scales=per_output"}),
               ExperimentError);
}

TEST(ExperimentFile, PerOutputHasNoMeaningBehindStepsThatMixFeatures) {
  const std::string per_output = "inverse_map.gp.length_scales=per_output";
  EXPECT_NO_THROW(loadExperiment(kTable1, {"transform=[z_score, whiten]", per_output}));
  for (const std::string& step :
       std::vector<std::string>{"principal_components: {components: 2}", "whiten: {by: covariance}"}) {
    try {
      loadExperiment(kTable1, {"transform=[z_score, " + step + "]", per_output});
      ADD_FAILURE() << step;
    } catch (const ExperimentError& error) {
      EXPECT_NE(std::string(error.what()).find("transform[1]"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("per_output"), std::string::npos) << error.what();
    }
  }
}

TEST(ExperimentFile, EveryStepOfATransformIsReadAndWritten) {
  const ExperimentSpec experiment = loadExperiment(
      kTable1, {"transform=[whiten: {by: covariance}, principal_components: {components: automatic}, "
                "partial_least_squares, partial_least_squares: {components: 2}]"});
  EXPECT_EQ(std::get<WhitenSpec>(experiment.transform[0].kind).by, WhitenBy::kCovariance);
  EXPECT_FALSE(std::get<PrincipalComponentsSpec>(experiment.transform[1].kind).components.number);
  EXPECT_FALSE(std::get<PartialLeastSquaresSpec>(experiment.transform[2].kind).components.number);
  EXPECT_EQ(std::get<PartialLeastSquaresSpec>(experiment.transform[3].kind).components.number, 2);
  const std::string text = writeExperiment(experiment);
  EXPECT_EQ(writeExperiment(readExperiment(parseYaml(text, "again"))), text);
}

TEST(ExperimentFile, EveryJointTypeIsReadWithItsCoordinates) {
  const std::vector<std::pair<std::string, std::string>> joints{{"weld", "[]"},
                                                                {"slider", "[a]"},
                                                                {"pin", "[a]"},
                                                                {"cylinder", "[a, b]"},
                                                                {"universal", "[a, b]"},
                                                                {"bend_stretch", "[a, b]"},
                                                                {"planar", "[a, b, c]"},
                                                                {"translation", "[a, b, c]"},
                                                                {"gimbal", "[a, b, c]"},
                                                                {"ball", "[a, b, c]"},
                                                                {"bushing", "[a, b, c, d, e, f]"},
                                                                {"free", "[a, b, c, d, e, f]"}};
  for (const auto& [type, coordinates] : joints) {
    EXPECT_NO_THROW(loadExperiment(kTable1, {"system.bodies.extra={mass: 1, joint: {type: " + type +
                                             ", coordinates: " + coordinates + "}}"}))
        << type;
  }
  EXPECT_NO_THROW(loadExperiment(
      kTable1, {"system.bodies.extra={mass: 1, joint: {type: screw, pitch: 0.1, coordinates: [a]}}"}));
}

}  // namespace
}  // namespace twinmap
