// Compiled for AVX-512 even where the rest is not: nothing here may run before the engine said that it is
// supported.
#include "kernels/lanes/step_loops.hpp"

namespace twinmap::lanes {
namespace {

using One = StepLoops<program::Packet8, 1>;
using Two = StepLoops<program::Packet8, 2>;

}  // namespace

const StepEngine kSteps8{program::kEngine8, One::kWidth,      One::plan,           One::prepareStage,
                         One::finish,       One::interpolate, One::interpolateAll, One::accept};
const StepEngine kSteps16{program::kEngine16, Two::kWidth,      Two::plan,           Two::prepareStage,
                          Two::finish,        Two::interpolate, Two::interpolateAll, Two::accept};

}  // namespace twinmap::lanes
