#pragma once

#include "framework/base/log/run_control.hpp"
#include "framework/data/reduction/response_reduction.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// What keeps of each window of a response what tells about the parameters: the leading directions of its
/// sensitivities at 48 points of the bounds, in standard deviations that a point's samples leave, and of the
/// responses' differences from that at the centre, of unit length or more. They come from a random sketch of
/// 32 columns (Halko et al. 2011), to which simulations are added one after another; as many are kept, up to
/// 24, as leave out 3e-4 of the information and a hundredth of the noise of a response. How much is lost is
/// found at 12 other points. `prototype`: of the experiment's model and times. Throws std::runtime_error
/// where no point can be simulated, Interrupted where `control` stops it. The result does not depend on the
/// number of threads. Cost: 61 simulations with derivatives; memory: 320 bytes a sample, and some 400 MB.
ResponseReduction fitReduction(const Simulator& prototype, const ExperimentSpec& experiment,
                               const RunControl& control);

}  // namespace twinmap
