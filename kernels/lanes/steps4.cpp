#include "kernels/lanes/step_loops.hpp"

namespace twinmap::lanes {
namespace {

using One = StepLoops<program::Packet4, 1>;
using Two = StepLoops<program::Packet4, 2>;

}  // namespace

const StepEngine kSteps4{program::kEngine4, One::plan,        One::prepareStage,
                         One::finish,       One::interpolate, One::accept};
const StepEngine kSteps8Of4{program::kEngine8Of4, Two::plan,        Two::prepareStage,
                            Two::finish,          Two::interpolate, Two::accept};

}  // namespace twinmap::lanes
