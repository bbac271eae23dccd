#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/data/reduction/response_reduction.hpp"
#include "framework/estimation/trained/online_model.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// What maps.h5 holds: all that is needed to infer from a measurement and to judge that.
struct TrainedFile {
  std::vector<ParameterSpec> parameters;   ///< that are inferred: names, units, bounds
  std::vector<ParameterSpec> inputs;       ///< known, with a measurement
  std::vector<std::string> feature_names;  ///< d
  OnlineModel model;
  std::string experiment;                                ///< resolved.yaml's text
  std::shared_ptr<const ResponseReduction> reduction{};  ///< null where all samples are features
};

/// Writes maps.h5 (docs/reference/files.md), sealed. Equal content gives equal bytes.
void writeTrainedFile(const std::filesystem::path& path, const TrainedFile& stored);

/// Reads it back; it infers bit for bit as the one that was written. Throws std::runtime_error or
/// std::invalid_argument for a file that is damaged, of another version, or of parts that do not fit each
/// other. `seal`: kNone to look at a file that may be damaged.
TrainedFile readTrainedFile(const std::filesystem::path& path, Hdf5Seal seal = Hdf5Seal::kDigest);

}  // namespace twinmap
