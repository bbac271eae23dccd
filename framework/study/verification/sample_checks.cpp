#include "framework/study/verification/sample_checks.hpp"

#include <fmt/core.h>

#include <cstring>
#include <memory>

#include "framework/base/files/temporary_folder.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/experiment_points.hpp"
#include "framework/results/run_state.hpp"
#include "framework/store/hdf5_difference.hpp"
#include "framework/store/samples_file.hpp"
#include "framework/study/samples/model_store.hpp"
#include "framework/study/samples/stencils.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

using Eigen::Index;

/// "y(0.05 s)", "natural frequency 1".
std::string describeRow(const ResponseLayout& layout, Index row) {
  if (row < layout.getFrequencyRow(0)) {
    const Index times = layout.times.size();
    return layout.output_names[static_cast<std::size_t>(row / times)] + "(" +
           toShortText(layout.times[row % times], 6) + " s)";
  }
  const bool damping = row >= layout.getDampingRow(0);
  return (damping ? "damping ratio " : "natural frequency ") +
         std::to_string(row - (damping ? layout.getDampingRow(0) : layout.getFrequencyRow(0)) + 1);
}

std::string describeStatus(const SampleStatus& status) {
  return status.ok ? "ok" : "failed (" + status.reason + ")";
}

/// How a sample of the file differs from what it should be; empty if it does not.
std::string findSampleDifference(const Trajectories& stored, Index column,
                                 const Eigen::VectorXd& expected_response, const SampleStatus& expected) {
  const SampleStatus& status = stored.statuses[static_cast<std::size_t>(column)];
  if (status.ok != expected.ok || status.reason != expected.reason) {
    return describeStatus(status) + " instead of " + describeStatus(expected);
  }
  for (Index row = 0; row < expected_response.size(); ++row) {
    const double value = stored.responses(row, column);
    if (std::memcmp(&value, &expected_response[row], sizeof value) != 0) {
      return describeRow(stored.layout, row) + ": " + toText(value) + " instead of " +
             toText(expected_response[row]);
    }
  }
  return "";
}

/// Takes `expected` (columns as `columns` of the set) for the set's samples; returns the first difference.
std::string replaceSamples(const std::string& set_name, const std::vector<int>& columns,
                           const Eigen::MatrixXd& responses, const std::vector<SampleStatus>& statuses,
                           Trajectories& set) {
  std::string first;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto from = static_cast<Index>(i);
    const Index to = columns[i];
    const std::string difference = findSampleDifference(set, to, responses.col(from), statuses[i]);
    if (first.empty() && !difference.empty()) {
      first = fmt::format("{} sample {}, {}", set_name, to, difference);
    }
    set.responses.col(to) = responses.col(from);
    set.statuses[static_cast<std::size_t>(to)] = statuses[i];
  }
  return first;
}

void requireShape(const Trajectories& set, const Eigen::MatrixXd& points, const ResponseLayout& layout,
                  const std::string& name) {
  if (set.parameters.rows() != points.rows() || set.parameters.cols() != points.cols() ||
      set.responses.rows() != layout.getRowCount() ||
      set.statuses.size() != static_cast<std::size_t>(points.cols())) {
    throw UnreadableSamples("the " + name + " set has another shape than resolved.yaml says");
  }
}

StoredSamples readOrThrow(const fs::path& file) {
  try {
    return readSamplesFile(file);
  } catch (const std::exception& error) {
    throw UnreadableSamples(error.what());
  }
}

/// The file's samples, with points, names and times as they should be.
SimulatedSets readSamples(const fs::path& file, const ExperimentSpec& experiment,
                          const ResponseLayout& layout) {
  StoredSamples stored = readOrThrow(file);
  const auto prepare = [&](Trajectories& set, const Eigen::MatrixXd& points, const std::string& name) {
    requireShape(set, points, layout, name);
    set.parameters = points;
    set.layout = layout;
  };
  prepare(stored.train, sampleTrainPoints(experiment), "training");
  prepare(stored.test, sampleTestPoints(experiment), "test");
  return {std::move(stored.train), std::move(stored.test)};
}

