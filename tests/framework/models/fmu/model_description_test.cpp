#include <gtest/gtest.h>

#include "framework/models/fmu/instance/value_group.hpp"
#include "framework/models/fmu/package/package.hpp"
#include "framework/models/fmu/package/read_variables.hpp"
#include "tests/framework/models/fmu/fmu_case.hpp"

namespace twinmap::testing {
namespace {

using namespace fmi;

TEST(ModelDescriptionOfFmu, IsReadAlikeInBothVersions) {
  for (const char* name : {"two_beam_2", "two_beam_3"}) {
    const Package package(findFmu(name));
    const ModelDescription& model = package.getDescription();
    ASSERT_EQ(model.state_derivatives.size(), 4U);
    const Variable& derivative = model.variables[model.state_derivatives[1]];
    EXPECT_EQ(derivative.name, "der(theta)");
    EXPECT_EQ(model.variables[derivative.derivative_of].name, "theta");
    const Variable& damper = *findSlot(model, "d_y").variable;
    EXPECT_EQ(damper.causality, Causality::kParameter);
    EXPECT_EQ(damper.initial, Initial::kExact);
    EXPECT_EQ(damper.description, "damper of the slide");
    EXPECT_EQ(model.default_experiment.stop, 5.0);
    EXPECT_TRUE(model.getCapabilities(Kind::kCoSimulation).variable_step);
    EXPECT_EQ(model.units.at("N.m")->exponents[1], 2);
    EXPECT_FALSE(model.units.at("bananas").has_value());
  }
}

TEST(ModelDescriptionOfFmu, ArraysHaveTheSizesThatStructuralParametersGive) {
  const Package package(findFmu("feedthrough_3"));
  const ValueSlot slot = findSlot(package.getDescription(), "a[3]");
  EXPECT_EQ(slot.variable->getSize(), 4U);
  EXPECT_EQ(slot.element, 2U);
}

TEST(ModelDescriptionOfFmu, AliasesAreVariablesToo) {
  const Package package(findFmu("two_beam_3"));
  EXPECT_EQ(findSlot(package.getDescription(), "position").variable->reference, 0U);
}

}  // namespace
}  // namespace twinmap::testing
