#pragma once

#include <filesystem>
#include <string>

#include "framework/models/fmu/package/model_description.hpp"

namespace twinmap::fmi {

/// The sources of an FMU.
struct SourceTree {
  std::string fmu;  ///< what messages call it
  std::filesystem::path folder;
  const Capabilities& capabilities;
  Version version;
};

/// CC, else cc.
std::string getCompiler();

/// Compiles what buildDescription.xml (FMI 3.0, and 2.0 where it is there) or <SourceFiles> (2.0) lists by
/// the C compiler. Headers of the standard that the FMU leaves out are there. False if the compiler cannot be
/// started. Throws ExperimentError for sources in another language, for names that lead out of the folder,
/// and with the compiler's words if it fails.
bool compileSources(const SourceTree& tree, const std::filesystem::path& library);

}  // namespace twinmap::fmi
