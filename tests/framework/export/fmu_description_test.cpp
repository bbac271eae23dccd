#include "framework/export/fmu_description.hpp"

#include <gtest/gtest.h>

namespace twinmap {
namespace {

ExportedModel makeModel() {
  ExportedModel model;
  model.experiment.name.text = "pump";
  model.experiment.model.parameters.resize(1);
  model.experiment.model.parameters[0].name.text = "k";
  model.experiment.model.parameters[0].unit = "N/m";
  model.experiment.model.parameters[0].bounds = {1.0, 3.0, {}};
  model.layout.output_names = {"y<1>"};
  model.layout.output_units = {"m"};
  model.layout.times = Eigen::VectorXd::LinSpaced(3, 0.0, 1.0);
  model.sample_interval = 0.5;
  return model;
}

const FmuIdentity kIdentity{"pump", "{token}", {"pump_map.c", "fmu.c"}};

TEST(FmuDescription, NamesAreEscapedAndOutputsHaveNoStart) {
  const std::string text = makeFmuDescription(makeModel(), kIdentity, 3);
  EXPECT_NE(text.find("name=\"y&lt;1&gt;\" valueReference=\"0\""), std::string::npos);
  EXPECT_NE(text.find("<Float64 name=\"mean.k\" valueReference=\"3\" description=\"inferred parameter\" "
                      "causality=\"output\" variability=\"discrete\" initial=\"calculated\" unit=\"N/m\"/>"),
            std::string::npos)
      << text;
}

TEST(FmuDescription, VersionTwoListsItsSources) {
  const std::string text = makeFmuDescription(makeModel(), kIdentity, 2);
  EXPECT_NE(text.find("guid=\"{token}\""), std::string::npos);
  EXPECT_NE(text.find("<File name=\"fmu.c\"/>"), std::string::npos);
  EXPECT_NE(text.find("<InitialUnknowns>"), std::string::npos);
}

TEST(FmuDescription, TheBuildNamesItsModel) {
  EXPECT_NE(makeBuildDescription(kIdentity).find("modelIdentifier=\"pump\""), std::string::npos);
}

}  // namespace
}  // namespace twinmap
