#include "framework/store/estimators/online_group.hpp"

#include <memory>

#include "framework/store/estimators/network_group.hpp"
#include "framework/store/estimators/process_group.hpp"
#include "framework/store/estimators/surrogate_group.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

constexpr const char* kTrust = "/online/trust";
constexpr const char* kSurrogate = "/online/surrogate";
constexpr const char* kNetwork = "/online/network";

std::string getMapGroup(const std::string& parameter) {
  return "/online/maps/" + parameter;
}

bool isSparse(const gp::Process& process) {
  return std::holds_alternative<std::shared_ptr<const gp::SparseGaussianProcess>>(process);
}

std::vector<std::int64_t> flatten(const std::vector<ResidualRun>& runs) {
  std::vector<std::int64_t> flat;
  for (const ResidualRun& run : runs) {
    flat.push_back(run.first);
    flat.push_back(run.count);
  }
  return flat;
}

std::vector<ResidualRun> unflatten(const std::vector<std::int64_t>& flat) {
  std::vector<ResidualRun> runs;
  for (std::size_t i = 0; i + 1 < flat.size(); i += 2) {
    runs.push_back({flat[i], flat[i + 1]});
  }
  return runs;
}

void writeTrust(Hdf5Writer& file, const std::string& group, const TrustModel& trust) {
  writeSurrogateGroup(file, group + "/forward", *trust.forward);
  file.writeSamples(group + "/space/whitener", trust.space.whitener);
  file.writeSamples(group + "/space/directions", trust.space.directions);
  file.writeSamples(group + "/space/unmodelled", trust.space.unmodelled);
  file.write(group + "/space/unmodelled_stddev", trust.space.unmodelled_stddev);
  file.write(group + "/runs", flatten(trust.runs));
  file.write(group + "/reference/chi_square", trust.chi_square.sorted);
  file.write(group + "/reference/anomaly", trust.anomaly.sorted);
  file.write(group + "/reference/noise_anomaly", trust.noise_anomaly.sorted);
  file.write(group + "/reference/refinement/tried", static_cast<double>(trust.refinement.tried));
  file.write(group + "/reference/refinement/unexplained", trust.refinement.unexplained);
  file.writeSamples(group + "/cloud/inputs", trust.cloud.inputs);
  file.write(group + "/cloud/scale", trust.cloud.scale);
  file.write(group + "/cloud/reach", trust.cloud.reach);
  file.write(group + "/box/center", trust.center);
  file.write(group + "/box/half_width", trust.half_width);
  file.write(group + "/unknown", static_cast<double>(trust.unknown));
  file.write(group + "/level", trust.level);
}

TrustModel readTrust(const Hdf5Reader& file, const std::string& group) {
  TrustModel trust;
  trust.forward = std::make_shared<const ForwardSurrogate>(readSurrogateGroup(file, group + "/forward"));
  trust.space = {file.readSamples(group + "/space/whitener"), file.readSamples(group + "/space/directions"),
                 file.readSamples(group + "/space/unmodelled"),
                 file.readVector(group + "/space/unmodelled_stddev")};
  trust.runs = unflatten(file.readIntegers(group + "/runs"));
  trust.chi_square = {file.readVector(group + "/reference/chi_square")};
  trust.anomaly = {file.readVector(group + "/reference/anomaly")};
  trust.noise_anomaly = {file.readVector(group + "/reference/noise_anomaly")};
  trust.refinement = {static_cast<Index>(file.readNumber(group + "/reference/refinement/tried")),
                      file.readVector(group + "/reference/refinement/unexplained")};
  trust.cloud = {file.readSamples(group + "/cloud/inputs"), file.readVector(group + "/cloud/scale"),
                 file.readNumber(group + "/cloud/reach")};
  trust.center = file.readVector(group + "/box/center");
  trust.half_width = file.readVector(group + "/box/half_width");
  trust.unknown = static_cast<Index>(file.readNumber(group + "/unknown"));
  trust.level = file.readNumber(group + "/level");
  return trust;
}

