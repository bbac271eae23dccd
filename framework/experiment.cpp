#include "framework/experiment.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>

#include "framework/design/point_set.hpp"
#include "framework/features/feature_extractor.hpp"
#include "framework/features/noise.hpp"
#include "framework/inverse_map/gp_map.hpp"
#include "framework/multibody/multibody_simulator.hpp"
#include "framework/report/html_report.hpp"
#include "framework/report/stddev_figure.hpp"
#include "framework/report/tables.hpp"
#include "framework/simulation/sample_generator.hpp"
#include "framework/spec/check_experiment.hpp"
#include "framework/spec/experiment_file.hpp"
#include "framework/store/atomic_file.hpp"
#include "framework/store/maps_file.hpp"
#include "framework/store/provenance.hpp"
#include "framework/store/samples_file.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;

/// Runs a stage, logs it and notes its wall time.
template <class Stage>
auto timeStage(const std::string& name, std::vector<StageTime>& times, const Stage& stage) {
  const auto start = std::chrono::steady_clock::now();
  auto result = stage();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  times.push_back({name, elapsed.count()});
  spdlog::info("{}: {:.2f} s", name, elapsed.count());
  return result;
}

std::vector<FailedSample> collectFailures(const std::string& set, const Trajectories& trajectories) {
  std::vector<FailedSample> failures;
  for (std::size_t i = 0; i < trajectories.statuses.size(); ++i) {
    if (!trajectories.statuses[i].ok) {
      failures.push_back({set, static_cast<int>(i), trajectories.parameters.col(static_cast<Eigen::Index>(i)),
                          trajectories.statuses[i].reason});
    }
  }
  return failures;
}

