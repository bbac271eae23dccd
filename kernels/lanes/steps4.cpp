#include "kernels/lanes/step_loops.hpp"

namespace twinmap::lanes {
namespace {

using One = StepLoops<program::Packet4, 1>;
using Two = StepLoops<program::Packet4, 2>;
using Four = StepLoops<program::Packet4, 4>;

}  // namespace

const StepEngine kSteps4{program::kEngine4, One::kWidth,      One::plan,           One::prepareStage,
                         One::finish,       One::interpolate, One::interpolateAll, One::accept};
const StepEngine kSteps8Of4{program::kEngine8Of4, Two::kWidth,      Two::plan,           Two::prepareStage,
                            Two::finish,          Two::interpolate, Two::interpolateAll, Two::accept};
const StepEngine kSteps16Of4{program::kEngine16Of4, Four::kWidth, Four::plan,
                             Four::prepareStage,    Four::finish, Four::interpolate,
                             Four::interpolateAll,  Four::accept};

}  // namespace twinmap::lanes
