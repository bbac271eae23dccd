#pragma once

#include <string>
#include <vector>

#include "framework/study/pipeline/preparation/prepare_data.hpp"
#include "framework/study/pipeline/trust/power_stencils.hpp"

namespace twinmap {

/// What a trust model finds of one thing that may be wrong.
struct DetectableChange {
  std::string kind;  ///< "constant", or "output" with a constant offset
  std::string name;
  std::string unit;       ///< of the change: "" of a constant, whose change is relative
  double smallest = 0.0;  ///< found in 95 % of the cases; NaN where none up to `largest` is
  double largest = 0.0;   ///< half of the constant, or the range of the output
  double found = 0.0;     ///< the share of cases in which `largest` is found
};

/// With an online model that has a trust model: the smallest relative change of each constant of the model,
/// and the smallest constant offset of each output, that is called a model mismatch in 95 % of the cases, by
/// bisection at the first test samples. The features move in proportion to the change, which is where a small
/// change leads. Where the run's test samples were refined, it is the answer of the simulator that is judged,
/// else that of the surrogate: the parameters take up what they can of noise and change, linearly. Constants
/// that are expressions or zero, and those that change no feature, are left out. Test samples whose
/// derivatives cannot be simulated, too; empty if all are. Deterministic. Cost: that of simulateStencils(),
/// then some 30 ms for each change.
std::vector<DetectableChange> calcTrustPower(const Study& study, const PreparedData& data,
                                             const OnlineModel& online);

/// trust_power.csv (docs/reference/files.md).
std::string makeTrustPowerCsv(const std::vector<DetectableChange>& changes);

/// One warning that names all that is not found even in half of the cases; empty if there is none.
std::vector<std::string> listPowerWarnings(const std::vector<DetectableChange>& changes);

}  // namespace twinmap
