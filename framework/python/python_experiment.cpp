#include "framework/python/python_experiment.hpp"

#include "framework/data/features/experiment_features.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/inference/tolerances/tolerances.hpp"
#include "framework/models/make_simulator.hpp"

namespace twinmap::python {

PythonExperiment::PythonExperiment(YamlNode tree)
    : tree_(std::move(tree)), spec_(readExperimentWithSignals(tree_)), layout_(makeLayout(spec_)) {}

std::shared_ptr<const Simulator> PythonExperiment::getSimulator() const {
  const std::lock_guard<std::mutex> lock(making_);
  if (!simulator_) {
    simulator_ = makeSimulator(followNoise(spec_).model, layout_.times, layout_.modes);
  }
  return simulator_;
}

std::shared_ptr<const FeatureExtractor> PythonExperiment::getExtractor() const {
  const std::lock_guard<std::mutex> lock(making_);
  if (!extractor_) {
    extractor_ = std::make_shared<FeatureExtractor>(makeExtractor(spec_, layout_));
  }
  return extractor_;
}

}  // namespace twinmap::python
