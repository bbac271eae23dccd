#pragma once

#include <memory>
#include <optional>
#include <string>

#include "framework/models/fmu/instance/message_log.hpp"
#include "framework/models/fmu/instance/value_group.hpp"
#include "framework/models/fmu/package/model_description.hpp"

namespace twinmap::fmi {

/// What an event iteration ended with.
struct EventInfo {
  bool again = false;  ///< discrete states need another update
  bool terminate = false;
  bool states_changed = false;
  std::optional<double> next_time;  ///< s, of the next time event
};

struct IntegratorStepEnd {
  bool enter_event_mode = false, terminate = false;
};

/// How far a communication step came.
struct CommunicationStepEnd {
  double time = 0.0;       ///< s, up to which the solution is known
  bool discarded = false;  ///< the FMU refused the rest of the step
  bool terminate = false;
  bool event = false;  ///< to be handled in event mode
};

/// One instance of an FMU: FMI 2.0 and 3.0 behind one interface, with the modes of the standard's state
/// machines. Functions throw FmuFailure where a call ends with Error or Fatal, with the messages that the FMU
/// has logged; also with Discard, where nothing else is said. Not thread safe.
class Instance {
 public:
  virtual ~Instance() = default;

  /// Times in s.
  virtual void enterInitialization(double start, double stop, std::optional<double> tolerance) = 0;
  virtual void exitInitialization() = 0;
  virtual void terminate() = 0;
  /// Back to the state after the instantiation; false if the FMU cannot.
  virtual bool reset() = 0;

  virtual void get(ValueGroup& group, double* values) = 0;
  virtual void set(ValueGroup& group, const double* values) = 0;

  // Model Exchange
  virtual std::size_t getStateCount() = 0;
  virtual std::size_t getIndicatorCount() = 0;
  virtual void enterEventMode() = 0;
  virtual EventInfo updateDiscreteStates() = 0;
  virtual void enterContinuousTimeMode() = 0;
  virtual void setTime(double time) = 0;
  virtual void setStates(const double* states, std::size_t count) = 0;
  virtual void getStates(double* states, std::size_t count) = 0;
  virtual void getNominals(double* nominals, std::size_t count) = 0;
  /// False where the FMU discards the evaluation, which a smaller step may cure.
  virtual bool getDerivatives(double* derivatives, std::size_t count) = 0;
  virtual void getIndicators(double* indicators, std::size_t count) = 0;
  virtual IntegratorStepEnd completeIntegratorStep() = 0;
  /// sum over the knowns of d unknown / d known * seed, of value references of scalars.
  virtual void getDirectionalDerivative(const std::vector<std::uint32_t>& unknowns,
                                        const std::vector<std::uint32_t>& knowns,
                                        const std::vector<double>& seed, double* sensitivity) = 0;

  // Co-Simulation
  virtual CommunicationStepEnd doStep(double time, double step) = 0;
  /// Whether events are handled in event mode, where the initialisation then ends; enterEventMode() and
  /// updateDiscreteStates() are those of Model Exchange.
  virtual bool hasEventMode() const { return false; }
  virtual void enterStepMode() {}
};

/// Where an instance comes from.
struct InstanceSource {
  const ModelDescription& description;  ///< outlives whatever is made of it
  Kind kind;
  std::filesystem::path library;    ///< loaded into this process
  std::filesystem::path resources;  ///< the unpacked folder
};

/// Loads the library and makes an instance. Throws ExperimentError where the library does not fit its model
/// description, and FmuFailure where the FMU refuses.
class InstanceFactory {
 public:
  explicit InstanceFactory(const InstanceSource& source);
  ~InstanceFactory();
  std::unique_ptr<Instance> make();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace twinmap::fmi
