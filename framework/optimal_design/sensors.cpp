#include "framework/optimal_design/sensors.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/analysis/identifiability.hpp"
#include "framework/base/files/atomic_file.hpp"
#include "framework/base/log/run_control.hpp"
#include "framework/data/features/experiment_features.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/data/noise/feature_noise.hpp"
#include "framework/data/sensitivity/feature_sensitivities.hpp"
#include "framework/data/sensitivity/fisher_information.hpp"
#include "framework/experiment/check/check_noise.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/point_set.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/optimal_design/criterion.hpp"
#include "framework/optimal_design/sensor_files.hpp"
#include "framework/optimal_design/sensor_page.hpp"

namespace twinmap::experiment_design {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The grid of the features, which must be samples on one and the same.
SamplesFeatureSpec findGrid(const ExperimentSpec& experiment) {
  const SamplesFeatureSpec* grid = nullptr;
  for (const FeatureSpec& feature : experiment.features) {
    const auto* samples = std::get_if<SamplesFeatureSpec>(&feature);
    const bool other = samples == nullptr || (grid != nullptr && (samples->start != grid->start ||
                                                                  samples->interval != grid->interval ||
                                                                  samples->count != grid->count));
    if (other) {
      throw ExperimentError(experiment.name.where, "features",
                            "must be samples at the same times for sensors to be chosen");
    }
    grid = samples;
  }
  return *grid;
}

/// The experiment whose features are all that may be measured, output by output.
ExperimentSpec measureAll(ExperimentSpec experiment) {
  SamplesFeatureSpec grid = findGrid(experiment);
  if (const std::optional<int>& times = experiment.design.sensors->candidates.times;
      times && *times > grid.count) {
    throw ExperimentError(experiment.name.where, "design.sensors.candidates.times",
                          fmt::format("must be at most {}, the sample times of the features", grid.count));
  }
  grid.outputs = experiment.design.sensors->candidates.outputs;
  experiment.features = {grid};
  return experiment;
}

CandidateFeatures calcFeatures(const ExperimentSpec& experiment, const RunControl& control) {
  const std::unique_ptr<Simulator> simulator =
      makeSimulator(experiment.model, collectTimes(experiment.features), countModes(experiment.features));
  const FeatureExtractor extractor = makeExtractor(experiment, simulator->getLayout());
  const FeatureNoise noise(extractor, ResponseNoise(experiment.noise, simulator->getLayout()),
                           experiment.seed);
  const int count = experiment.design.sensors->average_over;
  const MatrixXd points =
      samplePoints({DesignMethod::kLatinHypercube, count, {}}, collectSampled(experiment.model),
                   experiment.seed, RandomPurpose::kDesignPoints);
  const std::vector<LocalModel> models =
      calcLocalModels(*simulator, extractor, collectUnknown(experiment.model), points, control.threads);
  CandidateFeatures features;
  for (const LocalModel& model : models) {
    if (!model.status.ok) {
      throw std::runtime_error("a point within the bounds could not be simulated: " + model.status.reason);
    }
    features.sensitivities.push_back(model.sensitivities);
  }
  features.noise_covariance = noise.calcCovariance(models.front().response);
  return features;
}

/// Rows `count` apart or in a row: row of output o at time t is t + o times.
std::vector<Index> listRows(const Subset& outputs, const Subset& times, Index all_times) {
  std::vector<Index> rows;
  for (const Index output : outputs) {
    for (const Index time : times) {
      rows.push_back(output * all_times + time);
    }
  }
  return rows;
}

Subset listAll(Index count) {
  Subset all(static_cast<std::size_t>(count));
  for (Index i = 0; i < count; ++i) {
    all[static_cast<std::size_t>(i)] = i;
  }
  return all;
}

class SensorDesigner {
 public:
  SensorDesigner(const ExperimentSpec& experiment, const RunControl& control)
      : experiment_(experiment),
        control_(control),
        criterion_(makeCriterion(experiment.design.sensors->criterion, experiment.model.parameters)),
        features_(calcFeatures(experiment, control)) {}

  SensorDesign run() {
    const SensorCandidatesSpec& spec = experiment_.design.sensors->candidates;
    SensorDesign design;
    design.parameters = experiment_.model.parameters;
    for (const Name& output : spec.outputs) {
      design.outputs.push_back(output.text);
    }
    design.times = collectTimes(experiment_.features);
    design.by_outputs = chooseOutputs(static_cast<Index>(design.outputs.size()), design.times.size());
    design.chosen_outputs = design.by_outputs[static_cast<std::size_t>(spec.count - 1)];
    design.chosen_times = listAll(design.times.size());
    if (spec.times && *spec.times < design.times.size()) {
      design.by_times = chooseTimes(design.chosen_outputs.subset, design.times.size(), *spec.times);
      design.chosen_times = design.by_times.back().subset;
    }
    design.warnings = warn(design);
    return design;
  }

