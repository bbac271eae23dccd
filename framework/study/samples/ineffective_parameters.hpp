#pragma once

#include <string>
#include <vector>

#include "framework/experiment/model/parameter_spec.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// The parameters of a simulator's points that change no bit of any response: at three points on the
/// diagonal of their box, each is moved alone by half of its width. Pairs of which one fails say nothing of a
/// parameter. For models from elsewhere, which may ignore what they are given. Cost: 3 (p + 1) simulations.
std::vector<std::string> findIneffective(const Simulator& prototype,
                                         const std::vector<ParameterSpec>& parameters);

/// "the parameters a, b have no effect on any output at three points of the box; are their names in the model
/// right?", or "" for none.
std::string describeIneffective(const std::vector<std::string>& names);

}  // namespace twinmap
