#include <gtest/gtest.h>

#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/files/sweep_cases.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "framework/experiment/trials/trial_trees.hpp"

namespace twinmap {
namespace {

const char* const kTwoTrials = R"(
name: oscillator
parameters: {k: {bounds: [5, 15], unit: N/m}}
system:
  bodies: {cart: {mass: 1, joint: {type: slider, coordinates: [x]}}}
  springs: [{coordinate: x, stiffness: k}]
outputs: {x: {coordinate: x}}
simulation: {duration: 2}
features: [{samples: {outputs: [x], start: 0.1, interval: 0.1, count: 20}}]
noise: {stddev: {x: 1e-3}}
trials:
  release: {initial: {coordinates: {x: 0.1}}}
  kick:
    initial: {speeds: {x: v}}
    nuisance: {v: {bounds: [0, 1], unit: m/s}}
    noise: {stddev: {x: 2e-3}}
)";

YamlNode parse(const std::string& text) {
  return parseExperimentTree(text, "trials.yaml");
}

/// The message of what readExperiment() throws; "" where it throws nothing.
std::string findError(const YamlNode& root) {
  try {
    readExperiment(root);
    return "";
  } catch (const ExperimentError& error) {
    return error.what();
  }
}

TEST(Trials, HaveTheirOwnSectionsAndShareTheOthers) {
  const std::vector<Trial> trials = expandTrials(parse(kTwoTrials));
  ASSERT_EQ(trials.size(), 2u);
  const ExperimentSpec release = readExperiment(trials[0].tree), kick = readExperiment(trials[1].tree);
  EXPECT_EQ(trials[1].name, "kick");
  EXPECT_EQ(release.model.nuisance.size(), 0u);
  EXPECT_EQ(kick.model.nuisance.size(), 1u);
  EXPECT_EQ(release.noise.stddev[0].stddev, 1e-3);
  EXPECT_EQ(kick.noise.stddev[0].stddev, 2e-3);
  EXPECT_EQ(kick.model.parameters[0].name.text, "k");
}

TEST(Trials, AFileWithoutThemIsOneTrial) {
  const std::vector<Trial> trials =
      expandTrials(parse("name: a\nparameters: {k: {bounds: [1, 2]}}\nseed: 3\n"));
  ASSERT_EQ(trials.size(), 1u);
  EXPECT_EQ(trials[0].name, "");
}

TEST(Trials, OneIsChosenOrSweptOver) {
  EXPECT_EQ(readExperiment(parseExperimentTree(kTwoTrials, "t.yaml", {"trial=kick"})).noise.stddev[0].stddev,
            2e-3);
  const std::vector<SweepCase> cases =
      expandCases(parseExperimentTree(kTwoTrials, "t.yaml", {"trial=release,kick"}));
  ASSERT_EQ(cases.size(), 2u);
  EXPECT_EQ(cases[1].name, "trial-kick");
  EXPECT_EQ(cases[1].experiment.model.nuisance.size(), 1u);
}

TEST(Trials, ErrorsNameWhatIsWrong) {
  EXPECT_NE(findError(parse(std::string(kTwoTrials) + "  a.b: {simulation: {duration: 3}}\n"))
                .find("use letters, digits, '_' and '-' alone"),
            std::string::npos);
  try {
    requireOneTrial(readExperiment(parse(kTwoTrials)), "a simulation is of one");
    ADD_FAILURE();
  } catch (const ExperimentError& error) {
    EXPECT_NE(std::string(error.what()).find("choose one by trial=release"), std::string::npos)
        << error.what();
  }
  EXPECT_NE(findError(parseExperimentTree(kTwoTrials, "t.yaml", {"trial=kik"})).find("did you mean 'kick'?"),
            std::string::npos);
  std::string other = kTwoTrials;
  other += "  third: {parameters: {k: {bounds: [1, 2]}}}\n";
  EXPECT_NE(
      findError(parseExperimentTree(other, "t.yaml", {"trial=third"})).find("'parameters' is not a section"),
      std::string::npos)
      << findError(parseExperimentTree(other, "t.yaml", {"trial=third"}));
}

TEST(Trials, PriorsComeFromTheFile) {
  std::string text = kTwoTrials;
  text.replace(text.find("{bounds: [5, 15], unit: N/m}"), 28,
               "{unit: N/m, prior: {normal: {mean: 10, stddev: 0.5}}}");
  const ExperimentSpec experiment = readExperiment(parseExperimentTree(text, "t.yaml", {"trial=release"}));
  EXPECT_NEAR(experiment.model.parameters[0].bounds.lower, 10.0 - 3.8906 * 0.5, 1e-4);
  EXPECT_TRUE(experiment.model.parameters[0].prior->hasRange());
}

TEST(CombinedTrials, HaveTheFeaturesNoiseAndNuisanceOfEachByItsName) {
  const ExperimentSpec both = readExperiment(parse(kTwoTrials));
  ASSERT_EQ(both.trials.size(), 2u);
  EXPECT_EQ(collectNames(both.model.outputs), (std::vector<std::string>{"release.x", "kick.x"}));
  EXPECT_EQ(collectNames(both.model.nuisance), std::vector<std::string>{"kick.v"});
  EXPECT_EQ(collectNames(both.model.parameters), std::vector<std::string>{"k"});
  ASSERT_EQ(both.features.size(), 2u);
  EXPECT_EQ(getOutputs(both.features[1]).front().text, "kick.x");
  EXPECT_EQ(both.noise.stddev[0].stddev, 1e-3);
  EXPECT_EQ(both.noise.stddev[1].stddev, 2e-3);
}

TEST(CombinedTrials, ReadBackAsTheyWereWritten) {
  for (const std::vector<std::string>& overrides :
       {std::vector<std::string>{}, {"inverse_map=gp"}, {"design.train.samples=50", "noise.scale=2"}}) {
    const ExperimentSpec both = readExperiment(parseExperimentTree(kTwoTrials, "t.yaml", overrides));
    const std::string text = writeExperiment(both);
    EXPECT_EQ(writeExperiment(readExperiment(parseYaml(text, "again.yaml"))), text);
    EXPECT_EQ(writeExperiment(readResolved(text)), text);
    EXPECT_EQ(collectNames(readResolved(text).model.outputs), collectNames(both.model.outputs));
  }
}

TEST(CombinedTrials, ScaleOfTheNoiseIsThatOfEach) {
  const ExperimentSpec both = readExperiment(parseExperimentTree(kTwoTrials, "t.yaml", {"noise.scale=3"}));
  EXPECT_DOUBLE_EQ(both.noise.stddev[0].stddev, 3e-3);
  EXPECT_DOUBLE_EQ(both.noise.stddev[1].stddev, 2e-3);  // of a section of its own, which has no scale
}

TEST(CombinedTrials, ChangeOneByOne) {
  ExperimentSpec both = readExperiment(parse(kTwoTrials));
  changeTrials(both, [](ExperimentSpec& trial) { trial.model.simulation.max_steps = 7; });
  EXPECT_EQ(both.model.trials[0].model.simulation.max_steps, 7);
  EXPECT_EQ(both.model.trials[1].model.simulation.max_steps, 7);
  EXPECT_EQ(both.features.size(), 2u);
}

TEST(CombinedTrials, RefuseWhatCannotBeOne) {
  const std::string base(kTwoTrials);
  const std::string modes =
      "    features: [{modes: {count: 1}}]\n    noise: {modes: {frequency: 1, damping_ratio: 1}}\n";
  EXPECT_NE(findError(parse(base + "  a:\n" + modes + "  b:\n" + modes)).find("only one of them may"),
            std::string::npos);
  EXPECT_NE(findError(parse(base + "  a: {transform: [z_score]}\n")).find("go through one"),
            std::string::npos);
  EXPECT_NE(findError(parse(base + "  a: {inputs: {m0: {bounds: [0, 1]}}, constants: {c: m0}}\n"
                                   "  b: {inputs: {m0: {bounds: [0, 2]}}, constants: {c: m0}}\n"))
                .find("other bounds in another trial"),
            std::string::npos);
}

}  // namespace
}  // namespace twinmap
