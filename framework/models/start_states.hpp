#pragma once

#include <string>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// A number that a simulation starts from.
struct StartState {
  enum class Kind { kCoordinate, kSpeed, kState };

  std::string name;  ///< of the coordinate, or of the state
  Kind kind = Kind::kCoordinate;
  Expression initial{"", {}};  ///< as the file gives it; "": 0
  Expression reach{"", {}};    ///< how large it becomes, where its law says that; "": not known
};

/// The states of a model that are free at a start: coordinates that no signal prescribes, their speeds, the
/// states of first order and those of elements.
std::vector<StartState> listStartStates(const ModelSpec& model);

/// What of a model keeps a memory that no start can set, as "..., which WHAT" goes on: "the sampled
/// controller 'c' has beside; ..."; "" where nothing does.
std::string findUnstartable(const ModelSpec& model);

/// Sets the values of all states at the start to expressions, in the order of listStartStates(), in the place
/// of what the file gives.
void setStartStates(const std::vector<Expression>& values, ModelSpec& model);

}  // namespace twinmap
