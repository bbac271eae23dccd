#pragma once

#include "framework/models/fmu/instance/functions.hpp"
#include "framework/models/fmu/instance/instance.hpp"
#include "framework/models/fmu/instance/message_log.hpp"
#include "framework/models/fmu/instance/native_values.hpp"

namespace twinmap::fmi {

std::unique_ptr<Instance> makeInstance(const Functions2& functions, const InstanceSource& source);
std::unique_ptr<Instance> makeInstance(const Functions3& functions, const InstanceSource& source);

/// A status, which both versions count alike, as a word of the standard.
inline const char* describeStatus(int status) {
  static constexpr const char* kNames[] = {"OK", "Warning", "Discard", "Error", "Fatal", "Pending"};
  return status >= fmi2OK && status <= fmi2Pending ? kNames[status] : "unknown status";
}

/// What FMI 2.0 and 3.0 have in common: Functions2 or 3, and the pointer that a library calls an instance.
template <class Functions, class Handle>
class CommonInstance : public Instance {
 public:
  CommonInstance(const Functions& functions, const InstanceSource& source)
      : f_(functions),
        states_(source.description.state_derivatives.size()),
        indicators_(source.description.event_indicators),
        completes_steps_(source.description.getCapabilities(source.kind).needs_completed_integrator_step) {}
  CommonInstance(const CommonInstance&) = delete;
  CommonInstance& operator=(const CommonInstance&) = delete;

  void exitInitialization() override { check(f_.ExitInitializationMode(handle_), "ExitInitializationMode"); }
  void terminate() override { check(f_.Terminate(handle_), "Terminate"); }
  bool reset() override {
    log_.clear();
    return f_.Reset != nullptr && int{f_.Reset(handle_)} <= fmi2Warning;
  }

  std::size_t getStateCount() override { return states_; }
  std::size_t getIndicatorCount() override { return indicators_; }
  void enterEventMode() override { check(f_.EnterEventMode(handle_), "EnterEventMode"); }
  void enterContinuousTimeMode() override {
    check(f_.EnterContinuousTimeMode(handle_), "EnterContinuousTimeMode");
  }
  void setTime(double time) override { check(f_.SetTime(handle_, time), "SetTime"); }
  void setStates(const double* states, std::size_t count) override {
    check(f_.SetContinuousStates(handle_, states, count), "SetContinuousStates");
  }
  void getStates(double* states, std::size_t count) override {
    check(f_.GetContinuousStates(handle_, states, count), "GetContinuousStates");
  }
  void getNominals(double* nominals, std::size_t count) override {
    check(f_.GetNominalsOfContinuousStates(handle_, nominals, count), "GetNominalsOfContinuousStates");
  }
  void getIndicators(double* indicators, std::size_t count) override {
    check(f_.GetEventIndicators(handle_, indicators, count), "GetEventIndicators");
  }
  IntegratorStepEnd completeIntegratorStep() override {
    if (!completes_steps_) {
      return {};
    }
    Boolean event = false, terminate = false;
    check(f_.CompletedIntegratorStep(handle_, true, &event, &terminate), "CompletedIntegratorStep");
    return {event != 0, terminate != 0};
  }

 protected:
  /// What the version has for yes and no.
  using Boolean = std::conditional_t<std::is_same_v<Functions, Functions2>, fmi2Boolean, fmi3Boolean>;

  /// What is made of the instance that the library made, or made not.
  void begin(Handle handle, const ModelDescription& description) {
    handle_ = handle;
    if (handle == nullptr) {
      fail("Instantiate made no instance", false);
    }
    std::vector<const char*> categories;
    for (const std::string& category : description.log_categories) {
      if (isErrorCategory(category)) {
        categories.push_back(category.c_str());
      }
    }
    if (f_.SetDebugLogging != nullptr && !categories.empty()) {
      f_.SetDebugLogging(handle_, true, categories.size(), categories.data());
    }
  }

  /// For the end of what the callbacks need.
  void free() {
    if (!fatal_) {
      f_.FreeInstance(handle_);
    }
  }

  [[noreturn]] void fail(const std::string& what, bool fatal) {
    fatal_ = fatal_ || fatal;
    throw FmuFailure(Functions::kPrefix + what + log_.describe(), fatal);
  }

  /// `function`: its name behind the prefix.
  void check(int status, const char* function) {
    if (status != fmi2OK && status != fmi2Warning) {
      fail(std::string(function) + " ended with " + describeStatus(status), status == fmi2Fatal);
    }
  }

  template <class Function>
  static void require(Function* function, const char* name) {
    if (function == nullptr) {
      throw FmuFailure(std::string("the FMU's library has no function ") + Functions::kPrefix + name);
    }
  }

  const Functions& f_;
  MessageLog log_;
  Handle handle_ = nullptr;
  std::size_t states_, indicators_;

 private:
  bool completes_steps_;
  bool fatal_ = false;
};

}  // namespace twinmap::fmi
