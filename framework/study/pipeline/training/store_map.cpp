#include "framework/study/pipeline/training/store_map.hpp"

#include <algorithm>

#include "framework/experiment/experiment_file.hpp"
#include "framework/store/trained_file.hpp"

namespace twinmap {
namespace {

/// What Simbody had to simulate, Simbody simulates wherever the map is used: nothing compares it with lanes
/// there.
ExperimentSpec nameEngine(ExperimentSpec experiment, const Simulator& simulator) {
  if (!experiment.model.source && simulator.getEngine() != "lanes") {
    experiment.model.simulation.engine = Engine::kSimbody;
  }
  return experiment;
}

}  // namespace

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

void storeMap(const std::filesystem::path& file, const Study& study, const std::vector<Refined>& refined,
              TrainedMap& map) {
  if (map.online.trust) {
    map.online.trust->refinement = collectReference(refined);
  }
  const ExperimentSpec experiment = nameEngine(study.experiment, study.simulator);
  TrainedFile stored{
      experiment.model.parameters, experiment.model.inputs, {}, map.online, writeExperiment(experiment)};
  for (const FeatureInfo& info : study.extractor.getInfos()) {
    stored.feature_names.push_back(info.name);
  }
  writeTrainedFile(file, stored);
}

}  // namespace twinmap
