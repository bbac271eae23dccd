#include "framework/study/sweep/probe.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "framework/base/files/temporary_folder.hpp"
#include "framework/experiment/files/resolve_defaults.hpp"
#include "framework/study/pipeline/run_experiment.hpp"
#include "framework/study/pipeline/training/fit_online.hpp"
#include "framework/study/samples/stencils.hpp"
#include "framework/study/sweep/case_cost.hpp"
#include "framework/study/sweep/thinned.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

constexpr int kTrainSamples = 60, kTestSamples = 20, kFewEvaluations = 5;
constexpr int kMoreTestSamples = 400, kMostTestSamples = 2000;  // what a block of them shares counts less
constexpr double kCheapSimulation = 2e-3;  // s; those of more test samples do not make a plan long then
constexpr double kMostColumns = 1000.0;    // of a probe: more would take longer than many runs
constexpr int kMoreTrainSamples = 200;     // of a surrogate, whose time grows with the cube from there on

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

/// A run with the experiment's own settings, which all times are taken from but how training grows.
struct ProbedRun {
  ExperimentSpec experiment;
  TimedRun run;
};

/// Of processes from features to parameters: how an evaluation grows, and how many `sample` took.
TrainingTime measureProcesses(const ExperimentSpec& small, const TimedRun& few, const ProbedRun& sample,
                              double most_samples, const fs::path& folder) {
  TrainingTime time;
  time.measured = measureEvaluations(small, most_samples, folder);
  time.evaluations = 1.0;
  time.evaluations = few.getTraining() / time.calcTraining(small);
  time.evaluations_all = countEvaluationsOnAllDraws(sample.experiment, small, folder);
  const double factor = sample.run.getTraining() / time.calcTraining(sample.experiment);
  time.evaluations *= factor;
  time.evaluations_all *= factor;
  return time;
}

/// Of a surrogate: whole trainings.
TrainingTime measureSurrogate(const TimedRun& few, const ProbedRun& sample) {
  TrainingTime time;
  time.measured = {{double(kTrainSamples), few.getTraining()}};
  const double samples = sample.experiment.design.train.samples;
  if (samples > kTrainSamples) {
    time.measured.push_back({samples, sample.run.getTraining()});
  }
  return time;
}

double getSimulation(const TimedRun& run) {
  return run.getStage("simulate ") + run.getStage("compute parameter sensitivities");
}

/// All but what grows with the training samples.
double getRest(const TimedRun& run) {
  return run.seconds - getSimulation(run) - run.getTraining() -
         run.getStage("calibrate the goodness-of-fit test");
}

/// What a test sample takes, where it has been seen for few of them, from the difference that many make.
void measureTestSamples(const ExperimentSpec& experiment, const ExperimentSpec& small, const TimedRun& few,
                        const fs::path& folder, ProbeTimes& times) {
  if (experiment.design.test.samples <= kMoreTestSamples || times.simulation > kCheapSimulation) {
    return;
  }
  const double cheap = kCheapSimulation / times.simulation * kMoreTestSamples;  // take no longer
  const int tests =
      static_cast<int>(std::min({cheap, double(kMostTestSamples), double(experiment.design.test.samples)}));
  const double more = tests - kTestSamples;
  ExperimentSpec bare = makeBare(small);
  bare.design.test.samples = tests;
  const TimedRun many = timeRun(bare, "many", folder / "many");
  times.simulation = std::max(getSimulation(many) - getSimulation(few), 0.0) / more;
  times.overhead += times.evaluation * kTestSamples;
  times.evaluation = std::max(getRest(many) - getRest(few), 0.0) / more;
  times.overhead = std::max(times.overhead - times.evaluation * kTestSamples, 0.0);
}

