#include "framework/results/gates.hpp"

#include <gtest/gtest.h>

namespace twinmap {
namespace {

CsvTable makeMetrics() {
  return parseCsv("parameter,coverage95,limit_pct\na,0.95,1\nb,0.99,\n", "metrics.csv");
}

GateSpec makeGate(const std::string& metric, std::optional<double> min, std::optional<double> max) {
  return {{metric, {}}, std::nullopt, min, max};
}

TEST(Gates, HoldForEveryParameterUnlessOneIsNamed) {
  GateSpec gate = makeGate("coverage95", 0.93, 0.97);
  EXPECT_FALSE(checkGate(gate, makeMetrics()).passed);
  EXPECT_EQ(checkGate(gate, makeMetrics()).found, "failed: b 0.99; passed: a 0.95");
  EXPECT_EQ(checkGate(gate, makeMetrics()).condition, "0.93 \u2264 coverage95 \u2264 0.97, every parameter");
  gate.parameter = Name{"a", {}};
  EXPECT_TRUE(checkGate(gate, makeMetrics()).passed);
}

TEST(Gates, IncludeTheirLimits) {
  EXPECT_TRUE(checkGate(makeGate("coverage95", 0.95, 0.99), makeMetrics()).passed);
  EXPECT_FALSE(checkGate(makeGate("coverage95", 0.95 + 1e-9, 0.99), makeMetrics()).passed);
  EXPECT_FALSE(checkGate(makeGate("coverage95", 0.95, 0.99 - 1e-9), makeMetrics()).passed);
}

TEST(Gates, AMissingValueFails) {
  EXPECT_FALSE(checkGate(makeGate("limit_pct", {}, 2.0), makeMetrics()).passed);
  EXPECT_FALSE(checkGate(makeGate("ratio_to_limit", {}, 2.0), makeMetrics()).passed);
  EXPECT_FALSE(checkGate(makeGate("coverage95", 0.0, {}), parseCsv("parameter,coverage95\n", "")).passed);
}

TEST(Gates, ManyValuesAreCountedRatherThanListed) {
  std::string csv = "case,parameter,sd_pct\n";
  for (int i = 0; i < 20; ++i) {
    csv += std::to_string(i) + ",a," + std::to_string(i) + "\n";
  }
  EXPECT_EQ(checkGate(makeGate("sd_pct", {}, 18.0), parseCsv(csv, "")).found,
            "19 of 20 values passed; failed first: a 19");
}

}  // namespace
}  // namespace twinmap
