#pragma once

#include "framework/models/fmu/instance/failure.hpp"
#include "framework/models/fmu/run/run_setting.hpp"
#include "framework/simulation/excitation/excitation.hpp"
#include "framework/simulation/integration/make_hybrid_stepper.hpp"

namespace twinmap::fmi {

/// An FMU's inputs, driven by the excitation: those that may change between events, and the discrete ones,
/// which change at events and communication points only.
class DrivenInputs {
 public:
  DrivenInputs(const BoundVariables& inputs, int signals);

  bool hasContinuous() const { return !continuous_.isEmpty(); }
  bool isEmpty() const { return continuous_.isEmpty() && discrete_.isEmpty(); }
  /// Whether a discrete input at t is not what it was set to last.
  bool hasDiscreteChanged(const Excitation& excitation, double t);

  void setAll(Instance& instance, const Excitation& excitation, double t);
  void setDiscrete(Instance& instance, const Excitation& excitation, double t);
  void setContinuous(Instance& instance, const Excitation& excitation, double t);

 private:
  BoundGroup continuous_, discrete_;
  std::vector<double> values_, discrete_values_;
};

/// The steps of a Model Exchange simulation, which neighbours can take too.
struct IntegrationPath {
  StepSequence steps;  ///< empty: none that they could take
  HybridMethod method = HybridMethod::kExplicit;
};

/// One sample while it runs: all that the two kinds share.
struct SampleRun {
  Instance& instance;
  const RunSetting& setting;
  const Capabilities& capabilities;
  Excitation& excitation;  ///< updated for the sample
  DrivenInputs& inputs;
  BoundGroup& outputs;
  Eigen::Ref<Eigen::VectorXd> response;  ///< output by output, as ResponseLayout
  IntegrationPath& path;  ///< of Model Exchange: steps to take, or, where it has none, those that were taken

  /// Reads the outputs at output time `index` from the instance. Throws FmuFailure for one that is not
  /// finite.
  void record(int index);

  /// Initialises the FMU at t = 0 with the excitation of its first phase.
  void initialise();
};

/// Updates discrete states, in event mode, until none needs another update. Throws FmuFailure where that does
/// not end.
EventInfo iterateEvents(Instance& instance, double t);

/// Simulate a sample from an instance whose parameters are set. Throw SimulationFailure where they cannot.
void runCoSimulation(SampleRun& run, double largest_step);
void runModelExchange(SampleRun& run);  // by the path's method

/// An explicit method has reached the step limit, which an implicit one may cure.
class StepLimitReached : public FmuFailure {
 public:
  using FmuFailure::FmuFailure;
};

/// A communication step was refused, which a smaller one may cure.
class StepDiscarded : public FmuFailure {
 public:
  using FmuFailure::FmuFailure;
};

}  // namespace twinmap::fmi
