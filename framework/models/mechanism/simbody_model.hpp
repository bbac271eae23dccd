#pragma once

#include <Eigen/Core>
#include <memory>

#include "framework/models/mechanism/model_context.hpp"
#include "framework/models/mechanism/sample_task.hpp"
#include "framework/simulation/integration/integration.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// What follows from a state by Simbody, in the order of SystemNames.
struct SimbodyMotion {
  Eigen::VectorXd speeds, accelerations;  ///< Simbody's u and u'
  Eigen::VectorXd outputs;
};

/// A model built on Simbody: what lanes are compared with where a run starts, and an engine of its own. Lives
/// in a module that is loaded when the first of them is made, since to load Simbody's libraries takes longer
/// than to infer. Not thread safe; one for each thread.
class SimbodyModel {
 public:
  virtual ~SimbodyModel() = default;

  // At the centre of the bounds what cannot exist is wrong input: these two throw ExperimentError,
  // with the place of the number that is the cause where one is.

  /// Coordinates of the equilibrium that all samples start from; empty if the spec does not ask for it.
  virtual Eigen::VectorXd solveBoxCenter() = 0;
  /// The initial state exists and its accelerations are finite. `box_center`: of solveBoxCenter().
  virtual void checkStart(const Eigen::VectorXd& box_center) = 0;

  /// Builds the system of a parameter set, for calcMotion(). Throws SimulationFailure.
  virtual void setParameters(const Eigen::VectorXd& point) = 0;
  /// By Simbody's own solver, at time t of the phase of the excitation that begins at `phase_begin`. Throws
  /// SimulationFailure.
  virtual SimbodyMotion calcMotion(const InitialState& at, double t, double phase_begin) = 0;

  /// Simulates one parameter set. With dopri5, takes the steps of `sequence` if there are any, else keeps
  /// there those it took.
  virtual SampleStatus simulate(const SampleTask& task, const Eigen::Ref<const Eigen::VectorXd>& parameters,
                                Eigen::Ref<Eigen::VectorXd> response, StepSequence& sequence) = 0;
};

/// Builds everything once at the centre of the bounds, so that all expressions are compiled and all
/// names are known. `model` must outlive what is returned. Throws ExperimentError for unknown or doubled
/// names, expressions that do not compile, and a system that cannot exist there; std::runtime_error, with
/// what to install, where the module or Simbody is missing.
std::unique_ptr<SimbodyModel> makeSimbodyModel(const ModelSpec& model);

}  // namespace twinmap