void requireFewFailures(const std::vector<FailedSample>& failures, const std::string& set, int samples,
                        double allowed_fraction, const fs::path& folder) {
  int failed = 0;
  const FailedSample* first = nullptr;
  for (const FailedSample& failure : failures) {
    if (failure.set == set) {
      first = first == nullptr ? &failure : first;
      ++failed;
    }
  }
  if (failed > allowed_fraction * samples || samples - failed < 2) {
    throw std::runtime_error(fmt::format(
        "{} of {} {} samples could not be simulated, more than simulation.allowed_failures = {} permits; the "
        "first is sample {}: {}; all are listed in {}",
        failed, samples, set, allowed_fraction, first->sample, first->reason,
        (folder / "failures.csv").string()));
  }
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

/// The given samples as the inverse map sees them: `replicates` draws of the noise each, draw by draw.
LabelledFeatures makeFeatures(const Trajectories& trajectories, const std::vector<int>& samples,
                              const FeatureExtractor& extractor, const Eigen::VectorXd& noise_of_output,
                              const RandomStream& noise, int replicates) {
  LabelledFeatures labelled;
  const auto count = static_cast<Eigen::Index>(samples.size());
  labelled.features.resize(static_cast<Eigen::Index>(extractor.getInfos().size()), count * replicates);
  for (int r = 0; r < replicates; ++r) {
    const Eigen::MatrixXd noisy = addNoise(trajectories.responses, noise_of_output, noise, r);
    labelled.features.middleCols(r * count, count) = extractor.extract(noisy)(Eigen::all, samples);
  }
  labelled.parameters =
      Eigen::MatrixXd(trajectories.parameters(Eigen::all, samples)).replicate(1, replicates);
  labelled.replicates = replicates;
  labelled.noise_stddev.resize(labelled.features.rows());
  for (std::size_t f = 0; f < extractor.getInfos().size(); ++f) {
    labelled.noise_stddev[static_cast<Eigen::Index>(f)] = noise_of_output[extractor.getInfos()[f].output];
  }
  return labelled;
}

RunSummary startSummary(const ExperimentSpec& experiment) {
  RunSummary run;
  run.name = experiment.name.text;
  run.description = experiment.description;
  run.parameters = experiment.model.parameters;
  run.train_samples = experiment.design.train.samples;
  run.test_samples = experiment.design.test.samples;
  const std::vector<std::string> names = collectNames(experiment.model.parameters);
  for (const Name& axis : experiment.report.over) {
    run.axes.push_back(static_cast<int>(std::find(names.begin(), names.end(), axis.text) - names.begin()));
  }
  return run;
}

std::string join(const std::vector<std::string>& texts) {
  std::string joined;
  for (const std::string& text : texts) {
    joined += (joined.empty() ? "" : "; ") + text;
  }
  return joined;
}

std::vector<std::string> collectNames(const std::vector<FeatureInfo>& infos) {
  std::vector<std::string> names;
  for (const FeatureInfo& info : infos) {
    names.push_back(info.name);
  }
  return names;
}

std::vector<TrainingStart> summarizeTraining(const std::vector<std::string>& parameters,
                                             const std::vector<gp::TrainingReport>& reports) {
  std::vector<TrainingStart> rows;
  for (std::size_t p = 0; p < reports.size(); ++p) {
    for (std::size_t k = 0; k < reports[p].starts.size(); ++k) {
      const gp::StartReport& start = reports[p].starts[k];
      const bool best = static_cast<int>(k) == reports[p].best_start;
      rows.push_back({parameters[p], static_cast<int>(k), best, start.nlml, start.evaluations,
                      start.noise_only, start.stop_reason, best ? join(reports[p].at_bound) : "",
                      reports[p].condition, reports[p].jitter});
    }
  }
  return rows;
}

void writeResults(const fs::path& folder, const RunSummary& run) {
  writeTextFile(folder / "metrics.csv", makeMetricsCsv(run));
  writeTextFile(folder / "predictions.csv", makePredictionsCsv(run));
  writeTextFile(folder / "training.csv", makeTrainingCsv(run));
  writeTextFile(folder / "table.md", makeMarkdownTable(run));
  writeTextFile(folder / "table.tex", makeLatexTable(run));
  writeTextFile(folder / "report.html", makeHtmlReport(run));
  if (run.axes.empty()) {
    return;
  }
  fs::create_directories(folder / "figures");
  for (std::size_t p = 0; p < run.parameters.size(); ++p) {
    writeTextFile(folder / "figures" / ("stddev_" + run.parameters[p].name.text + ".svg"),
                  makeStddevFigure(run, static_cast<int>(p)));
  }
}

Provenance makeProvenance(const ExperimentSpec& experiment, const RunOptions& options,
                          const RunSummary& run) {
  Provenance provenance{
      options.command, experiment.seed, options.threads, {}, static_cast<int>(run.failures.size())};
  for (const StageTime& time : run.times) {
    provenance.stage_seconds.emplace_back(time.stage, time.seconds);
  }
  return provenance;
}

struct SimulatedSets {
  Trajectories train, test;
};

/// Simulates both sets and writes them with their failures; throws if too many failed.
SimulatedSets simulateSets(const ExperimentSpec& experiment, const RunOptions& options, RunSummary& run) {
  const ModelSpec& model = experiment.model;
  const MultibodySimulator simulator(model, collectTimes(experiment.features));
  GeneratorOptions generator;
  generator.threads = options.threads;
  const auto simulate = [&](const std::string& set, const PointSetSpec& design, RandomPurpose purpose) {
    const Eigen::MatrixXd points = samplePoints(design, model.parameters, experiment.seed, purpose);
    Trajectories trajectories =
        timeStage(fmt::format("simulate {} {} samples", points.cols(), set), run.times,
                  [&] { return generateSamples(simulator, points, generator); });
    const std::vector<FailedSample> failures = collectFailures(set, trajectories);
    run.failures.insert(run.failures.end(), failures.begin(), failures.end());
    return trajectories;
  };
  const SimulatedSets sets{simulate("train", experiment.design.train, RandomPurpose::kTrainDesign),
                           simulate("test", experiment.design.test, RandomPurpose::kTestDesign)};
  writeSamplesFile(options.folder / "samples.h5", model, sets.train, sets.test);
  writeTextFile(options.folder / "failures.csv", makeFailuresCsv(run));
  requireFewFailures(run.failures, "train", run.train_samples, model.simulation.allowed_failures,
                     options.folder);
  requireFewFailures(run.failures, "test", run.test_samples, model.simulation.allowed_failures,
                     options.folder);
  return sets;
}

/// Trains the map on the training samples and writes it.
GpMap trainMap(const ExperimentSpec& experiment, const LabelledFeatures& training,
               const std::vector<FeatureInfo>& infos, const RunOptions& options, RunSummary& run) {
  const std::vector<std::string> parameter_names = collectNames(experiment.model.parameters);
  const GpMapTraining trained = timeStage("train the inverse map", run.times, [&] {
    return trainGpMap(experiment.inverse_map.gp, experiment.transform, infos, parameter_names, training,
                      options.threads);
  });
  run.warnings = trained.warnings;
  run.training = summarizeTraining(parameter_names, trained.reports);
  for (const Process& process : trained.map.processes) {
    run.nlml.push_back(getNlml(process));
  }
  writeMapsFile(options.folder / "maps.h5", {experiment.model.parameters, collectNames(infos), trained.map});
  return trained.map;
}

}  // namespace

RunSummary runExperiment(const ExperimentSpec& experiment, const RunOptions& options) {
  RunSummary run = startSummary(experiment);
  fs::create_directories(options.folder);
  writeTextFile(options.folder / "resolved.yaml", writeExperiment(experiment));

  const SimulatedSets sets = simulateSets(experiment, options, run);

  const FeatureExtractor extractor(experiment.features, sets.train.output_names, sets.train.times);
  const Eigen::VectorXd noise = collectNoiseStddev(experiment.noise, experiment.model.outputs);
  run.test_indices = findSuccessful(sets.test);
  const LabelledFeatures training =
      makeFeatures(sets.train, findSuccessful(sets.train), extractor, noise,
                   {experiment.seed, RandomPurpose::kTrainNoise}, experiment.noise.replicates.value_or(1));
  const LabelledFeatures testing = makeFeatures(sets.test, run.test_indices, extractor, noise,
                                                {experiment.seed, RandomPurpose::kTestNoise}, 1);

  const GpMap map = trainMap(experiment, training, extractor.getInfos(), options, run);

  run.truth = testing.parameters;
  run.predictions =
      timeStage("infer the test samples", run.times, [&] { return map.predict(testing.features); });
  run.metrics = calcMetrics(experiment.model.parameters, run.truth, run.predictions);
  writeResults(options.folder, run);
  writeTextFile(options.folder / "provenance.json",
                makeProvenanceJson(makeProvenance(experiment, options, run)));
  return run;
}

}  // namespace twinmap
