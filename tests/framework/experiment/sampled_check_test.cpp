// What a check says against sensors, motions and controllers.
#include <gtest/gtest.h>

#include "framework/experiment/files/experiment_file.hpp"

namespace twinmap {
namespace {

const std::string kSampled = std::string(TWINMAP_SOURCE_DIR) + "/experiments/mechanisms/sampled_servo.yaml";

/// The message against the experiment with overrides; "" if there is none.
std::string getMessage(const std::vector<std::string>& overrides) {
  try {
    loadExperiment(kSampled, overrides);
  } catch (const ExperimentError& error) {
    return error.what();
  }
  return "";
}

void expectMessage(const std::vector<std::string>& overrides, const std::string& part) {
  EXPECT_NE(getMessage(overrides).find(part), std::string::npos) << getMessage(overrides);
}

TEST(SampledCheck, AcceptsTheExample) {
  EXPECT_EQ(getMessage({}), "");
}

TEST(SampledCheck, NamesWhatAControllerReadsAndComputesWrongly) {
  const std::string position = "system.controllers.position.";
  expectMessage({position + "reads.x=encodr"}, "did you mean 'encoder'?");
  expectMessage({position + "writes.u.value=k_p * (r - y)"}, "'y'");
  expectMessage({position + "writes.u.value=k_p * difference(x)"}, "does not come out in V");
  expectMessage({position + "writes.u.value=k_p * (r - x) + difference(x)"}, "different units");
  expectMessage({position + "writes.u.unit=A"}, "different units");
  expectMessage({position + "delay=M"}, "does not come out in s");
  expectMessage({position + "sample_time=0"}, "must be a number above 0");
  expectMessage({"system.expressions={w: difference(q)}"}, "difference(q)");
}

TEST(SampledCheck, NamesWrongUnitsAndOrdersOfSensors) {
  const std::string sensor = "outputs.current.sensor.";
  expectMessage({sensor + "lag=M"}, "does not come out in s");
  expectMessage({sensor + "filter.butterworth=9"}, "from 1 to 8");
  expectMessage({sensor + "quantum=0"}, "must be a number above 0");
  expectMessage({sensor + "lagg=1"}, "did you mean 'lag'?");
}

TEST(SampledCheck, RefusesMotionsThatNoSignalCanPrescribe) {
  expectMessage({"system.motions=[{coordinate: q, follows: s}]"}, "'s'");
  expectMessage({"system.motions=[{coordinate: p, follows: r}]"}, "'p'");
  expectMessage({"system.motions=[{coordinate: q, follows: r}]", "excitation.r.unit=N"},
                "is in N, but 'q' in m");
  expectMessage({"system.motions=[{coordinate: q, follows: r}]",
                 "excitation.r.pulses=[{amplitude: 1, start: 0, end: 1}]"},
                "its pulses jump");
  expectMessage({"system.motions=[{coordinate: q, follows: r}, {coordinate: q, follows: r}]"},
                "follows another signal already");
  EXPECT_EQ(getMessage({"system.motions=[{coordinate: q, follows: r}]"}), "");
}

}  // namespace
}  // namespace twinmap
