#include "framework/models/fmu/instance/instance_3.hpp"

#include "framework/models/fmu/instance/log_categories.hpp"
#include "framework/models/fmu/instance/native_values.hpp"

namespace twinmap::fmi {
namespace {

const char* toText(fmi3Status status) {
  static constexpr const char* kNames[] = {"OK", "Warning", "Discard", "Error", "Fatal"};
  return status >= fmi3OK && status <= fmi3Fatal ? kNames[status] : "unknown status";
}

void logFmi3Message(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String, fmi3String message) {
  if (environment != nullptr && message != nullptr) {
    static_cast<MessageLog*>(environment)->add(toText(status), message);
  }
}

/// Clocks that follow the time would have to be ticked in event mode; without it the FMU does.
bool mayUseEventMode(const Functions3& functions, const InstanceSource& source) {
  return source.kind == Kind::kCoSimulation && source.description.co_simulation->event_mode &&
         source.description.findTimedClock() == nullptr && functions.enterEventMode != nullptr &&
         functions.updateDiscreteStates != nullptr && functions.enterStepMode != nullptr;
}

class Instance3 final : public Instance {
 public:
  Instance3(const Functions3& functions, const InstanceSource& source)
      : f_(functions),
        states_(source.description.state_derivatives.size()),
        indicators_(source.description.event_indicators),
        completes_steps_(source.description.getCapabilities(source.kind).needs_completed_integrator_step),
        event_mode_(mayUseEventMode(functions, source)) {
    const std::string resources = source.resources.string() + "/";
    if (source.kind == Kind::kCoSimulation) {
      const Capabilities& can = source.description.getCapabilities(source.kind);
      // a step that ends early goes on with a step of another size
      const bool early = (can.might_return_early || event_mode_) && can.variable_step;
      instance_ = f_.instantiateCoSimulation("twinmap", source.description.token.c_str(), resources.c_str(),
                                             fmi3False, fmi3False, event_mode_, early, nullptr, 0, &log_,
                                             logFmi3Message, nullptr);
    } else {
      instance_ = f_.instantiateModelExchange("twinmap", source.description.token.c_str(), resources.c_str(),
                                              fmi3False, fmi3False, &log_, logFmi3Message);
    }
    if (instance_ == nullptr) {
      throw FmuFailure("fmi3Instantiate made no instance" + log_.describe());
    }
    askForErrors(source.description);
  }
  ~Instance3() override {
    if (!fatal_) {
      f_.freeInstance(instance_);
    }
  }
  Instance3(const Instance3&) = delete;
  Instance3& operator=(const Instance3&) = delete;

  void enterInitialization(double start, double stop, std::optional<double> tolerance) override {
    check(f_.enterInitializationMode(instance_, tolerance.has_value(), tolerance.value_or(0.0), start,
                                     fmi3True, stop),
          "fmi3EnterInitializationMode");
  }
  void exitInitialization() override {
    check(f_.exitInitializationMode(instance_), "fmi3ExitInitializationMode");
    if (f_.getStateCount != nullptr) {
      check(f_.getStateCount(instance_, &states_), "fmi3GetNumberOfContinuousStates");
    }
    if (f_.getIndicatorCount != nullptr) {
      check(f_.getIndicatorCount(instance_, &indicators_), "fmi3GetNumberOfEventIndicators");
    }
  }
  void terminate() override { check(f_.terminate(instance_), "fmi3Terminate"); }
  bool reset() override {
    log_.clear();
    return f_.reset != nullptr && f_.reset(instance_) <= fmi3Warning;
  }

  void get(ValueGroup& group, double* values) override {
    for (ValueGroup::Batch& batch : group.updBatches()) {
      visitType(batch.type, [&](auto native, const auto& access, const char* name) {
        using Native = decltype(native);
        require(access.get, "fmi3Get", name);
        getBatch<Native>(batch, [&](auto* references, auto count, Native* own, auto size) {
          check(access.get(instance_, references, count, own, size), "fmi3Get", name);
        });
      });
      gather(batch, values);
    }
  }
  void set(ValueGroup& group, const double* values) override {
    for (ValueGroup::Batch& batch : group.updBatches()) {
      scatter(values, batch);
      visitType(batch.type, [&](auto native, const auto& access, const char* name) {
        using Native = decltype(native);
        require(access.set, "fmi3Set", name);
        setBatch<Native>(batch, [&](auto* references, auto count, const Native* own, auto size) {
          check(access.set(instance_, references, count, own, size), "fmi3Set", name);
        });
      });
    }
  }

