#include "framework/experiment/check/unused_parameters.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "framework/experiment/files/experiment_file.hpp"

namespace twinmap {
namespace {

std::vector<std::string> list(const std::string& text) {
  return listUnusedParameters(parseYaml(text, "e.yaml"));
}

TEST(UnusedParameters, AreNamed) {
  const std::string machine =
      "system: {bodies: {cart: {mass: 2 * m + k_2}}}\n"
      "priors: [{correlated: {names: [m, k], correlation: 0.5}}]\n";
  const std::vector<std::string> unused =
      list("parameters:\n  m: {bounds: [1, 2]}\n  k: {bounds: [1, 2]}\n" + machine);
  ASSERT_EQ(unused.size(), 1u);  // k_2 is another, and a prior uses nothing
  EXPECT_EQ(unused[0].rfind("parameters.k: nothing uses this parameter", 0), 0u) << unused[0];
}

TEST(UnusedParameters, AreUsedByDelaysOfTheMeasurementAndTheInitialState) {
  EXPECT_TRUE(list("parameters: {late: {bounds: [0, 1]}, x0: {bounds: [0, 1]}}\n"
                   "system: {bodies: {}}\ninitial: {coordinates: {x: x0}}\n"
                   "measurement: {columns: {x: {delay: late}}}\n")
                  .empty());
}

TEST(UnusedParameters, OfATypedExperimentAreThoseOfItsFile) {
  YamlNode tree = loadYaml(TWINMAP_SOURCE_DIR "/experiments/duffing/cart.yaml");
  EXPECT_TRUE(listUnused(readExperiment(tree), "parameters").empty());
  tree.find("parameters")->entries[1].key = "c";  // the damper's d is a constant now
  tree.entries.push_back({"constants", {}, parseYaml("d: {value: 1, unit: N s/m}", "c.yaml")});
  EXPECT_EQ(listUnused(readExperiment(tree), "parameters"), std::vector<std::string>{"c"});
}

TEST(UnusedParameters, OfAModelFromElsewhereAreItsOwn) {
  EXPECT_TRUE(list("parameters: {k: {bounds: [0, 1]}}\nfmu: {file: a.fmu}\n").empty());
}

TEST(UnusedParameters, NoneIsFoundInAnyOfTheExperiments) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(TWINMAP_SOURCE_DIR "/experiments")) {
    if (entry.path().extension() == ".yaml") {
      const std::vector<std::string> unused = listUnusedParameters(loadYaml(entry.path().string()));
      EXPECT_TRUE(unused.empty()) << entry.path() << ": " << unused.front();
    }
  }
}

}  // namespace
}  // namespace twinmap
