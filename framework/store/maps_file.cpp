#include "framework/store/maps_file.hpp"

#include <memory>
#include <stdexcept>

#include "framework/store/atomic_file.hpp"
#include "framework/store/hdf5_file.hpp"
#include "framework/store/parameters_group.hpp"

namespace twinmap {
namespace {

constexpr const char* kFormat = "twinmap maps 1";

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

void writeProcess(Hdf5Writer& file, const std::string& group, const gp::GaussianProcessParts& parts) {
  const gp::Hyperparameters& hyperparameters = parts.hyperparameters;
  file.write(group + "/length_scales", hyperparameters.length_scales);
  file.write(group + "/length_scale_groups", toIntegers(parts.structure.length_scale_groups));
  file.write(group + "/signal_stddev", hyperparameters.signal_stddev);
  file.write(group + "/noise_stddev", hyperparameters.noise_stddev);
  file.write(group + "/shape", hyperparameters.shape);
  file.write(group + "/linear_stddev", hyperparameters.linear_stddev);
  file.write(group + "/mean_coefficients", parts.mean_coefficients);
  file.write(group + "/alpha", parts.alpha);
  file.writeSamples(group + "/factor", parts.factor.transpose());
  file.write(group + "/nlml", parts.nlml);
  file.write(group + "/jitter", parts.jitter);
  file.writeAttribute(group, "covariance", gp::to_string(parts.structure.covariance));
  file.writeAttribute(group, "mean", toText(parts.structure.mean));
  file.writeAttribute(group, "linear_term", parts.structure.linear_term ? "true" : "false");
}

gp::ModelStructure readStructure(const Hdf5Reader& file, const std::string& group) {
  gp::ModelStructure structure;
  structure.covariance = parseEnum<gp::CovarianceFunction>(
      file.readAttribute(group, "covariance"),
      {gp::CovarianceFunction::kSquaredExponential, gp::CovarianceFunction::kMatern32,
       gp::CovarianceFunction::kMatern52, gp::CovarianceFunction::kRationalQuadratic},
      gp::to_string);
  structure.mean = parseEnum<gp::MeanFunction>(
      file.readAttribute(group, "mean"),
      {gp::MeanFunction::kZero, gp::MeanFunction::kConstant, gp::MeanFunction::kLinear}, toText);
  structure.linear_term = file.readAttribute(group, "linear_term") == "true";
  const std::vector<std::int64_t> groups = file.readIntegers(group + "/length_scale_groups");
  structure.length_scale_groups.assign(groups.begin(), groups.end());
  return structure;
}

std::shared_ptr<const gp::GaussianProcess> readProcess(const Hdf5Reader& file, const std::string& group,
                                                       std::shared_ptr<const Eigen::MatrixXd> inputs) {
  gp::GaussianProcessParts parts;
  parts.structure = readStructure(file, group);
  parts.hyperparameters.length_scales = file.readVector(group + "/length_scales");
  parts.hyperparameters.signal_stddev = file.readNumber(group + "/signal_stddev");
  parts.hyperparameters.noise_stddev = file.readNumber(group + "/noise_stddev");
  parts.hyperparameters.shape = file.readNumber(group + "/shape");
  parts.hyperparameters.linear_stddev = file.readNumber(group + "/linear_stddev");
  parts.inputs = std::move(inputs);
  parts.mean_coefficients = file.readVector(group + "/mean_coefficients");
  parts.alpha = file.readVector(group + "/alpha");
  parts.factor = file.readSamples(group + "/factor").transpose();
  parts.nlml = file.readNumber(group + "/nlml");
  parts.jitter = file.readNumber(group + "/jitter");
  return std::make_shared<const gp::GaussianProcess>(std::move(parts));
}

}  // namespace

void writeMapsFile(const std::filesystem::path& path, const StoredMap& stored) {
  writeAtomically(path, [&](const std::filesystem::path& temporary) {
    Hdf5Writer file(temporary);
    file.writeAttribute("/", "format", kFormat);
    writeParametersGroup(file, stored.parameters);
    file.write("/features/name", stored.feature_names);
    file.write("/transform/offset", stored.map.transform.offset);
    file.write("/transform/scale", stored.map.transform.scale);
    file.write("/target/offset", stored.map.target_offset);
    file.write("/target/scale", stored.map.target_scale);
    file.writeSamples("/training_inputs", stored.map.processes.front()->inputs());
    for (std::size_t p = 0; p < stored.parameters.size(); ++p) {
      writeProcess(file, "/maps/" + stored.parameters[p].name.text, stored.map.processes[p]->parts());
    }
    file.close();
  });
}

StoredMap readMapsFile(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  if (file.readAttribute("/", "format") != kFormat) {
    throw std::runtime_error(path.string() + ": is not a maps.h5 of this version of twinmap");
  }
  StoredMap stored;
  stored.parameters = readParametersGroup(file);
  stored.feature_names = file.readTexts("/features/name");
  stored.map.transform = {file.readVector("/transform/offset"), file.readVector("/transform/scale")};
  stored.map.target_offset = file.readVector("/target/offset");
  stored.map.target_scale = file.readVector("/target/scale");
  const auto inputs = std::make_shared<const Eigen::MatrixXd>(file.readSamples("/training_inputs"));
  for (const ParameterSpec& parameter : stored.parameters) {
    stored.map.processes.push_back(readProcess(file, "/maps/" + parameter.name.text, inputs));
  }
  return stored;
}

}  // namespace twinmap
