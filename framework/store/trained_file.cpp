#include "framework/store/trained_file.hpp"

#include <stdexcept>

#include "framework/base/files/atomic_file.hpp"
#include "framework/estimation/estimator.hpp"
#include "framework/estimation/gp/online_processes.hpp"
#include "framework/estimation/network/online_network.hpp"
#include "framework/estimation/surrogate/online_surrogate.hpp"
#include "framework/estimation/trained/trust_file.hpp"
#include "framework/store/parameters_group.hpp"
#include "framework/store/reduction_group.hpp"

namespace twinmap {
namespace {

struct EstimatorKind {
  const char* name;
  std::shared_ptr<const Estimator> (*load)(const Hdf5Reader& file, const std::string& group);
};

constexpr EstimatorKind kKinds[] = {
    {"gp", loadProcesses}, {"surrogate", loadSurrogate}, {"network", loadNetwork}};

/// Reads a trained estimator of a kind (Estimator::getKind()) from `group` of maps.h5; it infers bit for bit
/// as the one that was saved. Throws std::runtime_error for a kind that nobody knows, and for parts that are
/// missing or do not fit each other.
std::shared_ptr<const Estimator> loadEstimator(const std::string& kind, const Hdf5Reader& file,
                                               const std::string& group) {
  for (const EstimatorKind& known : kKinds) {
    if (kind == known.name) {
      return known.load(file, group);
    }
  }
  throw std::runtime_error(file.getPath() + ": unknown kind of map '" + kind + "'");
}

constexpr const char* kFormat = "twinmap maps 4";
constexpr const char* kParameters = "/parameters";
constexpr const char* kInputs = "/inputs";
constexpr const char* kFeatures = "/features/name";
constexpr const char* kExperiment = "/experiment";
constexpr const char* kMap = "/map";
constexpr const char* kTrust = "/trust";
constexpr const char* kReduction = "/reduction";

}  // namespace

void writeTrainedFile(const std::filesystem::path& path, const TrainedFile& stored) {
  writeAtomically(path, [&](const std::filesystem::path& temporary) {
    Hdf5Writer file(temporary, Hdf5Seal::kDigest);
    file.writeAttribute("/", "format", kFormat);
    writeParametersGroup(file, kParameters, stored.parameters);
    writeParametersGroup(file, kInputs, stored.inputs);
    file.write(kFeatures, stored.feature_names);
    const Estimator& map = *stored.model.map;
    map.save(file, kMap);
    file.writeAttribute(kMap, "kind", map.getKind());
    if (stored.model.trust) {
      writeTrustModel(file, kTrust, *stored.model.trust, map.findForward().get());
    }
    if (stored.reduction) {
      writeReduction(file, kReduction, *stored.reduction);
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
  stored.model.map = loadEstimator(file.readAttribute(kMap, "kind"), file, kMap);
  if (file.contains(kTrust)) {
    stored.model.trust = readTrustModel(file, kTrust, stored.model.map->findForward());
    if (stored.model.trust->unknown < stored.model.map->getResidualCorrelation().rows()) {
      throw std::runtime_error(path.string() + ": " + kTrust + " has fewer parameters than " + kMap);
    }
  }
  if (file.contains(std::string(kReduction) + "/center")) {
    stored.reduction = std::make_shared<const ResponseReduction>(readReduction(file, kReduction));
  }
  const std::vector<std::string> experiment = file.readTexts(kExperiment);
  if (experiment.size() != 1) {
    throw std::runtime_error(path.string() + ": must hold one experiment");
  }
  stored.experiment = experiment.front();
  return stored;
}

}  // namespace twinmap