  std::size_t getStateCount() override { return states_; }
  std::size_t getIndicatorCount() override { return indicators_; }
  void enterEventMode() override { check(f_.enterEventMode(instance_), "fmi3EnterEventMode"); }
  EventInfo updateDiscreteStates() override {
    bool again = false, terminate = false, nominals = false, states = false, defined = false;
    double next = 0.0;
    check(f_.updateDiscreteStates(instance_, &again, &terminate, &nominals, &states, &defined, &next),
          "fmi3UpdateDiscreteStates");
    return {again, terminate, states, defined ? std::optional<double>(next) : std::nullopt};
  }
  void enterContinuousTimeMode() override {
    check(f_.enterContinuousTimeMode(instance_), "fmi3EnterContinuousTimeMode");
  }
  void setTime(double time) override { check(f_.setTime(instance_, time), "fmi3SetTime"); }
  void setStates(const double* states, std::size_t count) override {
    check(f_.setContinuousStates(instance_, states, count), "fmi3SetContinuousStates");
  }
  void getStates(double* states, std::size_t count) override {
    check(f_.getContinuousStates(instance_, states, count), "fmi3GetContinuousStates");
  }
  void getNominals(double* nominals, std::size_t count) override {
    check(f_.getNominals(instance_, nominals, count), "fmi3GetNominalsOfContinuousStates");
  }
  bool getDerivatives(double* derivatives, std::size_t count) override {
    const fmi3Status status = f_.getDerivatives(instance_, derivatives, count);
    return status == fmi3Discard ? false : (check(status, "fmi3GetContinuousStateDerivatives"), true);
  }
  void getIndicators(double* indicators, std::size_t count) override {
    check(f_.getEventIndicators(instance_, indicators, count), "fmi3GetEventIndicators");
  }
  IntegratorStepEnd completeIntegratorStep() override {
    if (!completes_steps_) {
      return {};
    }
    bool event = false, terminate = false;
    check(f_.completedIntegratorStep(instance_, true, &event, &terminate), "fmi3CompletedIntegratorStep");
    return {event, terminate};
  }
  void getDirectionalDerivative(const std::vector<std::uint32_t>& unknowns,
                                const std::vector<std::uint32_t>& knowns, const std::vector<double>& seed,
                                double* sensitivity) override {
    require(f_.getDirectionalDerivative, "fmi3GetDirectional", "Derivative");
    check(f_.getDirectionalDerivative(instance_, unknowns.data(), unknowns.size(), knowns.data(),
                                      knowns.size(), seed.data(), seed.size(), sensitivity, unknowns.size()),
          "fmi3GetDirectionalDerivative");
  }

  CommunicationStepEnd doStep(double time, double step) override {
    bool event = false, terminate = false, early = false;
    double last = time;
    const fmi3Status status = f_.doStep(instance_, time, step, true, &event, &terminate, &early, &last);
    if (status == fmi3Discard) {
      return {last, true, terminate};
    }
    check(status, "fmi3DoStep");
    return {early || terminate ? last : time + step, false, terminate, event};
  }
  bool hasEventMode() const override { return event_mode_; }
  void enterStepMode() override { check(f_.enterStepMode(instance_), "fmi3EnterStepMode"); }

 private:
  void check(fmi3Status status, const char* function, const char* type = "") {
    if (status == fmi3OK || status == fmi3Warning) {
      return;
    }
    fatal_ = fatal_ || status == fmi3Fatal;
    throw FmuFailure(std::string(function) + type + " ended with " + toText(status) + log_.describe(),
                     status == fmi3Fatal);
  }

  template <class Function>
  static void require(Function* function, const char* verb, const char* type) {
    if (function == nullptr) {
      throw FmuFailure("the FMU's library has no function " + std::string(verb) + type);
    }
  }

  void askForErrors(const ModelDescription& description) {
    std::vector<fmi3String> categories;
    for (const std::string& category : description.log_categories) {
      if (isErrorCategory(category)) {
        categories.push_back(category.c_str());
      }
    }
    if (f_.setDebugLogging != nullptr && !categories.empty()) {
      f_.setDebugLogging(instance_, fmi3True, categories.size(), categories.data());
    }
  }

  /// Calls visit(a value of the native type, its functions, its name).
  template <class Visit>
  void visitType(Type type, const Visit& visit) {
    switch (type) {
      case Type::kFloat64:
        return visit(fmi3Float64{}, f_.float64, "Float64");
      case Type::kFloat32:
        return visit(fmi3Float32{}, f_.float32, "Float32");
      case Type::kInt8:
        return visit(fmi3Int8{}, f_.int8, "Int8");
      case Type::kUInt8:
        return visit(fmi3UInt8{}, f_.uint8, "UInt8");
      case Type::kInt16:
        return visit(fmi3Int16{}, f_.int16, "Int16");
      case Type::kUInt16:
        return visit(fmi3UInt16{}, f_.uint16, "UInt16");
      case Type::kInt32:
        return visit(fmi3Int32{}, f_.int32, "Int32");
      case Type::kUInt32:
        return visit(fmi3UInt32{}, f_.uint32, "UInt32");
      case Type::kUInt64:
        return visit(fmi3UInt64{}, f_.uint64, "UInt64");
      case Type::kBoolean:
        return visit(fmi3Boolean{}, f_.boolean, "Boolean");
      default:  // kInt64, and enumerations, which are of that type
        return visit(fmi3Int64{}, f_.int64, "Int64");
    }
  }

  const Functions3& f_;
  MessageLog log_;
  fmi3Instance instance_ = nullptr;
  std::size_t states_, indicators_;
  bool completes_steps_, event_mode_;
  bool fatal_ = false;
};

}  // namespace

std::unique_ptr<Instance> makeInstance3(const Functions3& functions, const InstanceSource& source) {
  return std::make_unique<Instance3>(functions, source);
}

}  // namespace twinmap::fmi
