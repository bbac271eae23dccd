#include "framework/store/estimators/process_group.hpp"

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

}  // namespace

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

void writeProcess(Hdf5Writer& file, const std::string& group, const gp::Process& process) {
  std::visit([&](const auto& parts) { writeParts(file, group, *parts); }, process);
}

bool isExactProcess(const Hdf5Reader& file, const std::string& group) {
  return file.readAttribute(group, "approximation") == kExact;
}

gp::Process readProcess(const Hdf5Reader& file, const std::string& group,
                        std::shared_ptr<const Eigen::MatrixXd> inputs) {
  return isExactProcess(file, group) ? readExact(file, group, std::move(inputs)) : readSparse(file, group);
}

}  // namespace twinmap
