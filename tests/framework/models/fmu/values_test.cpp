#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "framework/models/fmu/instance/native_values.hpp"
#include "framework/models/fmu/package/package.hpp"
#include "framework/models/fmu/run/bind_variables.hpp"
#include "tests/framework/models/fmu/fmu_case.hpp"

namespace twinmap::testing {
namespace {

using fmi::Kind;

/// What `action` throws, or "".
template <class Action>
std::string catchMessage(const Action& action) {
  try {
    action();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

FmuCase makeFeedthrough(const std::string& name, Kind kind) {
  FmuCase fmu;
  fmu.name = name;
  fmu.kind = kind;
  fmu.times = (Eigen::VectorXd(3) << 0.0, 0.5, 1.0).finished();
  fmu.units = {{"p", "m"}, {"p_out", "m"}};
  return fmu;
}

class Feedthrough : public ::testing::TestWithParam<Way> {};

TEST_P(Feedthrough, PassesParametersOfEveryTypeOn) {
  FmuCase fmu = makeFeedthrough(GetParam().fmu, GetParam().kind);
  fmu.parameters = {{"p", 0.25}, {"i", 7.0}, {"kind", 2.0}, {"flag", 1.0}};
  fmu.outputs = {"p_out", "i_out", "kind_out", "flag_out"};
  const FmuResult result = simulate(fmu, 2);
  ASSERT_TRUE(result.status.ok) << result.status.reason;
  EXPECT_EQ(result.outputs.row(2), (Eigen::RowVectorXd(4) << 0.25, 7.0, 2.0, 1.0).finished());
}

TEST_P(Feedthrough, FollowsItsInputsAtTheOutputTimes) {
  FmuCase fmu = makeFeedthrough(GetParam().fmu, GetParam().kind);
  SignalSpec sine;
  sine.name.text = "u";
  sine.sines.push_back({{"1.5", {}}, {"1", {}}, {"0.3", {}}, {"0", {}}});
  fmu.excitation = {sine, makePulse("du", "", 3.0, 0.5, 0.9)};
  fmu.outputs = {"y", "dy"};
  const FmuResult result = simulate(fmu);
  ASSERT_TRUE(result.status.ok) << result.status.reason;
  const auto at = [](double t) { return 1.5 * std::sin(2.0 * M_PI * t + 0.3); };
  for (Eigen::Index i = 0; i < 3; ++i) {
    EXPECT_NEAR(result.outputs(i, 0), at(fmu.times[i]), 1e-12);
  }
  EXPECT_EQ(result.outputs.col(1), Eigen::Vector3d(0.0, 3.0, 0.0));
}

INSTANTIATE_TEST_SUITE_P(Ways, Feedthrough,
                         ::testing::Values(Way{"feedthrough_2", Kind::kCoSimulation},
                                           Way{"feedthrough_3", Kind::kCoSimulation},
                                           Way{"feedthrough_2", Kind::kModelExchange},
                                           Way{"feedthrough_3", Kind::kModelExchange}));

TEST(Values, ElementsOfArraysFloatsAndSmallIntegersAreParametersAndOutputs) {
  FmuCase fmu = makeFeedthrough("feedthrough_3", Kind::kCoSimulation);
  fmu.parameters = {{"a[2]", 0.5}, {"single", 0.1}, {"small", -3.0}};
  fmu.outputs = {"b[1]", "b[2]", "single_out", "small_out"};
  const FmuResult result = simulate(fmu, 2);
  ASSERT_TRUE(result.status.ok) << result.status.reason;
  EXPECT_EQ(result.outputs.row(0), (Eigen::RowVectorXd(4) << 10.0, 5.0, 0.1F, -3.0).finished());
}

TEST(Values, AnIntegerThatItsTypeCannotHoldFailsTheSample) {
  FmuCase fmu = makeFeedthrough("feedthrough_3", Kind::kCoSimulation);
  fmu.parameters = {{"small", 1000.0}};
  fmu.outputs = {"small_out"};
  const FmuResult result = simulate(fmu);
  EXPECT_FALSE(result.status.ok);
  EXPECT_NE(result.status.reason.find("does not fit"), std::string::npos);
}

std::string explain(const std::string& fmu, const std::string& parameter, const std::string& unit = "") {
  const fmi::Package package(findFmu(fmu));
  return catchMessage([&] { fmi::bindParameters(package.getDescription(), {{parameter, unit, {}}}); });
}

TEST(Values, AWrongNameIsRefusedWithTheNearestOne) {
  EXPECT_NE(explain("two_beam_2", "k_thta").find("did you mean 'k_theta'"), std::string::npos);
}

TEST(Values, WhatTheStandardDoesNotPermitToSetIsRefusedWithTheReason) {
  EXPECT_NE(explain("feedthrough_3", "size").find("structural"), std::string::npos);
  EXPECT_NE(explain("bouncing_ball_2", "twice").find("calculated from"), std::string::npos);
  EXPECT_NE(explain("bouncing_ball_2", "pi").find("constant"), std::string::npos);
  EXPECT_NE(explain("two_beam_2", "y", "m").find("calculates"), std::string::npos);
  EXPECT_NE(explain("feedthrough_2", "text").find("String"), std::string::npos);
  EXPECT_NE(explain("feedthrough_3", "tick").find("Clock"), std::string::npos);
  EXPECT_NE(explain("feedthrough_3", "a").find("a[1..4]"), std::string::npos);
  EXPECT_NE(explain("feedthrough_3", "a[5]").find("a[1..4]"), std::string::npos);
}

TEST(Values, UnitsAreCheckedAndConverted) {
  EXPECT_NE(explain("two_beam_2", "k_y", "N s/m").find("does not fit"), std::string::npos);
  EXPECT_NE(explain("feedthrough_2", "p").find("state the coherent SI unit"),
            std::string::npos);  // it is in mm
  EXPECT_EQ(explain("two_beam_2", "k_y"), "");
  FmuCase fmu = makeFeedthrough("feedthrough_2", Kind::kCoSimulation);
  fmu.outputs = {"p_out"};
  EXPECT_EQ(simulate(fmu).outputs(0, 0), 0.002);  // its start value
}

TEST(Values, AModelReadsItsResources) {
  for (const char* name : {"resource_2", "resource_3"}) {
    FmuCase fmu = makeFeedthrough(name, Kind::kCoSimulation);
    fmu.outputs = {"y"};
    const FmuResult result = simulate(fmu);
    ASSERT_TRUE(result.status.ok) << result.status.reason;
    EXPECT_EQ(result.outputs(0, 0), 97.5);
  }
}

TEST(Values, SourceCodeIsCompiled) {
  for (const char* name : {"source_2", "source_3"}) {
    FmuCase fmu = makeFeedthrough(name, Kind::kCoSimulation);
    fmu.outputs = {"x"};
    const FmuResult result = simulate(fmu);
    ASSERT_TRUE(result.status.ok) << result.status.reason;
    EXPECT_NEAR(result.outputs(2, 0), std::exp(-1.0), 1e-8);
  }
}

TEST(Values, AFailureCarriesTheWordsOfTheFmu) {
  for (const Kind kind : {Kind::kCoSimulation, Kind::kModelExchange}) {
    for (const char* name : {"faulty_2", "faulty_3"}) {
      FmuCase fmu = makeFeedthrough(name, kind);
      fmu.parameters = {{"fault", 4.0}};
      fmu.outputs = {"x"};
      const FmuResult result = simulate(fmu, 2);
      EXPECT_NE(result.status.reason.find("the spring is torn (Error)"), std::string::npos)
          << result.status.reason;
      EXPECT_TRUE(std::isnan(result.outputs(0, 0)));
    }
  }
}

TEST(Values, AResponseThatIsNotFiniteIsAFailure) {
  FmuCase fmu = makeFeedthrough("faulty_3", Kind::kCoSimulation);
  fmu.parameters = {{"fault", 3.0}};
  fmu.outputs = {"x"};
  EXPECT_NE(simulate(fmu).status.reason.find("not finite"), std::string::npos);
}

TEST(NativeValues, HoldTheLargestIntegerOf64Bits) {
  EXPECT_EQ(fmi::toNative<std::int64_t>(9223372036854775807.0), std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(fmi::toNative<std::int64_t>(-9223372036854775808.0), std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(fmi::toNative<std::uint64_t>(18446744073709551615.0), std::numeric_limits<std::uint64_t>::max());
  EXPECT_THROW(fmi::toNative<std::int64_t>(9.3e18), fmi::FmuFailure);
  EXPECT_THROW(fmi::toNative<std::int32_t>(2147483648.0), fmi::FmuFailure);
}

}  // namespace
}  // namespace twinmap::testing
