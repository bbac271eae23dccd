#pragma once

#include <string>

#include "framework/export/c_code/c_model_tables.hpp"
#include "framework/export/model/exported_model.hpp"

namespace twinmap {

/// How a map becomes C.
struct COptions {
  CNumber number = CNumber::kDouble;  ///< of signals, and of tables that tolerate it
  std::string prefix = "twinmap";     ///< of names and files
  bool compressed = false;            ///< the processes are those of compressMap()
};

/// A map in C99: PREFIX_map.h and PREFIX_map.c.
struct CSource {
  std::string header, source;
  CSizes sizes;
  std::size_t map_bytes = 0;    ///< of constants: of the map with the features
  std::size_t trust_bytes = 0;  ///< of those that only the judgement needs
};

/// Throws ExperimentError for a prefix that is not a C identifier, and std::runtime_error for a map whose
/// numbers are not finite.
CSource makeCSource(const ExportedModel& model, const COptions& options);

/// A macro each.
std::string writeSizes(const CSizes& sizes, const std::string& prefix);

/// A text of runtime/ with names of this prefix instead of twinmap_ and TWINMAP_.
std::string renameC(std::string text, const std::string& prefix);

}  // namespace twinmap