/// With as many training samples as asked for, up to 200 where they are simulated in a moment. What refines
/// an estimate, and how often a posterior is sampled instead, depends on how good the map is.
ProbedRun runSample(const ExperimentSpec& experiment, const ExperimentSpec& small, const TimedRun& few,
                    const fs::path& folder) {
  constexpr double kMoment = 5.0;  // s
  const double of_one = getSimulation(few) / (kTrainSamples + kTestSamples);
  const int wanted = std::clamp<int>(experiment.design.train.samples, kTrainSamples, kMoreTrainSamples);
  ExperimentSpec sample = of_one * wanted < kMoment ? takeTrainingSamples(small, wanted) : small;
  const int draws = experiment.noise.replicates.value_or(1);
  sample.noise.replicates = wanted * draws <= kMostColumns ? draws : 1;
  TimedRun run = timeRun(sample, "sample", folder);
  return {std::move(sample), std::move(run)};
}

/// All but those of training.
ProbeTimes takeTimes(const ProbedRun& sample, double simulated) {
  const TimedRun& run = sample.run;
  const bool has_map = !sample.experiment.inverse_map.isNone();
  const double simulating = getSimulation(run), limit = run.getStage("information limit");
  const double stencils = run.getStage("finite differences at ");
  const double refining = run.getStage("refine ") + (has_map ? 0.0 : run.getStage("exact posterior"));
  const double preparing = run.getStage("calibrate the goodness-of-fit test");
  const double inferring = run.getStage("infer the test samples");
  ProbeTimes times;
  times.simulation = simulating / simulated;
  times.limit = limit / kTestSamples;
  times.stencil = stencils / std::max<double>(listDerivativePoints(sample.experiment).cols(), 1.0);
  times.refinement = refining / kTestSamples;
  times.preparation =
      preparing / (double(sample.experiment.design.train.samples) * countReferences(sample.experiment));
  times.evaluation = inferring / kTestSamples;
  times.overhead = std::max(
      run.seconds - simulating - stencils - limit - refining - inferring - run.getTraining() - preparing,
      0.0);
  return times;
}

/// From times of thinned samples.
void multiply(const ThinnedExperiment& thinned, ProbeTimes& times) {
  times.simulation *= thinned.simulation;
  times.stencil *= thinned.simulation;
  times.limit *= thinned.simulation;
  times.refinement *= thinned.simulation;
  times.preparation *= thinned.rows;
  times.evaluation *= thinned.rows;
  times.overhead =
      thinned.rows * std::max(times.overhead - thinned.probed_reduction, 0.0) + thinned.reduction;
  for (EvaluationTime& time : times.training.measured) {
    time.seconds *= thinned.windows;
  }
  times.scores = thinned.scores;
}

ProbeTimes measure(const ExperimentSpec& experiment, double most_samples) {
  const TemporaryFolder folder;
  const ExperimentSpec small = makeSmall(experiment);
  if (experiment.inverse_map.isNone()) {
    return takeTimes({small, timeRun(small, "sample", folder.getPath())}, kTestSamples);
  }
  const TimedRun few = timeRun(makeBare(small), "few", folder.getPath() / "few");
  const ProbedRun sample = runSample(experiment, small, few, folder.getPath());
  ProbeTimes times = takeTimes(sample, double(sample.experiment.design.train.samples) + kTestSamples);
  measureTestSamples(experiment, small, few, folder.getPath(), times);
  times.training = experiment.inverse_map.findGp() != nullptr
                       ? measureProcesses(small, few, sample, most_samples, folder.getPath())
                       : measureSurrogate(few, sample);
  return times;
}

}  // namespace

double ProbeTimes::calcPreparation(const ExperimentSpec& experiment) const {
  return preparation * double(experiment.design.train.samples) * countReferences(experiment);
}

ProbeTimes measureProbe(const ExperimentSpec& experiment, double most_samples) {
  try {
    const ThinnedExperiment thinned = thinSamples(experiment);
    ProbeTimes times = measure(thinned.experiment, most_samples);
    multiply(thinned, times);
    return times;
  } catch (const std::exception& error) {
    ProbeTimes times;
    times.failure = error.what();
    return times;
  }
}

}  // namespace twinmap
