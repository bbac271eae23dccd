#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "framework/base/log/run_control.hpp"
#include "framework/data/features/feature_extractor.hpp"
#include "framework/data/noise/feature_noise.hpp"
#include "framework/data/reduction/response_reduction.hpp"
#include "framework/data/sensitivity/feature_sensitivities.hpp"
#include "framework/estimation/run_tasks.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "framework/simulation/simulator.hpp"
#include "framework/study/samples/sample_source.hpp"

namespace twinmap {

/// What a study of reduced samples was made of (reduceExperiment).
struct ReducedStudy {
  const ExperimentSpec& whole;
  std::shared_ptr<const ResponseReduction> reduction;
};

/// An experiment and what each stage of its run works with. All that it refers to outlives it.
struct Study {
  const ExperimentSpec& experiment;
  const Simulator& simulator;         ///< of the experiment's model, at the times of its features
  const FeatureExtractor& extractor;  ///< of those features
  const FeatureNoise& noise;          ///< and of their noise
  const SampleSource* source;         ///< null where the samples are given, as in a verification
  std::filesystem::path folder;       ///< of the run
  RunControl control;
  const ReducedStudy* reduced = nullptr;  ///< null where all samples are looked at

  /// The same of an experiment that differs in its inverse map or its number of samples alone.
  Study with(const ExperimentSpec& other) const {
    return {other, simulator, extractor, noise, source, folder, control, reduced};
  }

  TrainingControl getTrainingControl() const { return {control.threads, control.abandon}; }
};

/// The local models of a study at points of its box, from the stencils that its source keeps (stencils.hpp).
std::vector<LocalModel> calcLocalModels(const Study& study, const Eigen::MatrixXd& points);

}  // namespace twinmap
