#include "framework/models/fmu/package/package.hpp"

#include <mutex>

#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/models/fmu/package/archive.hpp"
#include "framework/models/fmu/package/compile_sources.hpp"
#include "framework/models/fmu/package/guarded_folder.hpp"

namespace twinmap::fmi {

namespace fs = std::filesystem;

struct Package::Content {
  std::string file;
  GuardedFolder folder{};
  ArchiveContent archive{};
  ModelDescription description{};
  std::mutex compiling{};
};

std::vector<std::string> listOwnPlatforms() {
#if defined(__aarch64__)
  return {"aarch64-linux", "linux-aarch64"};
#else
  return {"x86_64-linux", "linux64"};
#endif
}

Package::Package(const std::string& file) : content_(new Content{file}) {
  content_->archive = unpackArchive(file, getFolder(), listOwnPlatforms());
  const fs::path xml = getFolder() / "modelDescription.xml";
  if (!fs::is_regular_file(xml)) {
    throw ExperimentError(file + ": is not an FMU: it has no modelDescription.xml");
  }
  content_->description = readModelDescription(xml, file);
  fs::create_directories(getFolder() / "resources");  // named to the FMU whether it has one or not
}

const std::string& Package::getFile() const {
  return content_->file;
}

const ModelDescription& Package::getDescription() const {
  return content_->description;
}

const fs::path& Package::getFolder() const {
  return content_->folder.getPath();
}

Kind Package::chooseKind(std::optional<Kind> asked) const {
  const ModelDescription& description = getDescription();
  const Kind kind = asked.value_or(description.co_simulation ? Kind::kCoSimulation : Kind::kModelExchange);
  const bool has = kind == Kind::kCoSimulation ? description.co_simulation.has_value()
                                               : description.model_exchange.has_value();
  if (!has) {
    throw ExperimentError(getFile() + ": the FMU offers no " + toText(kind) + ", only " +
                          toText(description.co_simulation ? Kind::kCoSimulation : Kind::kModelExchange));
  }
  const Variable* clock = description.findTimedClock();
  if (kind == Kind::kModelExchange && clock != nullptr) {
    throw ExperimentError(getFile() + ": its clock '" + clock->name +
                          "' has to be ticked at times, which is not supported in Model Exchange");
  }
  return kind;
}

fs::path Package::requireLibrary(Kind kind) const {
  const Capabilities& can = getDescription().getCapabilities(kind);
  for (const std::string& platform : listOwnPlatforms()) {
    const fs::path library = getFolder() / "binaries" / platform / (can.model_identifier + ".so");
    if (fs::is_regular_file(library)) {
      return library;
    }
  }
  const std::lock_guard<std::mutex> guard(content_->compiling);
  const fs::path compiled = getFolder() / (can.model_identifier + ".so");
  if (fs::is_regular_file(compiled)) {
    return compiled;
  }
  if (!fs::is_directory(getFolder() / "sources")) {
    const std::vector<std::string>& platforms = content_->archive.platforms;
    throw ExperimentError(getFile() + ": has no library for this platform, binaries/" +
                          listOwnPlatforms().front() + " or " + listOwnPlatforms().back() + "/" +
                          can.model_identifier + ".so" +
                          (platforms.empty() ? ", and no sources" : "; there are: " + listNames(platforms)));
  }
  compileSources({getFile(), getFolder() / "sources", can, getDescription().version}, compiled);
  return compiled;
}

}  // namespace twinmap::fmi
