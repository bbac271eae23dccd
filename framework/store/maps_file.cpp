#include "framework/store/maps_file.hpp"

#include <memory>
#include <stdexcept>

#include "framework/hdf5/hdf5_file.hpp"
#include "framework/store/atomic_file.hpp"
#include "framework/store/parameters_group.hpp"

namespace twinmap {
namespace {

constexpr const char* kFormat = "twinmap maps 1";
constexpr const char* kParameters = "/parameters";
constexpr const char* kInputs = "/inputs";
constexpr const char* kExact = "exact";
constexpr const char* kSgpr = "sgpr";

const char* toText(gp::MeanFunction mean) {
  switch (mean) {
    case gp::MeanFunction::kZero:
      return "zero";
    case gp::MeanFunction::kConstant:
      return "constant";
    case gp::MeanFunction::kLinear:
      break;
  }
  return "linear";
}

template <class Enum>
Enum parseEnum(const std::string& text, std::initializer_list<Enum> values, const char* (*name)(Enum)) {
  for (const Enum value : values) {
    if (text == name(value)) {
      return value;
    }
  }
  throw std::runtime_error("maps.h5: unknown '" + text + "'");
}

std::vector<std::int64_t> toIntegers(const std::vector<int>& values) {
  return {values.begin(), values.end()};
}

void writeStructure(Hdf5Writer& file, const std::string& group, const gp::ModelStructure& structure,
                    const gp::Hyperparameters& hyperparameters) {
  file.write(group + "/length_scales", hyperparameters.length_scales);
  file.write(group + "/length_scale_groups", toIntegers(structure.length_scale_groups));
  file.write(group + "/signal_stddev", hyperparameters.signal_stddev);
  file.write(group + "/noise_stddev", hyperparameters.noise_stddev);
  file.write(group + "/shape", hyperparameters.shape);
  file.write(group + "/linear_stddev", hyperparameters.linear_stddev);
  file.writeAttribute(group, "covariance", gp::toString(structure.covariance));
  file.writeAttribute(group, "mean", toText(structure.mean));
  file.writeAttribute(group, "linear_term", structure.linear_term ? "true" : "false");
}

void writeProcess(Hdf5Writer& file, const std::string& group, const gp::GaussianProcess& process) {
  const gp::GaussianProcessParts& parts = process.getParts();
  writeStructure(file, group, parts.structure, parts.hyperparameters);
  file.write(group + "/mean_coefficients", parts.mean_coefficients);
  file.write(group + "/alpha", parts.alpha);
  file.writeSamples(group + "/factor", parts.factor.transpose());
  file.write(group + "/nlml", parts.nlml);
  file.write(group + "/jitter", parts.jitter);
  file.writeAttribute(group, "approximation", kExact);
}

void writeProcess(Hdf5Writer& file, const std::string& group, const gp::SparseGaussianProcess& process) {
  const gp::SparseGaussianProcessParts& parts = process.getParts();
  const gp::VariationalPosterior& posterior = parts.posterior;
  writeStructure(file, group, parts.structure, parts.hyperparameters);
  file.write(group + "/center", parts.center);
  file.writeSamples(group + "/inducing", parts.inducing);
  file.writeSamples(group + "/inducing_factor", posterior.inducing_factor.transpose());
  file.writeSamples(group + "/correction_factor", posterior.correction_factor.transpose());
  file.write(group + "/weights", posterior.weights);
  file.writeSamples(group + "/whitened_basis", posterior.whitened_basis.transpose());
  file.writeSamples(group + "/basis_factor", posterior.basis_factor.transpose());
  file.write(group + "/mean_coefficients", posterior.mean_coefficients);
  file.write(group + "/bound", posterior.bound);
  file.write(group + "/jitter", posterior.jitter);
  file.writeAttribute(group, "approximation", kSgpr);
}

gp::ModelStructure readStructure(const Hdf5Reader& file, const std::string& group) {
  gp::ModelStructure structure;
  structure.covariance = parseEnum<gp::CovarianceFunction>(
      file.readAttribute(group, "covariance"),
      {gp::CovarianceFunction::kSquaredExponential, gp::CovarianceFunction::kMatern32,
       gp::CovarianceFunction::kMatern52, gp::CovarianceFunction::kRationalQuadratic},
      gp::toString);
  structure.mean = parseEnum<gp::MeanFunction>(
      file.readAttribute(group, "mean"),
      {gp::MeanFunction::kZero, gp::MeanFunction::kConstant, gp::MeanFunction::kLinear}, toText);
  structure.linear_term = file.readAttribute(group, "linear_term") == "true";
  const std::vector<std::int64_t> groups = file.readIntegers(group + "/length_scale_groups");
  structure.length_scale_groups.assign(groups.begin(), groups.end());
  return structure;
}

gp::Hyperparameters readHyperparameters(const Hdf5Reader& file, const std::string& group) {
  gp::Hyperparameters hyperparameters;
  hyperparameters.length_scales = file.readVector(group + "/length_scales");
  hyperparameters.signal_stddev = file.readNumber(group + "/signal_stddev");
  hyperparameters.noise_stddev = file.readNumber(group + "/noise_stddev");
  hyperparameters.shape = file.readNumber(group + "/shape");
  hyperparameters.linear_stddev = file.readNumber(group + "/linear_stddev");
  return hyperparameters;
}

Process readExact(const Hdf5Reader& file, const std::string& group,
                  std::shared_ptr<const Eigen::MatrixXd> inputs) {
  gp::GaussianProcessParts parts;
  parts.structure = readStructure(file, group);
  parts.hyperparameters = readHyperparameters(file, group);
  parts.inputs = std::move(inputs);
  parts.mean_coefficients = file.readVector(group + "/mean_coefficients");
  parts.alpha = file.readVector(group + "/alpha");
  parts.factor = file.readSamples(group + "/factor").transpose();
  parts.nlml = file.readNumber(group + "/nlml");
  parts.jitter = file.readNumber(group + "/jitter");
  return std::make_shared<const gp::GaussianProcess>(std::move(parts));
}

Process readSparse(const Hdf5Reader& file, const std::string& group) {
  gp::SparseGaussianProcessParts parts;
  parts.structure = readStructure(file, group);
  parts.hyperparameters = readHyperparameters(file, group);
  parts.center = file.readVector(group + "/center");
  parts.inducing = file.readSamples(group + "/inducing");
  gp::VariationalPosterior& posterior = parts.posterior;
  posterior.inducing_factor = file.readSamples(group + "/inducing_factor").transpose();
  posterior.correction_factor = file.readSamples(group + "/correction_factor").transpose();
  posterior.weights = file.readVector(group + "/weights");
  posterior.whitened_basis = file.readSamples(group + "/whitened_basis").transpose();
  posterior.basis_factor = file.readSamples(group + "/basis_factor").transpose();
  posterior.mean_coefficients = file.readVector(group + "/mean_coefficients");
  posterior.bound = file.readNumber(group + "/bound");
  posterior.jitter = file.readNumber(group + "/jitter");
  return std::make_shared<const gp::SparseGaussianProcess>(std::move(parts));
}

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

/// An exact process, which has the training inputs that all exact ones share; null if all are sparse.
const gp::GaussianProcess* findExact(const GpMap& map) {
  for (const Process& process : map.processes) {
    if (const auto* exact = std::get_if<std::shared_ptr<const gp::GaussianProcess>>(&process)) {
      return exact->get();
    }
  }
  return nullptr;
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
      std::visit([&](const auto& process) { writeProcess(file, group, *process); }, stored.map.processes[p]);
    }
    file.close();
  });
}

