#include "framework/store/online_group.hpp"

#include <memory>

#include "framework/store/process_group.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

constexpr const char* kTrust = "/online/trust";

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

void writeForward(Hdf5Writer& file, const std::string& group, const ForwardModel& forward) {
  const gp::InterpolatorParts& parts = forward.score_map.getParts();
  file.writeSamples(group + "/whitener", forward.whitener);
  file.write(group + "/center", forward.center);
  file.writeSamples(group + "/components", forward.components);
  file.writeSamples(group + "/scores", forward.scores);
  file.writeSamples(group + "/points", parts.points);
  file.write(group + "/length_scales", parts.length_scales);
  file.writeSamples(group + "/weights", parts.weights.transpose());
  file.write(group + "/mean", parts.mean);
  file.write(group + "/left_out_variance", parts.left_out_variance);
}

ForwardModel readForward(const Hdf5Reader& file, const std::string& group) {
  gp::InterpolatorParts parts{file.readSamples(group + "/points"), file.readVector(group + "/length_scales"),
                              file.readSamples(group + "/weights").transpose(),
                              file.readVector(group + "/mean"),
                              file.readVector(group + "/left_out_variance")};
  return {file.readSamples(group + "/whitener"), file.readVector(group + "/center"),
          file.readSamples(group + "/components"), file.readSamples(group + "/scores"),
          gp::Interpolator(std::move(parts))};
}

void writeTrust(Hdf5Writer& file, const std::string& group, const TrustModel& trust) {
  writeForward(file, group + "/forward", trust.forward);
  file.write(group + "/runs", flatten(trust.runs));
  file.write(group + "/reference/chi_square", trust.chi_square.sorted);
  file.write(group + "/reference/burst", trust.burst.sorted);
  file.writeSamples(group + "/cloud/inputs", trust.cloud.inputs);
  file.write(group + "/cloud/scale", trust.cloud.scale);
  file.write(group + "/cloud/reach", trust.cloud.reach);
  file.write(group + "/box/center", trust.center);
  file.write(group + "/box/half_width", trust.half_width);
  file.write(group + "/unknown", static_cast<double>(trust.unknown));
  file.write(group + "/level", trust.level);
}

TrustModel readTrust(const Hdf5Reader& file, const std::string& group) {
  return {readForward(file, group + "/forward"),
          unflatten(file.readIntegers(group + "/runs")),
          {file.readVector(group + "/reference/chi_square")},
          {file.readVector(group + "/reference/burst")},
          {file.readSamples(group + "/cloud/inputs"), file.readVector(group + "/cloud/scale"),
           file.readNumber(group + "/cloud/reach")},
          file.readVector(group + "/box/center"),
          file.readVector(group + "/box/half_width"),
          static_cast<Index>(file.readNumber(group + "/unknown")),
          file.readNumber(group + "/level")};
}

}  // namespace

void writeOnlineGroup(Hdf5Writer& file, const std::vector<std::string>& parameters,
                      const OnlineModel& model) {
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    if (isSparse(model.map.processes[p])) {
      writeProcess(file, getMapGroup(parameters[p]), model.map.processes[p]);
    }
  }
  if (model.trust) {
    writeTrust(file, kTrust, *model.trust);
  }
}

void readOnlineGroup(const Hdf5Reader& file, const std::vector<std::string>& parameters, OnlineModel& model) {
  std::shared_ptr<const Eigen::MatrixXd> inputs;
  for (const std::string& parameter : parameters) {
    std::string group = getMapGroup(parameter);
    if (!file.contains(group + "/weights")) {
      group = "/maps/" + parameter;  // not compressed
      if (inputs == nullptr && isExactProcess(file, group)) {
        inputs = std::make_shared<const Eigen::MatrixXd>(file.readSamples("/training_inputs"));
      }
    }
    model.map.processes.push_back(readProcess(file, group, inputs));
  }
  if (file.contains(std::string(kTrust) + "/level")) {
    model.trust = readTrust(file, kTrust);
  }
}

}  // namespace twinmap
