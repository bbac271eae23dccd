#pragma once

#include "framework/experiment/expression/named_values.hpp"
#include "framework/experiment/model/model_spec.hpp"
#include "kernels/lanes/program/recorder.hpp"

namespace twinmap {

/// The parameters of collectSampled() as inputs of a recorder, and the constants that follow from them.
NamedValues<program::Symbol> recordParameters(const ModelSpec& model, program::Recorder& recorder);

}  // namespace twinmap
