#include "framework/store/trained_file.hpp"

#include <memory>
#include <stdexcept>

#include "framework/base/files/atomic_file.hpp"
#include "framework/estimation/gp/gp_file.hpp"
#include "framework/estimation/network/network_file.hpp"
#include "framework/estimation/surrogate/surrogate_file.hpp"
#include "framework/estimation/trained/trust_file.hpp"
#include "framework/store/parameters_group.hpp"

namespace twinmap {
namespace {

constexpr const char* kFormat = "twinmap maps 4";
constexpr const char* kParameters = "/parameters";
constexpr const char* kInputs = "/inputs";
constexpr const char* kFeatures = "/features/name";
constexpr const char* kExperiment = "/experiment";
constexpr const char* kMap = "/map";
constexpr const char* kTrust = "/trust";

const char* writeMap(Hdf5Writer& file, const GpMap& map) {
  writeGpMap(file, kMap, map);
  return "gp";
}

const char* writeMap(Hdf5Writer& file, const std::shared_ptr<const Surrogate>& map) {
  writeSurrogate(file, kMap, *map);
  return "surrogate";
}

const char* writeMap(Hdf5Writer& file, const std::shared_ptr<const NetworkMap>& map) {
  writeNetworkMap(file, kMap, *map);
  return "network";
}

AnyMap readMap(const Hdf5Reader& file) {
  const std::string kind = file.readAttribute(kMap, "kind");
  if (kind == "gp") {
    return readGpMap(file, kMap);
  }
  if (kind == "surrogate") {
    return std::make_shared<const Surrogate>(readSurrogate(file, kMap));
  }
  if (kind == "network") {
    return std::make_shared<const NetworkMap>(readNetworkMap(file, kMap));
  }
  throw std::runtime_error(file.getPath() + ": unknown kind of map '" + kind + "'");
}

/// The map's own forward part; null where it has none.
std::shared_ptr<const ForwardSurrogate> findForward(const AnyMap& map) {
  const auto* surrogate = std::get_if<std::shared_ptr<const Surrogate>>(&map);
  return surrogate != nullptr ? (*surrogate)->forward : nullptr;
}

}  // namespace

void writeTrainedFile(const std::filesystem::path& path, const TrainedFile& stored) {
  writeAtomically(path, [&](const std::filesystem::path& temporary) {
    Hdf5Writer file(temporary, Hdf5Seal::kDigest);
    file.writeAttribute("/", "format", kFormat);
    writeParametersGroup(file, kParameters, stored.parameters);
    writeParametersGroup(file, kInputs, stored.inputs);
    file.write(kFeatures, stored.feature_names);
    const AnyMap& map = stored.model.map;
    const char* kind = std::visit([&](const auto& one) { return writeMap(file, one); }, map);
    file.writeAttribute(kMap, "kind", kind);
    if (stored.model.trust) {
      writeTrustModel(file, kTrust, *stored.model.trust, findForward(map).get());
    }
    file.write(kExperiment, std::vector<std::string>{stored.experiment});
    file.close();
  });
}

TrainedFile readTrainedFile(const std::filesystem::path& path, Hdf5Seal seal) {
  const Hdf5Reader file(path, seal);
  if (file.readAttribute("/", "format") != kFormat) {
    throw std::runtime_error(path.string() + ": is not a maps.h5 of this version of twinmap");
  }
  TrainedFile stored;
  stored.parameters = readParametersGroup(file, kParameters);
  stored.inputs = readParametersGroup(file, kInputs);
  stored.feature_names = file.readTexts(kFeatures);
  stored.model.map = readMap(file);
  if (file.contains(kTrust)) {
    stored.model.trust = readTrustModel(file, kTrust, findForward(stored.model.map));
  }
  const std::vector<std::string> experiment = file.readTexts(kExperiment);
  if (experiment.size() != 1) {
    throw std::runtime_error(path.string() + ": must hold one experiment");
  }
  stored.experiment = experiment.front();
  return stored;
}

}  // namespace twinmap
