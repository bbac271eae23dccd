#include "framework/data/measurement/measured_modes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "framework/data/measurement/recording/available_response.hpp"
#include "framework/data/noise/noise.hpp"

namespace twinmap {
namespace {

const ResponseLayout kThreeModes{{}, {}, {}, 3};

Table readModeTable(const std::string& text) {
  std::istringstream stream(text);
  return readCsv(stream, "modes.csv", listModeColumns(), MissingCells::kKeep);
}

std::string getModesError(const std::string& text) {
  try {
    readModes(readModeTable(text), kThreeModes);
  } catch (const MeasurementError& error) {
    return error.what();
  }
  return "no error";
}

TEST(MeasuredModes, HaveUnitsAndAnOrderOfTheirOwn) {
  const MeasuredModes modes = readModes(
      readModeTable("mode,frequency [kHz],frequency_sd [Hz],damping_ratio [%]\n3,2,4,\n1,1,3,5\n4,9,9,9\n"),
      kThreeModes);
  EXPECT_DOUBLE_EQ(modes.frequencies[0], 1000.0);
  EXPECT_TRUE(std::isnan(modes.frequencies[1]));
  EXPECT_DOUBLE_EQ(modes.frequencies[2], 2000.0);
  EXPECT_DOUBLE_EQ(modes.frequency_stddevs[2], 4.0);
  EXPECT_DOUBLE_EQ(modes.damping_ratios[0], 0.05);
  EXPECT_TRUE(std::isnan(modes.damping_ratios[2]));
  EXPECT_TRUE(modes.damping_ratio_stddevs.array().isNaN().all());
  EXPECT_EQ(modes.remarks,
            (std::vector<std::string>{"1 of 3 frequencies of modes", "2 of 3 damping ratios of modes"}));
}

TEST(MeasuredModes, AreRowsOfAResponseWithTheirNoise) {
  const AvailableResponse available =
      readAvailable(readModeTable("frequency,damping_ratio,damping_ratio_sd\n1,.1,.01\n2,.2,\n3,.3,.03\n"),
                    {}, kThreeModes, 0.0);
  EXPECT_EQ(available.response, (Eigen::VectorXd(6) << 1.0, 2.0, 3.0, 0.1, 0.2, 0.3).finished());
  EXPECT_EQ(available.missing, 0);
  NoiseSpec spec;
  spec.modes = ModesNoiseSpec{0.5, 0.25};
  ResponseNoise noise(spec, kThreeModes);
  noise.replace(available.stddev);
  EXPECT_EQ(noise.getStddev(), (Eigen::VectorXd(6) << 0.5, 0.5, 0.5, 0.01, 0.25, 0.03).finished());
}

TEST(MeasuredModes, ErrorsNameColumnRowAndRule) {
  EXPECT_EQ(getModesError("t,x\n0,1\n"),
            "modes.csv: has no column 'frequency' or 'damping_ratio'; a table of modes has a row for each");
  EXPECT_EQ(getModesError("mode,frequency\n1,1\n1,2\n"),
            "modes.csv: column 'mode' has 1 in rows 1 and 2; each mode has one row");
  EXPECT_EQ(getModesError("mode,frequency\n0.5,1\n"),
            "modes.csv: column 'mode' has 0.5 in row 1; must be 1, 2, ... from the lowest mode");
  EXPECT_EQ(getModesError("damping_ratio\n2.5\n"),
            "modes.csv: column 'damping_ratio' has 2.5 in row 1; must be from -1 to 1; give percent as "
            "'damping_ratio [%]'");
  EXPECT_EQ(getModesError("frequency,frequency_sd\n1,0\n"),
            "modes.csv: column 'frequency_sd' has 0 in row 1; must be above 0");
}

}  // namespace
}  // namespace twinmap