 private:
  Index countParameters() const { return static_cast<Index>(experiment_.model.parameters.size()); }

  CandidateInformation makeCandidates(std::vector<std::vector<Index>> groups) const {
    return {features_, std::move(groups), countParameters()};
  }

  JudgedSubset judge(const CandidateInformation& candidates, Subset subset) const {
    const VectorXd widths = calcWidths(experiment_.model.parameters);
    JudgedSubset judged{subset, candidates.calcMeanCost(subset, criterion_),
                        MatrixXd(widths.size(), static_cast<Index>(candidates.countPoints()))};
    for (std::size_t point = 0; point < candidates.countPoints(); ++point) {
      judged.stddev.col(static_cast<Index>(point)) =
          calcLimitCovariance(candidates.calcInformation(subset, point))
              .diagonal()
              .cwiseSqrt()
              .cwiseProduct(widths);
    }
    return judged;
  }

  void throwIfStopped() const {
    if (control_.stop != nullptr && *control_.stop) {
      throw Interrupted("interrupted");
    }
  }

  void tell(const std::string& stage, Index done, Index total) const {
    if (control_.progress) {
      Progress progress;
      progress.stage = stage;
      progress.done = static_cast<int>(done);
      progress.total = static_cast<int>(total);
      progress.work = static_cast<double>(done) / static_cast<double>(total);
      control_.progress(progress);
    }
  }

  /// The best of each number of outputs, each begun with the one before.
  std::vector<JudgedSubset> chooseOutputs(Index outputs, Index times) const {
    std::vector<std::vector<Index>> groups;
    for (Index output = 0; output < outputs; ++output) {
      groups.push_back(listRows({output}, listAll(times), times));
    }
    const CandidateInformation candidates = makeCandidates(std::move(groups));
    std::vector<JudgedSubset> best;
    for (Index count = 1; count <= outputs; ++count) {
      const Subset begun = best.empty() ? Subset() : best.back().subset;
      best.push_back(judge(candidates,
                           extendSubset(candidates, criterion_, begun, count, [this] { throwIfStopped(); })));
      tell("outputs", count, outputs);
    }
    return best;
  }

  /// Some sizes on the way to `count` times.
  std::vector<JudgedSubset> chooseTimes(const Subset& outputs, Index times, Index count) const {
    constexpr Index kSizes = 10;
    std::vector<std::vector<Index>> groups;
    for (Index time = 0; time < times; ++time) {
      groups.push_back(listRows(outputs, {time}, times));
    }
    const CandidateInformation candidates = makeCandidates(std::move(groups));
    std::vector<JudgedSubset> best;
    Index size = 0;
    for (Index step = 1; step <= kSizes; ++step) {
      const Index next = std::max<Index>(1, count * step / kSizes);
      if (next > size) {
        size = next;
        const Subset begun = best.empty() ? Subset() : best.back().subset;
        best.push_back(judge(
            candidates, extendSubset(candidates, criterion_, begun, size, [this] { throwIfStopped(); })));
      }
      tell("times", step, kSizes);
    }
    return best;
  }

  std::vector<std::string> warn(const SensorDesign& design) const {
    const CandidateInformation chosen =
        makeCandidates({listRows(design.chosen_outputs.subset, design.chosen_times, design.times.size())});
    InformationLimit limit;
    limit.stddev = judge(chosen, {0}).stddev;
    limit.mean_information.setZero(countParameters(), countParameters());
    limit.mean_covariance = limit.mean_information;
    const auto points = static_cast<double>(chosen.countPoints());
    for (std::size_t point = 0; point < chosen.countPoints(); ++point) {
      const MatrixXd information = chosen.calcInformation({0}, point);
      limit.mean_information += information / points;
      limit.mean_covariance += calcLimitCovariance(information) / points;
    }
    return calcIdentifiability(limit, design.parameters).warnings;
  }

  const ExperimentSpec& experiment_;
  const RunControl& control_;
  Criterion criterion_;
  CandidateFeatures features_;
};

}  // namespace

SensorDesign designSensors(const YamlNode& tree, const std::filesystem::path& folder,
                           const RunControl& control) {
  const ExperimentSpec experiment = readExperimentWithSignals(tree);
  requireStatedNoise(experiment);
  if (!experiment.design.sensors) {
    throw ExperimentError(experiment.name.where, "", "needs the key 'design.sensors' to choose sensors");
  }
  const ExperimentSpec all = measureAll(experiment);
  const SensorDesign design = SensorDesigner(all, control).run();
  makeFolders(folder);
  writeSensorDesign(folder, tree, design);
  writeTextFile(folder / "sensors.html", makeSensorPage(experiment.name.text, design));
  return design;
}

}  // namespace twinmap::experiment_design
