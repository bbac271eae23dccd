#include <gtest/gtest.h>

#include "framework/experiment/column_spec.hpp"
#include "framework/experiment/expression/units.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "tests/framework/experiment/experiments.hpp"

namespace twinmap {
namespace {

TEST(ColumnSpec, HasANameAndPerhapsAUnit) {
  EXPECT_EQ(parseColumn("enc1").name, "enc1");
  EXPECT_FALSE(parseColumn("enc1").unit);
  EXPECT_EQ(parseColumn(" enc 1  [ mm ] ").name, "enc 1");
  EXPECT_EQ(*parseColumn(" enc 1  [ mm ] ").unit, "mm");
  EXPECT_EQ(toText(parseColumn("enc1[mm]")), "enc1 [mm]");
  EXPECT_EQ(*parseColumn("gain []").unit, "");
}

TEST(UnitConversion, ConvertsToSi) {
  EXPECT_DOUBLE_EQ(calcUnitConversion("mm", "m", {}).apply(2.0), 0.002);
  EXPECT_DOUBLE_EQ(calcUnitConversion("deg", "rad", {}).apply(180.0), 3.141592653589793);
  EXPECT_DOUBLE_EQ(calcUnitConversion("kN", "N", {}).apply(-3.0), -3000.0);
  EXPECT_NEAR(calcUnitConversion("degC", "K", {}).apply(20.0), 293.15, 1e-10);
  EXPECT_EQ(calcUnitConversion("odd", "odd", {}).apply(20.0), 20.0);
  EXPECT_DOUBLE_EQ(calcUnitConversion("%", "-", {}).apply(50.0), 0.5);
  EXPECT_THROW(calcUnitConversion("V", "m", {}), ExperimentError);
  EXPECT_THROW(calcUnitConversion("furlongish", "m", {}), ExperimentError);
}

TEST(UnitConversion, KnowsAWholeTurnOfAnglesAlone) {
  EXPECT_DOUBLE_EQ(*findWholeTurn("deg"), 360.0);
  EXPECT_DOUBLE_EQ(*findWholeTurn("rad"), 2.0 * 3.141592653589793);
  for (const char* unit : {"m", "m/s", "m/s2", "m/s^2", "rad/s", "rad/s2", "rad/s^2", "N", "N m", "Nm", "V",
                           "A", "s", "Hz", "mm", "kg"}) {
    EXPECT_FALSE(findWholeTurn(unit)) << unit;
    EXPECT_THROW(calcUnitConversion("rad", unit, {}), ExperimentError) << unit;
  }
}

TEST(MeasurementSpec, IsReadAndWritten) {
  const ExperimentSpec experiment = loadExperiment(
      kTable1, {"measurement={time: 't [ms]', start: 0.25, columns: {y: 'enc1 [mm]', theta: enc2}}"});
  const ExperimentSpec again = readExperiment(parseYaml(writeExperiment(experiment), "resolved.yaml"));
  for (const MeasurementSpec& measurement : {experiment.measurement, again.measurement}) {
    EXPECT_EQ(toText(*measurement.time), "t [ms]");
    EXPECT_EQ(measurement.start.time, 0.25);
    ASSERT_EQ(measurement.columns.size(), 2U);
    EXPECT_EQ(measurement.columns[0].name.text, "y");
    EXPECT_EQ(toText(*measurement.columns[0].column), "enc1 [mm]");
    EXPECT_EQ(toText(*measurement.columns[1].column), "enc2");
  }
  EXPECT_EQ(*loadExperiment(kTable1, {"measurement.sample_rate=610.35"}).measurement.sample_rate, 610.35);
}

TEST(MeasurementSpec, SpeedsAndStationsHaveUnitsOfTheirOwn) {
  EXPECT_NO_THROW(loadExperiment(kTable1, {"outputs.y={speed: theta}", "measurement.columns.y=w [rpm]"}));
  EXPECT_NO_THROW(loadExperiment(kTable1, {"outputs.y={acceleration: {body: beam2, direction: [0, 1, 0]}}",
                                           "measurement.columns.y=a [mm/s2]"}));
}

}  // namespace
}  // namespace twinmap
