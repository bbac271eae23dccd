#pragma once

#include <string>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"
#include "framework/models/external/excitation_table.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

// The lines of JSON that a program gets (docs/how-to/use-a-program.md).

constexpr int kProtocolVersion = 1;

/// The names that values are given under: of the sampled parameters, then of the constants that have a
/// variable; and of the excitation signals and the outputs.
struct ProgramNames {
  std::vector<std::string> values, signals, outputs;
};
ProgramNames collectProgramNames(const ModelSpec& model);

/// The first line: what does not change from sample to sample. `excitation`: where it depends on no
/// parameter.
std::string writeHello(const ProgramNames& names, const ResponseLayout& layout, double duration,
                       const ExcitationTable& excitation);

/// One sample; the excitation where it differs from that of the first line, else null.
std::string writeRequest(const ProgramNames& names, const std::vector<double>& values,
                         const ExcitationTable* excitation);

/// Several samples, each of writeRequest().
std::string writeBatch(const std::vector<std::string>& requests);

}  // namespace twinmap
