#include "framework/data/measurement/measured_frequency_response.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace twinmap {
namespace {

const ResponseLayout kTwoOutputs{{"x", "z"}, {"m", "m"}, Eigen::VectorXd::LinSpaced(4, 0.0, 3.0), 0};

/// Re and Im of x/F at 5 and 7 Hz, those of z/F at 5 Hz, as features' linear forms have them.
std::vector<FeatureInfo> makeLines() {
  std::vector<FeatureInfo> infos;
  const auto add = [&](const std::string& name, int output, double frequency) {
    for (const char* part : {"Re ", "Im "}) {
      infos.push_back({part + name + " at " + std::to_string(int(frequency)) + " Hz", "m/N", output, 0.0, "F",
                       frequency});
    }
  };
  add("x/F", 0, 5.0);
  add("x/F", 0, 7.0);
  add("z/F", 1, 5.0);
  return infos;
}

std::vector<FeatureInfo> makeLinesOfX() {
  const std::vector<FeatureInfo> all = makeLines();
  return {all.begin(), all.begin() + 4};
}

Table readLineTable(const std::string& text) {
  std::istringstream stream(text);
  return readCsv(stream, "frf.csv", {}, MissingCells::kKeep);
}

std::string getLinesError(const std::string& text) {
  try {
    readFrequencyResponse(readLineTable(text), {}, kTwoOutputs, makeLines());
  } catch (const MeasurementError& error) {
    return error.what();
  }
  return "no error";
}

TEST(MeasuredFrequencyResponse, HasPartsInUnitsOfItsOwn) {
  const MeasuredLines lines = readFrequencyResponse(
      readLineTable("frequency [kHz],x_real [mm/N],x_imaginary,x_sd,z_magnitude,z_phase [deg]\n"
                    "0.007,3,4,.5,9,9\n0.005,1,2,,2,90\n0.006,,,,,\n"),
      {}, kTwoOutputs, makeLines());
  EXPECT_NEAR(lines.features[0], 1e-3, 1e-18);
  EXPECT_EQ(lines.features[1], 2.0);
  EXPECT_NEAR(lines.features[2], 3e-3, 1e-18);
  EXPECT_EQ(lines.features[3], 4.0);
  EXPECT_NEAR(lines.features[4], 0.0, 1e-15);
  EXPECT_NEAR(lines.features[5], 2.0, 1e-15);
  EXPECT_TRUE(std::isnan(lines.stddevs[0]) && std::isnan(lines.stddevs[4]));
  EXPECT_EQ(lines.stddevs[2], 0.5);
  EXPECT_EQ(lines.stddevs[3], 0.5);
  EXPECT_TRUE(lines.remarks.empty());
}

TEST(MeasuredFrequencyResponse, LeavesOutWhatIsNotThere) {
  const MeasuredLines lines = readFrequencyResponse(
      readLineTable("frequency,x_real,x_imaginary,z_real,z_imaginary\n5,1,,2,3\n6,1,2,3,4\n"), {},
      kTwoOutputs, makeLines());
  EXPECT_TRUE(lines.features.head(4).array().isNaN().all());
  EXPECT_EQ(lines.features[5], 3.0);
  EXPECT_EQ(lines.remarks, std::vector<std::string>{"2 of 2 lines of x/F"});
}

TEST(MeasuredFrequencyResponse, OfOneResponseNeedsNoNames) {
  const MeasuredLines lines = readFrequencyResponse(
      readLineTable("frequency,real,imaginary,sd\n5,1,2,.1\n7,3,4,.1\n"), {}, kTwoOutputs, makeLinesOfX());
  EXPECT_EQ(lines.features, (Eigen::VectorXd(4) << 1.0, 2.0, 3.0, 4.0).finished());
}

TEST(MeasuredFrequencyResponse, IsKnownByItsFrequencies) {
  EXPECT_TRUE(isFrequencyResponse(readLineTable("frequency,real\n5,1\n"), makeLines()));
  EXPECT_FALSE(isFrequencyResponse(readLineTable("t,x\n5,1\n"), makeLines()));
  EXPECT_FALSE(isFrequencyResponse(readLineTable("frequency,damping_ratio\n5,1\n"),
                                   {{"natural frequency 1", "Hz", -1, 0.0}}));
}

TEST(MeasuredFrequencyResponse, ErrorsNameColumnRowAndRule) {
  EXPECT_EQ(getLinesError("frequency,x_real\n5,1\n"),
            "frf.csv: has no columns 'x_real' and 'x_imaginary', nor 'x_magnitude' and 'x_phase', of the "
            "frequency response x/F");
  EXPECT_EQ(getLinesError("frequency,x_real,x_imaginary\n5,1,1\n5,2,1\n"),
            "frf.csv: column 'frequency' has 5 Hz in rows 1 and 2; each has one row");
  EXPECT_EQ(getLinesError("frequency,x_real,x_imaginary,x_sd\n5,1,1,0\n"),
            "frf.csv: column 'x_sd' has 0 in row 1; must be above 0");
}

}  // namespace
}  // namespace twinmap
