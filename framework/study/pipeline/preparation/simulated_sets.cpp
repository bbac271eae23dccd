#include "framework/study/pipeline/preparation/simulated_sets.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

#include "framework/base/log/log.hpp"
#include "framework/base/log/notice.hpp"
#include "framework/base/log/run_control.hpp"
#include "framework/base/log/stage_timer.hpp"
#include "framework/experiment/points/experiment_points.hpp"
#include "framework/study/samples/simulate_missing.hpp"

namespace twinmap {
namespace {

void appendFailures(const std::string& set, const Trajectories& trajectories,
                    std::vector<FailedSample>& failures) {
  for (std::size_t i = 0; i < trajectories.statuses.size(); ++i) {
    if (!trajectories.statuses[i].ok) {
      failures.push_back({set, static_cast<int>(i), trajectories.parameters.col(static_cast<Eigen::Index>(i)),
                          trajectories.statuses[i].reason});
    }
  }
}

void requireFewFailuresOf(const std::string& set, int samples, const std::vector<FailedSample>& failures,
                          double allowed_fraction, const std::filesystem::path& file) {
  const auto of_set = [&](const FailedSample& failure) { return failure.set == set; };
  const auto failed = static_cast<int>(std::count_if(failures.begin(), failures.end(), of_set));
  if (failed > allowed_fraction * samples || samples - failed < 2) {
    const auto first = std::find_if(failures.begin(), failures.end(), of_set);
    throw std::runtime_error(
        fmt::format("{} of {} {} samples failed, more than simulation.allowed_failures = {} permits; the "
                    "first is sample {}: {}; all are listed in {}",
                    failed, samples, set, allowed_fraction, first->sample, first->reason, file.string()));
  }
}

StoredTrajectories simulateSet(const std::string& set, const Eigen::MatrixXd& points, const Study& study,
                               StageNotes& notes) {
  MissingOptions options = makeMissingOptions("simulate " + set, 1, study.control);
  options.allowed_failures = study.experiment.model.simulation.allowed_failures;
  StoredTrajectories stored = timeStage(
      fmt::format("simulate {} {} samples", points.cols(), set), notes,
      [&] { return simulateMissing(study.source->store, study.source->simulator, points, options); });
  if (stored.stopped) {
    throw Interrupted(fmt::format("interrupted: {} of {} {} samples are simulated and kept",
                                  stored.counts.reused + stored.counts.simulated, points.cols(), set));
  }
  if (const int given_up = stored.counts.given_up; given_up > 0) {
    throw std::runtime_error(describeNotice(Notice::kAllFailed, points.cols() - given_up, set,
                                            stored.trajectories.statuses.front().reason));
  }
  if (stored.counts.implicit > 0) {
    logWarning(describeNotice(Notice::kStiff, stored.counts.implicit, set));
  }
  if (stored.counts.reused > 0) {
    logInfo(fmt::format("{} of the {} samples had been simulated before", stored.counts.reused, set));
  }
  return stored;
}

}  // namespace

SimulatedSets simulateSets(const Study& study) {
  const ResponseLayout& layout = study.simulator.getLayout();
  StageNotes notes;
  StoredTrajectories train;
  if (study.experiment.inverse_map.isNone()) {
    train.trajectories = {sampleTrainPoints(study.experiment), {}, {}, study.source->simulator.getLayout()};
    train.trajectories.responses.resize(train.trajectories.layout.getRowCount(), 0);
  } else {
    train = simulateSet("train", sampleTrainPoints(study.experiment), study, notes);
  }
  StoredTrajectories test = simulateSet("test", sampleTestPoints(study.experiment), study, notes);
  return {selectRows(std::move(train.trajectories), layout), selectRows(std::move(test.trajectories), layout),
          train.counts.reused + test.counts.reused, notes};
}

std::vector<FailedSample> listFailures(const SimulatedSets& sets) {
  std::vector<FailedSample> failures;
  appendFailures("train", sets.train, failures);
  appendFailures("test", sets.test, failures);
  return failures;
}

void requireFewFailures(const ExperimentSpec& experiment, const std::vector<FailedSample>& failures,
                        const std::filesystem::path& file) {
  const double allowed = experiment.model.simulation.allowed_failures;
  if (!experiment.inverse_map.isNone()) {
    requireFewFailuresOf("train", experiment.design.train.samples, failures, allowed, file);
  }
  requireFewFailuresOf("test", experiment.design.test.samples, failures, allowed, file);
}

std::vector<int> findSuccessful(const Trajectories& trajectories) {
  std::vector<int> samples;
  for (std::size_t i = 0; i < trajectories.statuses.size(); ++i) {
    if (trajectories.statuses[i].ok) {
      samples.push_back(static_cast<int>(i));
    }
  }
  return samples;
}

}  // namespace twinmap
