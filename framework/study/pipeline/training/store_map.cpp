#include "framework/study/pipeline/training/store_map.hpp"

#include <algorithm>

#include "framework/experiment/experiment_file.hpp"
#include "framework/store/trained_file.hpp"

namespace twinmap {

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

void storeMap(const std::filesystem::path& file, const ExperimentSpec& experiment,
              const FeatureExtractor& extractor, const std::vector<Refined>& refined, TrainedMap& map) {
  if (map.online.trust) {
    map.online.trust->refinement = collectReference(refined);
  }
  TrainedFile stored{
      experiment.model.parameters, experiment.model.inputs, {}, map.online, writeExperiment(experiment)};
  for (const FeatureInfo& info : extractor.getInfos()) {
    stored.feature_names.push_back(info.name);
  }
  writeTrainedFile(file, stored);
}

}  // namespace twinmap
