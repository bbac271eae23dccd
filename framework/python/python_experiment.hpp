#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "framework/data/features/feature_extractor.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "framework/experiment/yaml/yaml_node.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap::python {

/// An experiment as Python holds it: immutable but for what is made when first needed, from any thread.
class PythonExperiment {
 public:
  /// Throws ExperimentError.
  explicit PythonExperiment(YamlNode tree);

  const YamlNode& getTree() const { return tree_; }
  const ExperimentSpec& getSpec() const { return spec_; }
  const ResponseLayout& getLayout() const { return layout_; }
  bool isSweep() const { return tree_.find("sweep") != nullptr; }

  /// To be cloned, not used.
  std::shared_ptr<const Simulator> getSimulator() const;
  std::shared_ptr<const FeatureExtractor> getExtractor() const;

 private:
  YamlNode tree_;
  ExperimentSpec spec_;
  ResponseLayout layout_;
  mutable std::mutex making_;
  mutable std::shared_ptr<const Simulator> simulator_;
  mutable std::shared_ptr<const FeatureExtractor> extractor_;
};

}  // namespace twinmap::python
