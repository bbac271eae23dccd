#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "framework/models/fmu/package/model_description.hpp"

namespace twinmap::fmi {

/// An FMU, unpacked into a temporary folder that is removed with the last copy of this value, and in any case
/// when this process ends.
class Package {
 public:
  /// Throws ExperimentError for a file that is not an FMU (unpackArchive(), readModelDescription()).
  explicit Package(const std::string& file);

  const std::string& getFile() const;
  const ModelDescription& getDescription() const;
  const std::filesystem::path& getFolder() const;

  /// The kind that is asked for, or the one that the FMU has; of both Co-Simulation, which brings its own
  /// solver. Throws ExperimentError if it does not have the kind.
  Kind chooseKind(std::optional<Kind> asked) const;

  /// The library of the kind for this platform; compiled from the FMU's sources at the first call if the FMU
  /// has none. Throws ExperimentError where there is neither, with the platforms that there are, or no
  /// compiler.
  std::filesystem::path requireLibrary(Kind kind) const;

 private:
  struct Content;
  std::shared_ptr<Content> content_;
};

/// Folders of binaries/ that hold libraries for this machine: that of FMI 3.0, then that of 2.0.
std::vector<std::string> listOwnPlatforms();

}  // namespace twinmap::fmi
