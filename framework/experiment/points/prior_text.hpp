#pragma once

#include <string>

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// What is known of a model's unknown parameters before a measurement, as one line: "k normal 200 +- 5 N/m, m
/// log-uniform from 1 to 3 kg, correlation of k and m 0.6; the others uniform within their bounds". Empty
/// where all are uniform.
std::string describePriors(const ModelSpec& model);

}  // namespace twinmap
