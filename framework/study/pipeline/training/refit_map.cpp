#include "framework/study/pipeline/training/refit_map.hpp"

#include "framework/data/features/experiment_features.hpp"
#include "framework/estimation/gp/train_gp_map.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/simulation/simulator_team.hpp"
#include "framework/store/samples_file.hpp"
#include "framework/study/pipeline/preparation/prepare_data.hpp"

namespace twinmap {

GpMap refitExactMap(const std::filesystem::path& run, const ExperimentSpec& experiment,
                    const GpMap& deployed) {
  const std::unique_ptr<Simulator> simulator =
      makeSimulator(experiment.model, collectTimes(experiment.features), countModes(experiment.features));
  const FeatureExtractor extractor = makeExtractor(experiment, simulator->getLayout());
  StoredSamples stored = readSamplesFile(run / "samples.h5");
  SimulatedSets sets =
      failIncompleteSamples(experiment, extractor, {std::move(stored.train), std::move(stored.test)});
  const FeatureNoise noise(extractor, ResponseNoise(experiment.noise, sets.train.layout), experiment.seed);
  RunControl control;
  control.threads = countThreads();
  const Study study{experiment, *simulator, extractor, noise, nullptr, run, control};
  const PreparedData data = prepareData(study, std::move(sets));
  return refitGpMap(deployed, *experiment.inverse_map.findProcesses(), experiment.transform,
                    data.labelled.train, control.threads, experiment.model.inputs)
      .map;
}

}  // namespace twinmap
