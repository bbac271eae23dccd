#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace twinmap {

/// What a run's provenance.json says (docs/reference/files.md), in its order.
struct ProvenanceRecord {
  /// Key and value of what is neither a list nor below; a key within another is "libraries: Eigen".
  std::vector<std::pair<std::string, std::string>> entries;
  std::vector<std::pair<std::string, double>> seconds;  ///< wall time of each stage
  std::vector<std::string> warnings;

  /// nullptr if there is none.
  const std::string* find(const std::string& key) const;
  /// NaN if there is none, or if it is not a number.
  double getNumber(const std::string& key) const;
};

/// Throws std::runtime_error naming a damaged file; a file that is not there leaves an empty record.
ProvenanceRecord readProvenanceRecord(const std::filesystem::path& path);

}  // namespace twinmap
