#include "framework/models/mechanism/check_numbers.hpp"

#include "framework/models/mechanism/initial_state.hpp"
#include "framework/models/mechanism/simbody/joints.hpp"
#include "framework/models/mechanism/simbody/mass_properties.hpp"
#include "framework/models/mechanism/simbody/outputs.hpp"

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
