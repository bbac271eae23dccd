#include "framework/study/sweep/probe.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "framework/base/files/temporary_folder.hpp"
#include "framework/experiment/resolve_defaults.hpp"
#include "framework/study/pipeline/run_experiment.hpp"
#include "framework/study/pipeline/training/fit_online.hpp"
#include "framework/study/samples/stencils.hpp"
#include "framework/study/sweep/case_cost.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

constexpr int kTrainSamples = 60, kTestSamples = 20, kFewEvaluations = 5;
constexpr int kMoreTrainSamples = 200;  // of a surrogate, whose time grows with the cube from there on

struct TimedRun {
  RunSummary summary;
  double seconds = 0.0;

  /// Of the stages whose names begin so.
  double getStage(const std::string& begin) const {
    double sum = 0.0;
    for (const StageTime& time : summary.notes.times) {
      sum += time.stage.rfind(begin, 0) == 0 ? time.seconds : 0.0;
    }
    return sum;
  }
  double getTraining() const { return getStage("train "); }
  double countEvaluations() const {
    double count = 0.0;
    for (const TrainingStart& start : summary.training.starts) {
      count += start.evaluations;
    }
    return std::max(count, 1.0);
  }
};

TimedRun timeRun(const ExperimentSpec& experiment, const std::string& name, const fs::path& folder) {
  RunOptions options;
  options.folder = folder / name;
  options.store = folder / "chunks";
  const auto start = std::chrono::steady_clock::now();
  TimedRun run;
  run.summary = runExperiment(experiment, options, RunControl{});
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return run;
}

ExperimentSpec makeSmall(ExperimentSpec experiment) {
  constexpr double kMaxFailures = 0.9;
  experiment = takeTrainingSamples(std::move(experiment), kTrainSamples);
  experiment.design.test.samples = kTestSamples;
  experiment.model.simulation.allowed_failures = kMaxFailures;
  experiment.noise.replicates = 1;
  if (GpMapSpec* gp = experiment.inverse_map.findGp()) {
    gp->approximation = GpApproximation::kExact;
  }
  return experiment;
}

/// The map alone.
ExperimentSpec makeBare(ExperimentSpec experiment) {
  experiment.evaluation.limit = false;
  experiment.refine = RefineMode::kNever;
  experiment.evaluation.posterior.reset();
  experiment.evaluation.calibration = PosteriorCalibrationMethod::kNone;
  experiment.evaluation.baselines.clear();
  experiment.evaluation.maps.clear();
  return experiment;
}

/// Few evaluations of one search.
ExperimentSpec makeShort(ExperimentSpec experiment, int replicates) {
  experiment = makeBare(std::move(experiment));
  GpMapSpec& gp = *experiment.inverse_map.findGp();
  gp.starts = 1;
  gp.max_evaluations = kFewEvaluations;
  experiment.noise.replicates = replicates;
  return experiment;
}

/// How an evaluation grows with the samples: more draws of the noise make more samples of the same
/// simulations. What the searches on the first draw take is known from a run without others.
std::vector<EvaluationTime> measureEvaluations(const ExperimentSpec& small, double most_samples,
                                               const fs::path& folder) {
  const ExperimentSpec brief = makeShort(small, 1);
  const TimedRun one = timeRun(brief, "one", folder);
  const double searches = listTrainingSteps(brief).front().searches;  // of which one is reported
  std::vector<EvaluationTime> times{
      {double(kTrainSamples), one.getTraining() / (searches * one.countEvaluations())}};
  for (const int replicates : {4, 16}) {
    const double samples = double(kTrainSamples) * replicates;
    if (times.back().samples < most_samples) {
      const TimedRun more =
          timeRun(makeShort(small, replicates), "draws" + std::to_string(replicates), folder);
      const double rest = std::max(more.getTraining() - one.getTraining(), 0.5 * more.getTraining());
      times.push_back({samples, rest / more.countEvaluations()});
    }
  }
  return times;
}

double countEvaluationsOnAllDraws(const ExperimentSpec& experiment, ExperimentSpec small,
                                  const fs::path& folder) {
  small.noise.replicates = experiment.noise.replicates;
  return timeRun(makeBare(small), "all", folder).countEvaluations() /
         static_cast<double>(experiment.model.parameters.size());
}

/// Of processes from features to parameters.
TrainingTime measureProcesses(const ExperimentSpec& experiment, const ExperimentSpec& small,
                              const TimedRun& run, double most_samples, const fs::path& folder) {
  TrainingTime time;
  time.measured = measureEvaluations(small, most_samples, folder);
  time.evaluations = 1.0;
  time.evaluations = run.getTraining() / time.calcTraining(small);
  time.evaluations_all = countEvaluationsOnAllDraws(experiment, small, folder);
  return time;
}

/// Of a surrogate: whole trainings.
TrainingTime measureSurrogate(ExperimentSpec small, const TimedRun& run, const fs::path& folder) {
  small = takeTrainingSamples(std::move(small), kMoreTrainSamples);
  const TimedRun more = timeRun(makeBare(small), "more", folder);
  TrainingTime time;
  time.measured = {{double(kTrainSamples), run.getTraining()},
                   {double(kMoreTrainSamples), more.getTraining()}};
  return time;
}

ProbeTimes measure(const ExperimentSpec& experiment, double most_samples) {
  const TemporaryFolder folder;
  const ExperimentSpec small = makeSmall(experiment);
  const TimedRun run = timeRun(small, "small", folder.getPath());
  const bool has_map = !experiment.inverse_map.isNone();
  ProbeTimes times;
  const double simulating = run.getStage("simulate ") + run.getStage("compute parameter sensitivities");
  const double limit = run.getStage("information limit");
  times.simulation = simulating / ((has_map ? kTrainSamples : 0) + kTestSamples);
  const double stencils = run.getStage("finite differences at ");
  times.limit = limit / kTestSamples;
  times.stencil = stencils / std::max<double>(listDerivativePoints(small).cols(), 1.0);
  const double refining = run.getStage("refine ") + (has_map ? 0.0 : run.getStage("exact posterior"));
  times.refinement = refining / kTestSamples;
  const double preparing = run.getStage("calibrate the goodness-of-fit test");
  times.preparation = preparing / (double(kTrainSamples) * countReferences(small));
  times.overhead =
      std::max(run.seconds - simulating - stencils - limit - refining - run.getTraining() - preparing, 0.0);
  if (!has_map) {
    return times;
  }
  times.training = experiment.inverse_map.findGp() != nullptr
                       ? measureProcesses(experiment, small, run, most_samples, folder.getPath())
                       : measureSurrogate(small, run, folder.getPath());
  return times;
}

}  // namespace

double ProbeTimes::calcPreparation(const ExperimentSpec& experiment) const {
  return preparation * double(experiment.design.train.samples) * countReferences(experiment);
}

ProbeTimes measureProbe(const ExperimentSpec& experiment, double most_samples) {
  try {
    return measure(experiment, most_samples);
  } catch (const std::exception& error) {
    ProbeTimes times;
    times.failure = error.what();
    return times;
  }
}

}  // namespace twinmap
