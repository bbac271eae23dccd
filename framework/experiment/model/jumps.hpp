#pragma once

#include <string>
#include <vector>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/model/system_spec.hpp"

namespace twinmap {

template <class S>
struct ForceLaw;

/// Why an expression of a force makes an integrator take very small steps, and what to write instead:
/// "sign(x_dot) jumps: write tanh(x_dot / eps), eps a small value of x_dot"; "" where it has neither sign(),
/// abs() nor floor() or rint(). The first of several.
std::string describeJump(const Expression& force);

/// The same of a force law. A jump with the speed of its own coordinate is dry friction, which the element
/// `friction` simulates exactly.
std::string describeJump(const ForceLaw<Expression>& law);

/// "system.force_laws[0].force: sign(x_dot) jumps: ..." of each such force of a system.
std::vector<std::string> listJumps(const SystemSpec& system);

}  // namespace twinmap
