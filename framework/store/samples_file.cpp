#include "framework/store/samples_file.hpp"

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/store/parameters_group.hpp"

namespace twinmap {
namespace {

void writeSet(Hdf5Writer& file, const std::string& group, const Trajectories& set) {
  const auto samples = static_cast<std::size_t>(set.responses.cols());
  const auto times = static_cast<std::size_t>(set.layout.times.size());
  file.writeSamples(group + "/parameters", set.parameters);
  const Eigen::MatrixXd outputs = set.responses.topRows(set.layout.getFrequencyRow(0));
  file.write(group + "/responses", outputs.data(), {samples, set.layout.output_names.size(), times});
  if (set.layout.modes > 0) {
    const int modes = set.layout.modes;
    file.writeSamples(group + "/natural_frequencies",
                      set.responses.middleRows(set.layout.getFrequencyRow(0), modes));
    file.writeSamples(group + "/damping_ratios",
                      set.responses.middleRows(set.layout.getDampingRow(0), modes));
  }
  std::vector<std::int64_t> ok;
  std::vector<std::string> reasons;
  for (const SampleStatus& status : set.statuses) {
    ok.push_back(status.ok ? 1 : 0);
    reasons.push_back(status.reason);
  }
  file.write(group + "/ok", ok);
  file.write(group + "/reason", reasons);
}

ResponseLayout readLayout(const Hdf5Reader& file, bool modes) {
  ResponseLayout layout{file.readTexts("/outputs/name"), file.readTexts("/outputs/unit"),
                        file.readVector("/times")};
  layout.modes = modes ? static_cast<int>(file.readShape("/train/natural_frequencies").at(1)) : 0;
  return layout;
}

Trajectories readSet(const Hdf5Reader& file, const std::string& group, const ResponseLayout& layout) {
  Trajectories set;
  set.layout = layout;
  set.parameters = file.readSamples(group + "/parameters");
  const Eigen::MatrixXd outputs = file.readSamples(group + "/responses");
  set.responses.resize(layout.getRowCount(), set.parameters.cols());
  set.responses.topRows(outputs.rows()) = outputs;
  if (layout.modes > 0) {
    set.responses.middleRows(layout.getFrequencyRow(0), layout.modes) =
        file.readSamples(group + "/natural_frequencies");
    set.responses.middleRows(layout.getDampingRow(0), layout.modes) =
        file.readSamples(group + "/damping_ratios");
  }
  const std::vector<std::int64_t> ok = file.readIntegers(group + "/ok");
  const std::vector<std::string> reasons = file.readTexts(group + "/reason");
  for (std::size_t i = 0; i < ok.size(); ++i) {
    set.statuses.push_back({ok[i] != 0, reasons.at(i)});
  }
  return set;
}

}  // namespace

void writeSamplesFile(const std::filesystem::path& path, const ModelSpec& model, const Trajectories& train,
                      const Trajectories& test) {
  writeAtomically(path, [&](const std::filesystem::path& temporary) {
    Hdf5Writer file(temporary);
    file.writeAttribute("/", "format", "twinmap samples 1");
    writeParametersGroup(file, "/parameters", collectSampled(model));
    file.write("/outputs/name", train.layout.output_names);
    file.write("/outputs/unit", train.layout.output_units);
    file.write("/times", train.layout.times);
    file.writeAttribute("/times", "unit", "s");
    writeSet(file, "/train", train);
    writeSet(file, "/test", test);
    file.close();
  });
}

int countTrainingSamples(const std::filesystem::path& path) {
  return static_cast<int>(Hdf5Reader(path).readIntegers("/train/ok").size());
}

StoredResponses readTestResponses(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  return {file.readTexts("/outputs/name"), file.readTexts("/outputs/unit"), file.readVector("/times"),
          file.readSamples("/test/responses")};
}

StoredSamples readSamplesFile(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  const ResponseLayout layout = readLayout(file, file.contains("/train/natural_frequencies"));
  return {readSet(file, "/train", layout), readSet(file, "/test", layout)};
}

}  // namespace twinmap
