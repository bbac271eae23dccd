#include "framework/models/fmu/instance/instance_2.hpp"

#include <cstdarg>
#include <cstdio>
#include <cstdlib>

#include "framework/models/fmu/instance/log_categories.hpp"
#include "framework/models/fmu/instance/native_values.hpp"

namespace twinmap::fmi {
namespace {

const char* toText(fmi2Status status) {
  static constexpr const char* kNames[] = {"OK", "Warning", "Discard", "Error", "Fatal", "Pending"};
  return status >= fmi2OK && status <= fmi2Pending ? kNames[status] : "unknown status";
}

void logFmi2Message(fmi2ComponentEnvironment environment, fmi2String, fmi2Status status, fmi2String,
                    fmi2String message, ...) {
  if (environment == nullptr || message == nullptr) {
    return;
  }
  char text[1024];  // longer messages are cut
  va_list arguments;
  va_start(arguments, message);
  std::vsnprintf(text, sizeof text, message, arguments);
  va_end(arguments);
  static_cast<MessageLog*>(environment)->add(toText(status), text);
}

class Instance2 final : public Instance {
 public:
  Instance2(const Functions2& functions, const InstanceSource& source)
      : f_(functions),
        states_(source.description.state_derivatives.size()),
        indicators_(source.description.event_indicators),
        completes_steps_(source.description.getCapabilities(source.kind).needs_completed_integrator_step) {
    const fmi2Type type = source.kind == Kind::kCoSimulation ? fmi2CoSimulation : fmi2ModelExchange;
    const std::string resources = toFileUri(source.resources);
    instance_ = f_.instantiate("twinmap", type, source.description.token.c_str(), resources.c_str(),
                               &callbacks_, fmi2False, fmi2False);
    if (instance_ == nullptr) {
      throw FmuFailure("fmi2Instantiate made no instance" + log_.describe());
    }
    askForErrors(source.description);
  }
  ~Instance2() override {
    if (!fatal_) {
      f_.freeInstance(instance_);
    }
  }
  Instance2(const Instance2&) = delete;
  Instance2& operator=(const Instance2&) = delete;

  void enterInitialization(double start, double stop, std::optional<double> tolerance) override {
    check(f_.setupExperiment(instance_, tolerance ? fmi2True : fmi2False, tolerance.value_or(0.0), start,
                             fmi2True, stop),
          "fmi2SetupExperiment");
    check(f_.enterInitializationMode(instance_), "fmi2EnterInitializationMode");
  }
  void exitInitialization() override {
    check(f_.exitInitializationMode(instance_), "fmi2ExitInitializationMode");
  }
  void terminate() override { check(f_.terminate(instance_), "fmi2Terminate"); }
  bool reset() override {
    log_.clear();
    return f_.reset != nullptr && f_.reset(instance_) <= fmi2Warning;
  }

  void get(ValueGroup& group, double* values) override {
    for (ValueGroup::Batch& batch : group.updBatches()) {
      getBatchOfType(batch);
      gather(batch, values);
    }
  }
  void set(ValueGroup& group, const double* values) override {
    for (ValueGroup::Batch& batch : group.updBatches()) {
      scatter(values, batch);
      setBatchOfType(batch);
    }
  }

  std::size_t getStateCount() override { return states_; }
  std::size_t getIndicatorCount() override { return indicators_; }
  void enterEventMode() override { check(f_.enterEventMode(instance_), "fmi2EnterEventMode"); }
  EventInfo updateDiscreteStates() override {
    fmi2EventInfo info{};
    check(f_.newDiscreteStates(instance_, &info), "fmi2NewDiscreteStates");
    EventInfo result;
    result.again = info.newDiscreteStatesNeeded != fmi2False;
    result.terminate = info.terminateSimulation != fmi2False;
    result.states_changed = info.valuesOfContinuousStatesChanged != fmi2False;
    if (info.nextEventTimeDefined != fmi2False) {
      result.next_time = info.nextEventTime;
    }
    return result;
  }
  void enterContinuousTimeMode() override {
    check(f_.enterContinuousTimeMode(instance_), "fmi2EnterContinuousTimeMode");
  }
  void setTime(double time) override { check(f_.setTime(instance_, time), "fmi2SetTime"); }
  void setStates(const double* states, std::size_t count) override {
    check(f_.setContinuousStates(instance_, states, count), "fmi2SetContinuousStates");
  }
  void getStates(double* states, std::size_t count) override {
    check(f_.getContinuousStates(instance_, states, count), "fmi2GetContinuousStates");
  }
  void getNominals(double* nominals, std::size_t count) override {
    check(f_.getNominals(instance_, nominals, count), "fmi2GetNominalsOfContinuousStates");
  }
  bool getDerivatives(double* derivatives, std::size_t count) override {
    const fmi2Status status = f_.getDerivatives(instance_, derivatives, count);
    return status == fmi2Discard ? false : (check(status, "fmi2GetDerivatives"), true);
  }
  void getIndicators(double* indicators, std::size_t count) override {
    check(f_.getEventIndicators(instance_, indicators, count), "fmi2GetEventIndicators");
  }
  IntegratorStepEnd completeIntegratorStep() override {
    if (!completes_steps_) {
      return {};
    }
    fmi2Boolean event = fmi2False, terminate = fmi2False;
    check(f_.completedIntegratorStep(instance_, fmi2True, &event, &terminate), "fmi2CompletedIntegratorStep");
    return {event != fmi2False, terminate != fmi2False};
  }
  void getDirectionalDerivative(const std::vector<std::uint32_t>& unknowns,
                                const std::vector<std::uint32_t>& knowns, const std::vector<double>& seed,
                                double* sensitivity) override {
    if (f_.getDirectionalDerivative == nullptr) {
      throw FmuFailure("the FMU's library has no function fmi2GetDirectionalDerivative");
    }
    check(f_.getDirectionalDerivative(instance_, unknowns.data(), unknowns.size(), knowns.data(),
                                      knowns.size(), seed.data(), sensitivity),
          "fmi2GetDirectionalDerivative");
  }

