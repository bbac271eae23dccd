#include "framework/export/fmu_export.hpp"

#include <fmt/core.h>

#include <cctype>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/files/temporary_folder.hpp"
#include "framework/estimation/box_prior.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "framework/export/c_code/c_source.hpp"
#include "framework/export/c_code/runtime_sources.hpp"
#include "framework/export/fmu_description.hpp"
#include "framework/export/tracking/track_source.hpp"
#include "framework/models/fmu/package/compile_sources.hpp"
#include "framework/models/fmu/package/package.hpp"
#include "framework/models/fmu/package/standard_headers.hpp"
#include "framework/models/fmu/package/write_archive.hpp"

namespace twinmap {
namespace {

using Eigen::VectorXd;
using fmi::ArchiveFile;

std::string makeIdentifier(const std::string& name) {
  std::string identifier = std::isdigit(static_cast<unsigned char>(name.front())) != 0 ? "map_" : "";
  for (const char c : name) {
    identifier += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  }
  return identifier;
}

/// The same for equal sources (FNV-1a): another map is another FMU.
std::string makeToken(const std::string& text) {
  constexpr std::uint64_t kPrime = 1099511628211u, kBasis = 14695981039346656037u;
  std::uint64_t forward = kBasis, backward = kBasis;
  for (std::size_t i = 0; i < text.size(); ++i) {
    forward = (forward ^ static_cast<unsigned char>(text[i])) * kPrime;
    backward = (backward ^ static_cast<unsigned char>(text[text.size() - 1 - i])) * kPrime;
  }
  return fmt::format("{{{:08x}-{:04x}-{:04x}-{:04x}-{:012x}}}", forward >> 32, (forward >> 16) & 0xffff,
                     forward & 0xffff, backward >> 48, backward & 0xffffffffffffu);
}

std::string listNumbers(const VectorXd& values, const char* none = "0.0") {
  std::string text;
  for (const double value : values) {
    text += (text.empty() ? "" : ", ") + toC(value);
  }
  return text.empty() ? none : text;
}

/// fmu.c with what it starts from.
std::string makeBlock(const ExportedModel& model) {
  const VectorXd center = model.getBoxCenter();
  const PriorMoments prior = calcPriorMoments(model.experiment.model);
  const Eigen::Index p = model.countParameters(), q = model.countKnown();
  VectorXd starts = VectorXd::Zero(model.layout.getOutputCount() + q);
  starts.tail(q) = center.tail(q);
  std::string text(getRuntimeSource("fmu.c"));
  text = fillSlot(std::move(text), "@WINDOW_END@", toC(model.layout.times[model.layout.times.size() - 1]));
  text = fillSlot(std::move(text), "@INPUT_STARTS@", listNumbers(starts));
  text = fillSlot(std::move(text), "@MEAN_STARTS@", listNumbers(prior.mean.head(p)));
  return fillSlot(std::move(text), "@SD_STARTS@", listNumbers(prior.stddev.head(p)));
}

std::vector<ArchiveFile> makeSources(const ExportedModel& model, int version,
                                     const ExportedTracking* tracking, FmuIdentity& identity) {
  const std::string& prefix = identity.identifier;
  const CSource source = makeCSource(model, {CNumber::kDouble, prefix});
  const std::string interface = fmt::format("fmi{}.c", version);
  std::string all = source.source;
  std::vector<ArchiveFile> files{{prefix + "_map.h", source.header}, {prefix + "_map.c", source.source}};
  identity.sources = {prefix + "_map.c", "fmu.c", interface};
  if (tracking != nullptr) {
    const CTrackSource tracker = makeTrackSource(model, *tracking, prefix);
    identity.sources.push_back(prefix + "_track.c");
    files.push_back({prefix + "_track.h", tracker.header});
    files.push_back({prefix + "_track.c", tracker.source});
    all += tracker.source;
  }
  identity.tracks = tracking != nullptr;
  identity.token = makeToken(all);
  const std::string header =
      fillSlot(std::string(getRuntimeSource("fmu.h")), "@TRACKS@", identity.tracks ? "1" : "0");
  files.push_back({"fmu.h", renameC(header, prefix)});
  files.push_back({"fmu.c", renameC(makeBlock(model), prefix)});
  files.push_back({interface, fillSlot(std::string(getRuntimeSource(interface)), "@TOKEN@", identity.token)});
  return files;
}

void addHeaders(const std::filesystem::path& folder, int version, std::vector<ArchiveFile>& sources) {
  fmi::writeStandardHeaders(folder);
  const std::string types = version == 2 ? "fmi2TypesPlatform.h" : "fmi3PlatformTypes.h";
  for (const std::string& name :
       {fmt::format("fmi{}Functions.h", version), fmt::format("fmi{}FunctionTypes.h", version), types}) {
    sources.push_back({name, readBytes(folder / name)});
  }
}

/// The library of this platform, compiled from folder/sources; nothing without a compiler.
std::vector<ArchiveFile> compile(const std::string& fmu, const std::filesystem::path& folder,
                                 const FmuIdentity& identity, int version) {
  fmi::Capabilities capabilities;
  capabilities.model_identifier = identity.identifier;
  capabilities.source_files = identity.sources;
  const std::filesystem::path library = folder / "library.so";
  if (!fmi::compileSources(
          {fmu, folder / "sources", capabilities, version == 2 ? fmi::Version::k2 : fmi::Version::k3},
          library)) {
    return {};
  }
  const std::string platform = fmi::listOwnPlatforms()[version == 2 ? 1 : 0];
  return {{fmt::format("binaries/{}/{}.so", platform, identity.identifier), readBytes(library)}};
}

}  // namespace

bool writeFmu(const ExportedModel& model, const std::filesystem::path& file, int version,
              const ExportedTracking* tracking) {
  requireOneTrial(model.experiment, "an FMU infers from the signals of one recording");
  if (!model.takesSignals()) {
    throw ExperimentError("export --fmu: the features are modes, which no signal gives");
  }
  if (tracking != nullptr && !tracking->conditions.empty()) {
    throw ExperimentError(
        "export --fmu --track: parameters follow conditions, for which the FMU has no inputs; leave "
        "tracking.follows out, or export C");
  }
  FmuIdentity identity;
  identity.identifier = makeIdentifier(model.experiment.name.text);
  const TemporaryFolder folder;
  std::vector<ArchiveFile> sources = makeSources(model, version, tracking, identity);
  addHeaders(folder.getPath() / "headers", version, sources);
  if (version == 3) {
    sources.push_back({"buildDescription.xml", makeBuildDescription(identity)});
  }
  std::vector<ArchiveFile> files{{"modelDescription.xml", makeFmuDescription(model, identity, version)}};
  std::filesystem::create_directories(folder.getPath() / "sources");
  for (const ArchiveFile& source : sources) {
    writeTextFile(folder.getPath() / "sources" / source.name, source.content);
    files.push_back({"sources/" + source.name, source.content});
  }
  const std::vector<ArchiveFile> compiled = compile(file.string(), folder.getPath(), identity, version);
  files.insert(files.end(), compiled.begin(), compiled.end());
  fmi::writeArchive(file, files);
  return !compiled.empty();
}

}  // namespace twinmap
