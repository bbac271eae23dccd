#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// A scale of a term's own, such as the speed at which friction sets in.
struct OwnScale {
  std::string meaning, unit;
  double value = 0.0;
};

/// A term that a model may lack: a coefficient, 0 where it is absent, and what it multiplies.
struct TermCandidate {
  std::string term;     ///< "drag.x": names it; the same of all own scales
  std::string meaning;  ///< "drag: force -c |x_dot| x_dot on x"
  std::string unit;     ///< of the coefficient, coherent SI
  double size = 1.0;    ///< of a coefficient that matters: the standard deviation of its prior
  /// Whether it takes energy where its coefficient is positive, as friction does.
  bool dissipates = false;
  std::optional<OwnScale> own_scale;
  /// Adds it to a model that has the parameter `coefficient`. own_scale: a number, or a parameter.
  std::function<void(ModelSpec& model, const std::string& coefficient, const std::string& own_scale)> add;
};

}  // namespace twinmap
