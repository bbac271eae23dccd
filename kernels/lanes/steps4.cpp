#include "kernels/lanes/step_loops.hpp"

namespace twinmap::lanes {
namespace {

using One = StepLoops<program::Packet4, 1>;
using Two = StepLoops<program::Packet4, 2>;

}  // namespace

const StepEngine kSteps4{program::kEngine4, One::prepareStage, One::finish, One::accept, One::interpolate};
const StepEngine kSteps8Of4{program::kEngine8Of4, Two::prepareStage, Two::finish, Two::accept,
                            Two::interpolate};

}  // namespace twinmap::lanes
