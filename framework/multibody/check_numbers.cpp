#include "framework/multibody/check_numbers.hpp"

#include "framework/multibody/initial_state.hpp"
#include "framework/multibody/joints.hpp"
#include "framework/multibody/mass_properties.hpp"
#include "framework/multibody/outputs.hpp"

namespace twinmap {

void checkNumbers(ModelContext& context) {
  NumberEvaluator& numbers = context.numbers.updNumbers();
  for (const BodySpec& body : context.model.system.bodies) {
    calcMassProperties(body, numbers);
    calcJointNumbers(body, numbers);
  }
  calcPassiveForces(context.model.system, context.names, numbers);
  context.loads.update(context.numbers.getScope(), numbers);
  context.excitation.update(numbers);
  const Outputs outputs(context.model.outputs, context.names, numbers);
  calcInitialValues(context);
}

}  // namespace twinmap