/// Failures by the wall-time limit depend on the machine and are not compared.
std::string simulateAgain(const std::string& name, const std::vector<int>& chosen, const Simulator& simulator,
                          int threads, Trajectories& set, Verification& verification) {
  GeneratorOptions options;
  options.threads = threads;
  const Trajectories again = generateSamples(simulator, set.parameters(Eigen::all, chosen), options);
  std::vector<int> compared, columns;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const SampleStatus& stored = set.statuses[static_cast<std::size_t>(chosen[i])];
    if (again.statuses[i].machine_dependent || stored.reason.find("wall-time limit") != std::string::npos) {
      verification.notes.push_back(
          fmt::format("{} sample {} reached simulation.max_wall_time and is not compared", name, chosen[i]));
    } else {
      compared.push_back(static_cast<int>(i));
      columns.push_back(chosen[i]);
    }
  }
  std::vector<SampleStatus> statuses;
  for (const int i : compared) {
    statuses.push_back(again.statuses[static_cast<std::size_t>(i)]);
  }
  return replaceSamples(name, columns, again.responses(Eigen::all, compared), statuses, set);
}

std::string compareChunks(const std::string& name, const TrajectoryStore& store, Trajectories& set,
                          int& found) {
  const SampleBlock block = store.load(set.parameters);
  std::vector<int> columns;
  std::vector<SampleStatus> statuses;
  for (int i = 0; i < block.getSampleCount(); ++i) {
    if (store.contains(set.parameters.col(i))) {
      columns.push_back(i);
      statuses.push_back(block.statuses[static_cast<std::size_t>(i)]);
    }
  }
  found += static_cast<int>(columns.size());
  return replaceSamples(name, columns, block.responses(Eigen::all, columns), statuses, set);
}

std::string describeDamage(TrajectoryStore& store) {
  store.verifyAll();
  const std::vector<SetAsideChunk>& damaged = store.getSetAside();
  return damaged.empty() ? "" : damaged[0].file.filename().string() + ": " + damaged[0].reason;
}

/// Opens the store and checks its chunks' checksums, and those of stencils; null if that fails.
std::unique_ptr<TrajectoryStore> openChunks(const ExperimentSpec& experiment, const Simulator& simulator,
                                            Verification& verification) {
  const ResponseLayout& layout = simulator.getLayout();
  std::unique_ptr<TrajectoryStore> store;
  verification.check("chunks: checksums", [&] {
    store = std::make_unique<TrajectoryStore>(
        findStore(verification.folder), writeStoreContent(experiment.model, layout),
        countSampled(experiment.model), layout.getRowCount(), StoreAccess::kReadOnly);
    const std::string damage = describeDamage(*store);
    if (!damage.empty() || simulator.hasDerivatives()) {
      return damage;
    }
    return describeDamage(
        *openStencilStore(experiment.model, layout, findStore(verification.folder), StoreAccess::kReadOnly));
  });
  return store;
}

void checkChunks(const ExperimentSpec& experiment, const Simulator& simulator, SimulatedSets& sets,
                 Verification& verification) {
  const auto store = openChunks(experiment, simulator, verification);
  if (store == nullptr) {
    return;
  }
  int found = 0;
  const std::string train = compareChunks("training", *store, sets.train, found);
  const std::string test = compareChunks("test", *store, sets.test, found);
  if (found == 0) {
    verification.notes.emplace_back("there are no chunks of this model and build to compare with");
    return;
  }
  verification.check(fmt::format("samples.h5: responses of the {} samples that chunks hold", found),
                     [&] { return train.empty() ? test : train; });
}

}  // namespace

SimulatedSets checkSamples(const ExperimentSpec& experiment, const Simulator& simulator,
                           const ChosenSamples& chosen, int threads, Verification& verification) {
  const fs::path file = verification.folder / "samples.h5";
  SimulatedSets sets = readSamples(file, experiment, simulator.getLayout());
  verification.check("samples.h5: parameters, names and times of all samples", [&] {
    const TemporaryFolder temporary;
    writeSamplesFile(temporary.getPath() / "samples.h5", experiment.model, sets.train, sets.test);
    return findHdf5Difference(file, temporary.getPath() / "samples.h5");
  });
  verification.check(fmt::format("samples.h5: {} training and {} test samples, simulated again",
                                 chosen.train.size(), chosen.test.size()),
                     [&] {
                       const std::string train = simulateAgain("training", chosen.train, simulator, threads,
                                                               sets.train, verification);
                       const std::string test =
                           simulateAgain("test", chosen.test, simulator, threads, sets.test, verification);
                       return train.empty() ? test : train;
                     });
  checkChunks(experiment, simulator, sets, verification);
  return sets;
}

}  // namespace twinmap