void writeValidation(Hdf5Writer& file, const std::string& group, const SurrogateValidation& validation) {
  file.write(group + "/stddev_scale", validation.stddev_scale);
  file.write(group + "/coverage95", validation.coverage95);
  file.writeSamples(group + "/residual_correlation", validation.residual_correlation);
  file.write(group + "/log_density", validation.log_density);
  file.write(group + "/limit_scale", validation.limit_scale);
  file.write(group + "/limit_ratio", validation.limit_ratio);
  file.write(group + "/status", static_cast<double>(validation.status));
  if (validation.interval_factors.isGiven()) {
    file.write(group + "/interval_factor50", validation.interval_factors.of50.col(0));
    file.write(group + "/interval_factor95", validation.interval_factors.of95.col(0));
  }
}

SurrogateValidation readValidation(const Hdf5Reader& file, const std::string& group) {
  return {file.readVector(group + "/stddev_scale"),
          file.readVector(group + "/coverage95"),
          file.readSamples(group + "/residual_correlation"),
          file.readNumber(group + "/log_density"),
          file.readVector(group + "/limit_scale"),
          file.readVector(group + "/limit_ratio"),
          static_cast<SurrogateStatus>(file.readNumber(group + "/status")),
          file.contains(group + "/interval_factor95")
              ? IntervalFactors{file.readVector(group + "/interval_factor50"),
                                file.readVector(group + "/interval_factor95")}
              : IntervalFactors{}};
}

/// A surrogate's forward part is the trust model's.
void writeMap(Hdf5Writer& file, const std::vector<std::string>&,
              const std::shared_ptr<const Surrogate>& surrogate) {
  writeValidation(file, kSurrogate, surrogate->validation);
}

void writeMap(Hdf5Writer& file, const std::vector<std::string>&,
              const std::shared_ptr<const NetworkMap>& network) {
  writeNetworkGroup(file, kNetwork, *network);
  writeValidation(file, kNetwork, network->validation);
}

void writeMap(Hdf5Writer& file, const std::vector<std::string>& parameters, const GpMap& map) {
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    if (isSparse(map.processes[p])) {
      writeProcess(file, getMapGroup(parameters[p]), map.processes[p]);
    }
  }
}

}  // namespace

void writeOnlineGroup(Hdf5Writer& file, const std::vector<std::string>& parameters,
                      const OnlineModel& model) {
  std::visit([&](const auto& map) { writeMap(file, parameters, map); }, model.map);
  if (model.trust) {
    writeTrust(file, kTrust, *model.trust);
  }
}

void readOnlineProcesses(const Hdf5Reader& file, const std::vector<std::string>& parameters, GpMap& map) {
  std::shared_ptr<const Eigen::MatrixXd> inputs;
  for (const std::string& parameter : parameters) {
    std::string group = getMapGroup(parameter);
    if (!file.contains(group + "/weights")) {
      group = "/maps/" + parameter;  // not compressed
      if (inputs == nullptr && isExactProcess(file, group)) {
        inputs = std::make_shared<const Eigen::MatrixXd>(file.readSamples("/training_inputs"));
      }
    }
    map.processes.push_back(readProcess(file, group, inputs));
  }
}

bool holdsSurrogate(const Hdf5Reader& file) {
  return file.contains(std::string(kSurrogate) + "/stddev_scale");
}

std::optional<TrustModel> readTrustModel(const Hdf5Reader& file) {
  return file.contains(std::string(kTrust) + "/level") ? std::optional(readTrust(file, kTrust))
                                                       : std::nullopt;
}

bool holdsNetwork(const Hdf5Reader& file) {
  return file.contains(std::string(kNetwork) + "/stddev_scale");
}

std::shared_ptr<const Surrogate> readSurrogate(const Hdf5Reader& file, const TrustModel& trust) {
  SurrogateValidation validation = readValidation(file, kSurrogate);
  const Index parameters = validation.stddev_scale.size();
  return std::make_shared<const Surrogate>(Surrogate{trust.forward, trust.center, trust.half_width,
                                                     parameters, trust.unknown, std::move(validation)});
}

std::shared_ptr<const NetworkMap> readNetwork(const Hdf5Reader& file) {
  NetworkMap map = readNetworkGroup(file, kNetwork);
  map.validation = readValidation(file, kNetwork);
  return std::make_shared<const NetworkMap>(std::move(map));
}

}  // namespace twinmap