StoredMap readMapsFile(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  requireFormat(file, path);
  StoredMap stored;
  stored.parameters = readParametersGroup(file, kParameters);
  if (file.contains(std::string(kInputs) + "/name")) {
    stored.inputs = readParametersGroup(file, kInputs);
  }
  stored.map.known_inputs = makeKnownInputs(stored.inputs);
  stored.feature_names = file.readTexts("/features/name");
  stored.map.transform = readTransform(file);
  stored.map.target_offset = file.readVector("/target/offset");
  stored.map.target_scale = file.readVector("/target/scale");
  stored.map.residual_correlation = file.readSamples("/residual_correlation");
  stored.map.noise = {file.readSamples("/noise/directions"), file.readVector("/noise/mean_of_slope")};
  std::shared_ptr<const Eigen::MatrixXd> inputs;
  for (const ParameterSpec& parameter : stored.parameters) {
    const std::string group = "/maps/" + parameter.name.text;
    const bool sparse = file.readAttribute(group, "approximation") == kSgpr;
    if (!sparse && inputs == nullptr) {
      inputs = std::make_shared<const Eigen::MatrixXd>(file.readSamples("/training_inputs"));
    }
    stored.map.processes.push_back(sparse ? readSparse(file, group) : readExact(file, group, inputs));
  }
  return stored;
}

MapSummary readMapSummary(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  requireFormat(file, path);
  MapSummary summary{file.readTexts("/features/name"), readTransform(file), {}, {}};
  for (const ParameterSpec& parameter : readParametersGroup(file, kParameters)) {
    const std::string group = "/maps/" + parameter.name.text;
    summary.structures.push_back(readStructure(file, group));
    summary.hyperparameters.push_back(readHyperparameters(file, group));
  }
  return summary;
}

}  // namespace twinmap
