#pragma once

#include <string>
#include <vector>

#include "framework/export/c_code/c_tables.hpp"
#include "framework/export/model/exported_model.hpp"

namespace twinmap {

/// Sizes that the preprocessor needs: name (without prefix), value, meaning.
struct CSize {
  std::string name;
  long value = 0;
  std::string meaning;
};
using CSizes = std::vector<CSize>;

// Each fills the tables of one file of runtime/ and appends the sizes that it uses.

/// resample.c
void addGrid(const ExportedModel& model, CTables& tables, CSizes& sizes);
/// features.c
void addFeatures(const ExportedModel& model, CTables& tables, CSizes& sizes);
/// transform.c
void addTransform(const GpMap& map, bool compressed, CTables& tables, CSizes& sizes);
/// processes.c
void addProcesses(const GpMap& map, CTables& tables, CSizes& sizes);
/// compressed.c, of a map by compressMap()
void addCompressedProcesses(const GpMap& map, CTables& tables, CSizes& sizes);
/// scores.c
void addScores(const ExportedModel& model, CTables& tables, CSizes& sizes);
/// surrogate.c
void addWindows(const ExportedModel& model, CTables& tables, CSizes& sizes);
/// surrogate_map.c
void addSurrogateMap(const Surrogate& surrogate, CTables& tables, CSizes& sizes);
/// network.c
void addNetwork(const NetworkMap& map, CTables& tables, CSizes& sizes);
/// trust.c
void addTrust(const TrustModel& trust, CTables& tables, CSizes& sizes);
/// infer.c
void addResult(const ExportedModel& model, const std::string& prefix, CTables& tables, CSizes& sizes);
/// derived.c, and the statements of its calc_derived()
void addDerived(const ExportedModel& model, const std::string& prefix, CTables& tables);
std::string makeDerivedExpressions(const ExportedModel& model);

}  // namespace twinmap
