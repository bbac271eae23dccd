#include "framework/store/estimators/maps_file.hpp"

#include <memory>
#include <stdexcept>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/experiment/check/check_experiment.hpp"
#include "framework/store/estimators/online_group.hpp"
#include "framework/store/estimators/parameters_group.hpp"
#include "framework/store/estimators/process_group.hpp"

namespace twinmap {
namespace {

constexpr const char* kFormat = "twinmap maps 3";
constexpr const char* kParameters = "/parameters";
constexpr const char* kInputs = "/inputs";
constexpr const char* kExperiment = "/online/experiment";

std::string getStepGroup(std::size_t step) {
  return "/transform/" + std::to_string(step);
}

void writeTransform(Hdf5Writer& file, const FeatureTransform& transform) {
  file.write("/transform/steps", static_cast<double>(transform.steps.size()));
  for (std::size_t i = 0; i < transform.steps.size(); ++i) {
    const AffineStep& step = transform.steps[i];
    file.write(getStepGroup(i) + "/offset", step.offset);
    file.write(getStepGroup(i) + "/scale", step.scale);
    file.writeSamples(getStepGroup(i) + "/projection", step.projection.transpose());
  }
}

FeatureTransform readTransform(const Hdf5Reader& file) {
  FeatureTransform transform;
  transform.steps.resize(static_cast<std::size_t>(file.readNumber("/transform/steps")));
  for (std::size_t i = 0; i < transform.steps.size(); ++i) {
    AffineStep& step = transform.steps[i];
    step.offset = file.readVector(getStepGroup(i) + "/offset");
    step.scale = file.readVector(getStepGroup(i) + "/scale");
    step.projection = file.readSamples(getStepGroup(i) + "/projection").transpose();
  }
  return transform;
}

void requireFormat(const Hdf5Reader& file, const std::filesystem::path& path) {
  if (file.readAttribute("/", "format") != kFormat) {
    throw std::runtime_error(path.string() + ": is not a maps.h5 of this version of twinmap");
  }
}

std::vector<ParameterSpec> readInputs(const Hdf5Reader& file) {
  return file.contains(std::string(kInputs) + "/name") ? readParametersGroup(file, kInputs)
                                                       : std::vector<ParameterSpec>{};
}

/// The map without its processes.
GpMap readSharedParts(const Hdf5Reader& file) {
  GpMap map;
  map.known_inputs = makeKnownInputs(readInputs(file));
  map.transform = readTransform(file);
  map.target_offset = file.readVector("/target/offset");
  map.target_scale = file.readVector("/target/scale");
  map.residual_correlation = file.readSamples("/residual_correlation");
  map.noise = {file.readSamples("/noise/directions"), file.readVector("/noise/mean_of_slope")};
  return map;
}

/// An exact process, which has the training inputs that all exact ones share; null if all are sparse.
const gp::GaussianProcess* findExact(const GpMap& map) {
  for (const gp::Process& process : map.processes) {
    if (const auto* exact = std::get_if<std::shared_ptr<const gp::GaussianProcess>>(&process)) {
      return exact->get();
    }
  }
  return nullptr;
}

/// The exact map.
void writeProcesses(Hdf5Writer& file, const StoredMap& stored) {
  writeTransform(file, stored.map.transform);
  file.write("/target/offset", stored.map.target_offset);
  file.write("/target/scale", stored.map.target_scale);
  file.writeSamples("/residual_correlation", stored.map.residual_correlation);
  file.writeSamples("/noise/directions", stored.map.noise.directions);
  file.write("/noise/mean_of_slope", stored.map.noise.mean_of_slope);
  if (const gp::GaussianProcess* exact = findExact(stored.map)) {
    file.writeSamples("/training_inputs", exact->getInputs());
  }
  for (std::size_t p = 0; p < stored.parameters.size(); ++p) {
    const std::string group = "/maps/" + stored.parameters[p].name.text;
    writeProcess(file, group, stored.map.processes[p]);
  }
}

bool holdsProcesses(const Hdf5Reader& file) {
  return !holdsSurrogate(file) && !holdsNetwork(file);
}

/// Why a file holds no processes, where it should.
void requireProcesses(const Hdf5Reader& file, const std::filesystem::path& path) {
  if (!holdsProcesses(file)) {
    throw std::runtime_error(path.string() + ": holds a " + (holdsNetwork(file) ? "network" : "surrogate") +
                             ", not an inverse map's processes");
  }
}

}  // namespace

void writeMapsFile(const std::filesystem::path& path, const StoredMap& stored) {
  writeAtomically(path, [&](const std::filesystem::path& temporary) {
    Hdf5Writer file(temporary);
    file.writeAttribute("/", "format", kFormat);
    writeParametersGroup(file, kParameters, stored.parameters);
    if (!stored.inputs.empty()) {
      writeParametersGroup(file, kInputs, stored.inputs);
    }
    file.write("/features/name", stored.feature_names);
    if (!stored.map.processes.empty()) {
      writeProcesses(file, stored);
    }
    if (!stored.experiment.empty()) {
      writeOnlineGroup(file, collectNames(stored.parameters), stored.online);
      file.write(kExperiment, std::vector<std::string>{stored.experiment});
    }
    file.close();
  });
}

StoredMap readMapsFile(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  requireFormat(file, path);
  requireProcesses(file, path);
  StoredMap stored;
  stored.parameters = readParametersGroup(file, kParameters);
  stored.inputs = readInputs(file);
  stored.feature_names = file.readTexts("/features/name");
  stored.map = readSharedParts(file);
  std::shared_ptr<const Eigen::MatrixXd> inputs;
  for (const ParameterSpec& parameter : stored.parameters) {
    const std::string group = "/maps/" + parameter.name.text;
    if (isExactProcess(file, group) && inputs == nullptr) {
      inputs = std::make_shared<const Eigen::MatrixXd>(file.readSamples("/training_inputs"));
    }
    stored.map.processes.push_back(readProcess(file, group, inputs));
  }
  return stored;
}

bool holdsProcesses(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  requireFormat(file, path);
  return holdsProcesses(file);
}

StoredOnlineModel readOnlineModel(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  requireFormat(file, path);
  if (!file.contains(kExperiment)) {
    throw std::runtime_error(path.string() + ": has no online model; run its experiment again");
  }
  StoredOnlineModel stored;
  stored.model.trust = readTrustModel(file);
  if (holdsSurrogate(file)) {
    stored.model.map = readSurrogate(file, stored.model.trust.value());
  } else if (holdsNetwork(file)) {
    stored.model.map = readNetwork(file);
  } else {
    GpMap map = readSharedParts(file);
    readOnlineProcesses(file, collectNames(readParametersGroup(file, kParameters)), map);
    stored.model.map = std::move(map);
  }
  stored.experiment = file.readTexts(kExperiment).at(0);
  return stored;
}

MapSummary readMapSummary(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  requireFormat(file, path);
  MapSummary summary{file.readTexts("/features/name"), {}, {}, {}};
  if (!holdsProcesses(file)) {
    return summary;
  }
  summary.transform = readTransform(file);
  for (const ParameterSpec& parameter : readParametersGroup(file, kParameters)) {
    const std::string group = "/maps/" + parameter.name.text;
    summary.structures.push_back(readStructure(file, group));
    summary.hyperparameters.push_back(readHyperparameters(file, group));
  }
  return summary;
}

}  // namespace twinmap
