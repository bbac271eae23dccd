#pragma once

#include <filesystem>

#include "framework/simulation/sample_generator.hpp"
#include "framework/spec/model_spec.hpp"

namespace twinmap {

/// Writes samples.h5 (docs/file-formats.md): parameters and clean responses of the training and the test set,
/// failed samples included (responses NaN, with their reason). Equal content gives equal bytes.
void writeSamplesFile(const std::filesystem::path& path, const ModelSpec& model, const Trajectories& train,
                      const Trajectories& test);

}  // namespace twinmap
