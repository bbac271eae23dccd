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

}  // namespace twinmap
