#pragma once

#include <string>
#include <vector>

#include "framework/export/model/exported_model.hpp"

namespace twinmap {

/// What names an exported FMU.
struct FmuIdentity {
  std::string identifier;            ///< of the model, a C identifier
  std::string token;                 ///< GUID, or instantiation token
  std::vector<std::string> sources;  ///< C files in sources/
  bool tracks = false;               ///< the parameters over time, too
};

/// modelDescription.xml of FMI 2 or 3. Value references are those of runtime/fmu.h.
std::string makeFmuDescription(const ExportedModel& model, const FmuIdentity& identity, int version);

/// sources/buildDescription.xml of FMI 3.
std::string makeBuildDescription(const FmuIdentity& identity);

}  // namespace twinmap
