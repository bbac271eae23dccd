#include "framework/estimation/gp/gp_file.hpp"

#include <initializer_list>
#include <memory>
#include <stdexcept>
#include <variant>

namespace twinmap {
namespace {

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
  throw std::runtime_error("a trained file has an unknown '" + text + "'");
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

void writeParts(Hdf5Writer& file, const std::string& group, const gp::GaussianProcess& process) {
  const gp::GaussianProcessParts& parts = process.getParts();
  writeStructure(file, group, parts.structure, parts.hyperparameters);
  file.write(group + "/mean_coefficients", parts.mean_coefficients);
  file.write(group + "/alpha", parts.alpha);
  file.writeSamples(group + "/factor", parts.factor.transpose());
  file.write(group + "/nlml", parts.nlml);
  file.write(group + "/jitter", parts.jitter);
  file.writeAttribute(group, "approximation", kExact);
}

void writeParts(Hdf5Writer& file, const std::string& group, const gp::SparseGaussianProcess& process) {
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

gp::Process readExact(const Hdf5Reader& file, const std::string& group,
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

gp::Process readSparse(const Hdf5Reader& file, const std::string& group) {
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

gp::Process readProcess(const Hdf5Reader& file, const std::string& group,
                        const std::shared_ptr<const Eigen::MatrixXd>& inputs) {
  return file.readAttribute(group, "approximation") == kExact ? readExact(file, group, inputs)
                                                              : readSparse(file, group);
}

std::string getStepGroup(const std::string& group, std::size_t step) {
  return group + "/transform/" + std::to_string(step);
}

std::string getProcessGroup(const std::string& group, std::size_t parameter) {
  return group + "/processes/" + std::to_string(parameter);
}

void writeTransform(Hdf5Writer& file, const std::string& group, const FeatureTransform& transform) {
  file.write(group + "/transform/steps", static_cast<double>(transform.steps.size()));
  for (std::size_t i = 0; i < transform.steps.size(); ++i) {
    const AffineStep& step = transform.steps[i];
    file.write(getStepGroup(group, i) + "/offset", step.offset);
    file.write(getStepGroup(group, i) + "/scale", step.scale);
    file.writeSamples(getStepGroup(group, i) + "/projection", step.projection.transpose());
  }
}

FeatureTransform readTransform(const Hdf5Reader& file, const std::string& group) {
  FeatureTransform transform;
  const auto steps = static_cast<std::size_t>(file.readCount(group + "/transform/steps"));
  for (std::size_t i = 0; i < steps; ++i) {
    transform.steps.push_back({file.readVector(getStepGroup(group, i) + "/offset"),
                               file.readVector(getStepGroup(group, i) + "/scale"),
                               file.readSamples(getStepGroup(group, i) + "/projection").transpose()});
  }
  return transform;
}

/// Whether each step takes what the one before it gives; `count` becomes what the last one gives.
bool isChain(const FeatureTransform& transform, Eigen::Index& count) {
  bool fits = true;
  for (const AffineStep& step : transform.steps) {
    const Eigen::Index taken = step.offset.size();
    fits = fits && taken > 0 && step.scale.size() == taken && (count < 0 || taken == count) &&
           (step.projection.size() == 0 || step.projection.cols() == taken);
    count = step.projection.size() == 0 ? taken : step.projection.rows();
  }
  return fits && count >= 0;
}

bool fitsTogether(const GpMap& map) {
  const auto p = static_cast<Eigen::Index>(map.processes.size());
  const Eigen::Index known = map.known_inputs.center.size();
  Eigen::Index transformed = -1;
  bool fits = isChain(map.transform, transformed) && p > 0 && map.known_inputs.half_width.size() == known &&
              map.target_offset.size() == p && map.target_scale.size() == p &&
              map.residual_correlation.rows() == p && map.residual_correlation.cols() == p;
  for (const gp::Process& process : map.processes) {
    fits = fits &&
           std::visit([](const auto& one) { return one->getFeatureCount(); }, process) == transformed + known;
  }
  const NoiseProfile& noise = map.noise;
  return fits && (noise.isConstant() ||
                  (noise.directions.rows() <= transformed + known && noise.mean_of_slope.size() == p));
}

/// Training inputs, which exact processes share; null if all are sparse.
std::shared_ptr<const Eigen::MatrixXd> findTrainingInputs(const GpMap& map) {
  for (const gp::Process& process : map.processes) {
    if (const auto* exact = std::get_if<std::shared_ptr<const gp::GaussianProcess>>(&process)) {
      return (*exact)->getParts().inputs;
    }
  }
  return nullptr;
}

}  // namespace

void writeGpMap(Hdf5Writer& file, const std::string& group, const GpMap& map) {
  writeTransform(file, group, map.transform);
  file.write(group + "/known_inputs/center", map.known_inputs.center);
  file.write(group + "/known_inputs/half_width", map.known_inputs.half_width);
  file.write(group + "/target/offset", map.target_offset);
  file.write(group + "/target/scale", map.target_scale);
  file.writeSamples(group + "/residual_correlation", map.residual_correlation);
  file.writeSamples(group + "/noise/directions", map.noise.directions);
  file.write(group + "/noise/mean_of_slope", map.noise.mean_of_slope);
  if (const auto inputs = findTrainingInputs(map)) {
    file.writeSamples(group + "/training_inputs", *inputs);
  }
  file.write(group + "/processes/count", static_cast<double>(map.processes.size()));
  for (std::size_t p = 0; p < map.processes.size(); ++p) {
    std::visit([&](const auto& process) { writeParts(file, getProcessGroup(group, p), *process); },
               map.processes[p]);
  }
}

GpMap readGpMap(const Hdf5Reader& file, const std::string& group) {
  GpMap map;
  map.transform = readTransform(file, group);
  map.known_inputs = {file.readVector(group + "/known_inputs/center"),
                      file.readVector(group + "/known_inputs/half_width")};
  map.target_offset = file.readVector(group + "/target/offset");
  map.target_scale = file.readVector(group + "/target/scale");
  map.residual_correlation = file.readSamples(group + "/residual_correlation");
  map.noise = {file.readSamples(group + "/noise/directions"),
               file.readVector(group + "/noise/mean_of_slope")};
  std::shared_ptr<const Eigen::MatrixXd> inputs;
  if (file.contains(group + "/training_inputs")) {
    inputs = std::make_shared<const Eigen::MatrixXd>(file.readSamples(group + "/training_inputs"));
  }
  const auto count = static_cast<std::size_t>(file.readCount(group + "/processes/count"));
  for (std::size_t p = 0; p < count; ++p) {
    map.processes.push_back(readProcess(file, getProcessGroup(group, p), inputs));
  }
  if (!fitsTogether(map)) {
    throw std::runtime_error(file.getPath() + ": " + group + " has parts that do not fit each other");
  }
  return map;
}

}  // namespace twinmap
