#pragma once

#include <memory>

#include "framework/experiment/model/model_spec.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// The simulator of a model, wherever it comes from: a system that the experiment describes, an FMU,
/// or a program.
/// `times` and `modes` as of MultibodySimulator. Throws ExperimentError for anything wrong with the model
/// that no parameter set can cure.
std::unique_ptr<Simulator> makeSimulator(const ModelSpec& model, const Eigen::VectorXd& times, int modes = 0);

/// The same for a model that a run has checked, as where one of its estimators is refined: a system that
/// lanes simulate is not compared with Simbody, which is not even loaded then.
std::unique_ptr<Simulator> makeTrustedSimulator(const ModelSpec& model, const Eigen::VectorXd& times,
                                                int modes = 0);

}  // namespace twinmap
