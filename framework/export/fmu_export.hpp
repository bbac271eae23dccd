#pragma once

#include <filesystem>

#include "framework/export/model/exported_model.hpp"
#include "framework/export/model/exported_tracking.hpp"

namespace twinmap {

/// Writes a map as an FMU for Co-Simulation of FMI `version` (2 or 3): inputs are the measured signals, which
/// it keeps; when `trigger` rises, and at `trigger_time`, it infers from the window that ends then. Outputs
/// are parameters, standard deviations, intervals, status and p-value. The sources are those of exported C;
/// the library of this platform is compiled from them where a C compiler is. With `tracking` (null: without)
/// each inference also updates a belief over the parameters, whose outputs are beside. Returns whether the
/// library is there. Throws ExperimentError for a map whose features no signal gives, and for parameters that
/// follow conditions.
bool writeFmu(const ExportedModel& model, const std::filesystem::path& file, int version,
              const ExportedTracking* tracking);

}  // namespace twinmap
