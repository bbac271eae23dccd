#include "framework/study/pipeline/training/store_map.hpp"

#include <algorithm>

#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "framework/store/trained_file.hpp"

namespace twinmap {
namespace {

/// What Simbody had to simulate, Simbody simulates wherever the map is used: nothing compares it with lanes
/// there.
ExperimentSpec nameEngine(ExperimentSpec experiment, const Simulator& simulator) {
  if (!experiment.model.source && simulator.getEngine() != "lanes") {
    changeTrials(experiment, [](ExperimentSpec& one) { one.model.simulation.engine = Engine::kSimbody; });
  }
  return experiment;
}

/// As a person wrote it: with the samples that are reduced.
ExperimentSpec takeWhole(const Study& study) {
  ExperimentSpec experiment = study.experiment;
  if (study.reduced != nullptr) {
    experiment.features = study.reduced->whole.features;
    experiment.noise = study.reduced->whole.noise;
  }
  return experiment;
}

}  // namespace

CoverageRecord recordCoverage(const MethodSummary& method) {
  CoverageRecord record{method.accepted, Eigen::VectorXd(static_cast<Eigen::Index>(method.metrics.size()))};
  for (std::size_t p = 0; p < method.metrics.size(); ++p) {
    record.share[static_cast<Eigen::Index>(p)] = method.metrics[p].coverage95;
  }
  return record;
}

RefinementReference collectReference(const std::vector<Refined>& refined) {
  RefinementReference reference;
  std::vector<double> unexplained;
  for (const Refined& one : refined) {
    const bool tried = !one.start.empty();
    reference.tried += tried ? 1 : 0;
    if (tried && !one.explained) {
      unexplained.push_back(one.calcReducedChiSquare());
    }
  }
  std::sort(unexplained.begin(), unexplained.end());
  reference.unexplained =
      Eigen::Map<const Eigen::VectorXd>(unexplained.data(), static_cast<Eigen::Index>(unexplained.size()));
  return reference;
}

void storeMap(const std::filesystem::path& file, const Study& study, const Evaluation& evaluation,
              TrainedMap& map) {
  if (map.online.trust) {
    if (evaluation.calibration) {
      map.online.trust->posteriors = {evaluation.calibration->measurements,
                                      evaluation.calibration->ranks.p_value};
    }
  }
  const ExperimentSpec experiment = nameEngine(takeWhole(study), study.simulator);
  TrainedFile stored{
      experiment.model.parameters, experiment.model.inputs, {}, map.online, writeExperiment(experiment)};
  for (const FeatureInfo& info : study.extractor.getInfos()) {
    stored.feature_names.push_back(info.name);
  }
  stored.reduction = study.reduced != nullptr ? study.reduced->reduction : nullptr;
  writeTrainedFile(file, stored);
}

}  // namespace twinmap
