#include <gtest/gtest.h>

#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/files/sweep_cases.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/yaml/compare_trees.hpp"
#include "tests/framework/experiment/experiments.hpp"

namespace twinmap {
namespace {

std::vector<SweepCase> expand(const std::vector<std::string>& overrides) {
  return expandSweep(loadExperimentTree(kCart, overrides));
}

std::vector<std::string> getNames(const std::vector<SweepCase>& cases) {
  std::vector<std::string> names;
  for (const SweepCase& one : cases) {
    names.push_back(one.name);
  }
  return names;
}

std::string getSweepError(const std::vector<std::string>& overrides) {
  try {
    expand(overrides);
  } catch (const ExperimentError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Sweep, GridTakesEveryValueWithEveryOtherInOrder) {
  const std::vector<SweepCase> cases = expand({"noise.scale=0.5,1", "seed=1..3"});
  EXPECT_EQ(getNames(cases),
            (std::vector<std::string>{"scale-0.5_seed-1", "scale-0.5_seed-2", "scale-0.5_seed-3",
                                      "scale-1_seed-1", "scale-1_seed-2", "scale-1_seed-3"}));
  EXPECT_EQ(cases[4].values, (std::vector<std::string>{"1", "2"}));
  EXPECT_EQ(cases[4].experiment.noise.scale, 1.0);
  EXPECT_EQ(cases[4].experiment.seed, 2u);
}

TEST(Sweep, ZipTakesTheFirstValuesThenTheSecond) {
  const std::vector<SweepCase> cases = expand({"sweep.combine=zip", "noise.scale=0.5,1", "seed=7,9"});
  EXPECT_EQ(getNames(cases), (std::vector<std::string>{"scale-0.5_seed-7", "scale-1_seed-9"}));
  EXPECT_NE(getSweepError({"sweep.combine=zip", "noise.scale=0.5,1", "seed=1..3"})
                .find("'combine: zip' needs as many"),
            std::string::npos);
}

TEST(Sweep, ListsInBracketsAndCommasInParenthesesAndQuotesAreValues) {
  const std::vector<SweepCase> cases =
      expand({"transform=[z_score],[whiten, principal_components]", "system.springs[0].stiffness=max(k, 1)",
              "design.test.samples=10", "description=short, and sweet"});
  EXPECT_EQ(getNames(cases), (std::vector<std::string>{"transform-1", "transform-2"}));
  EXPECT_EQ(cases[0].experiment.transform.size(), 1u);
  EXPECT_EQ(cases[1].experiment.transform.size(), 2u);
  EXPECT_EQ(cases[1].values, (std::vector<std::string>{"[whiten, principal_components]"}));
  EXPECT_EQ(cases[0].experiment.model.system.elements.get<Spring>()[0].stiffness.text, "max(k, 1)");
  EXPECT_EQ(cases[0].experiment.description, "short, and sweet");
}

TEST(Sweep, NamesTellKeysWithTheSameEndApart) {
  const std::vector<SweepCase> cases = expand({"design.train.samples=10,20", "design.test.samples=5,6"});
  EXPECT_EQ(cases[3].name, "train.samples-20_test.samples-6");
}

TEST(Sweep, TheCommandLineReplacesWhatTheFileSweeps) {
  YamlNode tree = parseYaml(
      writeIndependentDefaults(loadExperimentTree(kCart, {"seed=1..4", "noise.scale=1,2"})), "sweep.yaml");
  const std::string file = testing::TempDir() + "/sweep.yaml";
  FILE* out = fopen(file.c_str(), "w");
  fputs(writeYaml(tree).c_str(), out);
  fclose(out);
  EXPECT_EQ(expandSweep(loadExperimentTree(file)).size(), 8u);
  EXPECT_EQ(expandSweep(loadExperimentTree(file, {"seed=5,6"})).size(), 4u);
  EXPECT_EQ(expandSweep(loadExperimentTree(file, {"seed=5"})).size(), 2u);
  EXPECT_FALSE(readSweep(loadExperimentTree(file, {"seed=5", "noise.scale=3"})));
}

TEST(Sweep, DefaultsThatDependOnSweptValuesFollowEachCase) {
  const std::string resolved =
      writeIndependentDefaults(loadExperimentTree(kCart, {"design.train.samples=100,2000"}));
  EXPECT_EQ(resolved.find("replicates"), std::string::npos);
  const std::vector<SweepCase> cases = expandSweep(parseYaml(resolved, "resolved.yaml"));
  EXPECT_EQ(cases[0].experiment.noise.replicates, 4);
  EXPECT_EQ(cases[1].experiment.noise.replicates, 1);
  EXPECT_EQ(writeIndependentDefaults(parseYaml(resolved, "resolved.yaml")), resolved);
}

TEST(Sweep, WhatIsWrongIsNamedAtItsPlace) {
  const auto expect = [](const std::string& override_text, const std::string& message) {
    EXPECT_NE(getSweepError({override_text}).find(message), std::string::npos)
        << getSweepError({override_text});
  };
  expect("seed=1,,2", "command line: 'seed=1,,2' has an empty value");
  expect("seed=1,2,", "has an empty value");
  expect("seed=3..1", "'3..1' is not a range");
  expect("seed=1..", "'1..' is not a range");
  expect("seed=1,2,1", "'1' is given twice");
  expect("noise.scale=1,-1", "command line: noise.scale: '-1' must be a number, 0 or above");
  expect("noise.scal=1,2", "did you mean 'scale'?");
  expect("sweep={over: {noise.scale: []}}", "'[]' must list at least one value");
  expect("sweep={over: {}}", "must name at least one key path");
  expect("sweep={over: {name: [a, b]}}", "'name' cannot be swept");
  expect("sweep={over: {noise: [{}], noise.scale: [1]}}", "overlaps with the swept key 'noise'");
  expect("sweep={over: {seed: 1..200000}}", "is not a range");
  expect("sweep={over: {seed: 1..9000, noise.scale: [1, 2]}}", "more than 10000 cases");
  expect("sweep={over: {seed: -9000000000000000000..9000000000000000000}}", "is not a range");
  expect("sweep={over: {seed: -9223372036854775808..9223372036854775807}}", "is not a range");
}

TEST(CompareTrees, NamesWhatDiffersAndIgnoresOrderAndDescriptions) {
  const auto compare = [](const std::string& before, const std::string& after) {
    std::string text;
    for (const KeyDifference& d : compareTrees(parseYaml(before, "a"), parseYaml(after, "b"))) {
      text += d.key + ": " + d.before + " -> " + d.after + "\n";
    }
    return text;
  };
  EXPECT_EQ(compare("{a: 1, b: {c: 2}, description: x}", "{b: {c: 2}, a: 1, description: y}"), "");
  EXPECT_EQ(compare("{b: {c: 2, d: [1, 2]}}", "{b: {c: 3, d: [1, 4], e: 5}}"),
            "b.c: 2 -> 3\nb.d[1]: 2 -> 4\nb.e: nothing -> 5\n");
  EXPECT_EQ(compare("{parameters: {k: 1, d: 2}}", "{parameters: {d: 2, k: 1}}"),
            "parameters: k, d -> d, k\n");
}

}  // namespace
}  // namespace twinmap
