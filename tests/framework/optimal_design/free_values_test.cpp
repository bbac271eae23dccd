#include "framework/optimal_design/free_values.hpp"

#include <gtest/gtest.h>

#include "framework/experiment/tree/overrides.hpp"
#include "framework/experiment/tree/read_value.hpp"

namespace twinmap::experiment_design {
namespace {

constexpr const char* kExcitation = R"(
excitation:
  F: {pulses: [{amplitude: 5, start: 0.2, end: t_end}]}
  M: {multisines: [{amplitude: 2, frequencies: [1, 2, 3]}]}
)";

FreeValues readFree(const std::string& text) {
  FreeValues free;
  readValue(parseYaml(text, "free.yaml"), free);
  return free;
}

std::string findMessage(const std::string& free) {
  YamlNode tree = parseYaml(kExcitation, "experiment.yaml");
  try {
    resolveFreeNumbers(readFree(free), tree);
  } catch (const ExperimentError& error) {
    return error.what();
  }
  return "";
}

TEST(FreeValues, WriteOutTheListsThatAMultisineLeavesToDefaults) {
  YamlNode tree = parseYaml(kExcitation, "experiment.yaml");
  const std::vector<FreeNumber> numbers = resolveFreeNumbers(
      readFree("{'F.pulses[0].start': [0, 1], 'M.multisines[0].amplitudes': {each: [0, 4]}, "
               "'M.multisines[0].phases': {each: [-20, 20]}}"),
      tree);
  ASSERT_EQ(numbers.size(), 7U);
  EXPECT_EQ(numbers[0].key, "excitation.F.pulses[0].start");
  EXPECT_EQ(numbers[0].present, 0.2);
  EXPECT_FALSE(numbers[1].is_phase);
  EXPECT_EQ(numbers[1].present, 2.0);
  EXPECT_TRUE(numbers[6].is_phase);
  EXPECT_NEAR(numbers[6].present, -2.0 * 3.141592653589793, 1e-12);  // -pi k (k - 1) / N of k = N = 3
  EXPECT_EQ(findValue(tree, {"excitation.M.multisines[0].amplitude", {}}), nullptr);
}

TEST(FreeValues, ArePutBackWhereTheyCameFrom) {
  YamlNode tree = parseYaml(kExcitation, "experiment.yaml");
  const auto numbers = resolveFreeNumbers(readFree("{'F.pulses[0].start': [0, 1]}"), tree);
  const Eigen::VectorXd values = calcValues(numbers, Eigen::VectorXd::Constant(1, 0.75));
  const YamlNode changed = setValues(tree, numbers, values);
  EXPECT_EQ(findValue(changed, {"excitation.F.pulses[0].start", {}})->scalar, "0.75");
  EXPECT_DOUBLE_EQ(calcPresentPoint(numbers)[0], 0.2);
}

TEST(FreeValues, NameWhatCannotBeFree) {
  EXPECT_NE(findMessage("{'F.pulses[1].start': [0, 1]}").find("is not a value of the excitation"),
            std::string::npos);
  EXPECT_NE(findMessage("{'F.pulses[0].end': [0, 1]}").find("plain number"), std::string::npos);
  EXPECT_NE(findMessage("{'F.pulses[0].start': {each: [0, 1]}}").find("must be a list"), std::string::npos);
  EXPECT_NE(
      findMessage("{'M.multisines[0].frequencies': {each: [1, 2]}, 'M.multisines[0].frequencies[1]': [1, 2]}")
          .find("twice"),
      std::string::npos);
}

}  // namespace
}  // namespace twinmap::experiment_design
