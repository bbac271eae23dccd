#pragma once

#include "framework/simulation/model_numbers.hpp"

namespace twinmap {

/// The former name, until mechanisms use the new one.
using NumberEvaluator = ModelNumbers;

}  // namespace twinmap
