#include "framework/models/external/excitation_table.hpp"

#include <gtest/gtest.h>

namespace twinmap::testing {
namespace {

TEST(ExcitationTable, HasTheLimitsOfAPulseFromWithinEachPhaseAndValuesAfterItsEdges) {
  SignalSpec pulse;
  pulse.name.text = "F";
  pulse.pulses = {{{"5", {}}, {"0.2", {}}, {"0.25", {}}}};
  const std::vector<SignalSpec> signals{pulse};
  const ModelSpec nothing_named;
  ModelNumbers numbers(nothing_named);
  Excitation excitation(signals);
  excitation.update(numbers);
  const ExcitationTable table = calcExcitationTable(excitation, Eigen::Vector4d(0.0, 0.2, 0.25, 1.0), 1.0);
  EXPECT_EQ(table.phases, (std::vector<double>{0.0, 0.2, 0.25, 1.0}));
  EXPECT_EQ(table.begin.col(0), Eigen::Vector3d(0.0, 5.0, 0.0));
  EXPECT_EQ(table.end.col(0), Eigen::Vector3d(0.0, 5.0, 0.0));
  EXPECT_EQ(table.values.col(0), Eigen::Vector4d(0.0, 5.0, 0.0, 0.0));
}

TEST(ExcitationTimes, ReachTheEndWhetherTheIntervalDividesTheDurationOrNot) {
  EXPECT_EQ(makeExcitationTimes(0.1, 0.3).size(), 4);
  EXPECT_EQ(makeExcitationTimes(0.4, 1.0), Eigen::Vector4d(0.0, 0.4, 0.8, 1.0));
}

}  // namespace
}  // namespace twinmap::testing