  CommunicationStepEnd doStep(double time, double step) override {
    const fmi2Status status = f_.doStep(instance_, time, step, fmi2True);
    if (status == fmi2Pending) {
      throw FmuFailure("fmi2DoStep: the FMU steps asynchronously, which it was not asked to", true);
    }
    if (status != fmi2Discard) {
      check(status, "fmi2DoStep");
      return {time + step, false, false};
    }
    CommunicationStepEnd end{time, true, false};
    if (f_.getRealStatus != nullptr) {
      f_.getRealStatus(instance_, fmi2LastSuccessfulTime, &end.time);
    }
    fmi2Boolean terminated = fmi2False;
    if (f_.getBooleanStatus != nullptr &&
        f_.getBooleanStatus(instance_, fmi2Terminated, &terminated) == fmi2OK) {
      end.terminate = terminated != fmi2False;
    }
    return end;
  }

 private:
  void check(fmi2Status status, const char* function) {
    if (status == fmi2OK || status == fmi2Warning) {
      return;
    }
    fatal_ = fatal_ || status == fmi2Fatal;
    throw FmuFailure(std::string(function) + " ended with " + toText(status) + log_.describe(),
                     status == fmi2Fatal);
  }

  void askForErrors(const ModelDescription& description) {
    std::vector<fmi2String> categories;
    for (const std::string& category : description.log_categories) {
      if (isErrorCategory(category)) {
        categories.push_back(category.c_str());
      }
    }
    if (f_.setDebugLogging != nullptr && !categories.empty()) {
      f_.setDebugLogging(instance_, fmi2True, categories.size(), categories.data());
    }
  }

  void getBatchOfType(ValueGroup::Batch& batch) {
    if (batch.type == Type::kFloat64) {
      getBatch<double>(batch, [this](auto* references, auto count, double* values, auto) {
        check(f_.getReal(instance_, references, count, values), "fmi2GetReal");
      });
    } else if (batch.type == Type::kBoolean) {
      getBatch<fmi2Boolean>(batch, [this](auto* references, auto count, fmi2Boolean* values, auto) {
        check(f_.getBoolean(instance_, references, count, values), "fmi2GetBoolean");
      });
    } else {  // also enumerations
      getBatch<fmi2Integer>(batch, [this](auto* references, auto count, fmi2Integer* values, auto) {
        check(f_.getInteger(instance_, references, count, values), "fmi2GetInteger");
      });
    }
  }

  void setBatchOfType(const ValueGroup::Batch& batch) {
    if (batch.type == Type::kFloat64) {
      setBatch<double>(batch, [this](auto* references, auto count, const double* values, auto) {
        check(f_.setReal(instance_, references, count, values), "fmi2SetReal");
      });
    } else if (batch.type == Type::kBoolean) {
      setBatch<bool>(batch, [this](auto* references, auto count, const bool* values, auto) {
        const std::vector<fmi2Boolean> own(values, values + count);  // an int in FMI 2.0
        check(f_.setBoolean(instance_, references, count, own.data()), "fmi2SetBoolean");
      });
    } else {
      setBatch<fmi2Integer>(batch, [this](auto* references, auto count, const fmi2Integer* values, auto) {
        check(f_.setInteger(instance_, references, count, values), "fmi2SetInteger");
      });
    }
  }

  const Functions2& f_;
  MessageLog log_;
  fmi2CallbackFunctions callbacks_{logFmi2Message, std::calloc, std::free, nullptr, &log_};
  fmi2Component instance_ = nullptr;
  std::size_t states_, indicators_;
  bool completes_steps_;
  bool fatal_ = false;
};

}  // namespace

std::unique_ptr<Instance> makeInstance2(const Functions2& functions, const InstanceSource& source) {
  return std::make_unique<Instance2>(functions, source);
}

}  // namespace twinmap::fmi
