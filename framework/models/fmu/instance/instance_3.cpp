#include "framework/models/fmu/instance/common_instance.hpp"

namespace twinmap::fmi {
namespace {

void logFmi3Message(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String, fmi3String message) {
  if (environment != nullptr && message != nullptr) {
    static_cast<MessageLog*>(environment)->add(describeStatus(status), message);
  }
}

/// Clocks that follow the time would have to be ticked in event mode; without it the FMU does.
bool mayUseEventMode(const Functions3& functions, const InstanceSource& source) {
  return source.kind == Kind::kCoSimulation && source.description.co_simulation->event_mode &&
         source.description.findTimedClock() == nullptr && functions.EnterEventMode != nullptr &&
         functions.UpdateDiscreteStates != nullptr && functions.EnterStepMode != nullptr;
}

class Instance3 final : public CommonInstance<Functions3, fmi3Instance> {
 public:
  Instance3(const Functions3& functions, const InstanceSource& source)
      : CommonInstance(functions, source), event_mode_(mayUseEventMode(functions, source)) {
    const std::string resources = source.resources.string() + "/";
    const char* token = source.description.token.c_str();
    if (source.kind == Kind::kCoSimulation) {
      const Capabilities& can = source.description.getCapabilities(source.kind);
      // a step that ends early goes on with a step of another size
      const bool early = (can.might_return_early || event_mode_) && can.variable_step;
      begin(f_.InstantiateCoSimulation("twinmap", token, resources.c_str(), fmi3False, fmi3False, event_mode_,
                                       early, nullptr, 0, &log_, logFmi3Message, nullptr),
            source.description);
    } else {
      begin(f_.InstantiateModelExchange("twinmap", token, resources.c_str(), fmi3False, fmi3False, &log_,
                                        logFmi3Message),
            source.description);
    }
  }

  ~Instance3() override { free(); }

  void enterInitialization(double start, double stop, std::optional<double> tolerance) override {
    check(f_.EnterInitializationMode(handle_, tolerance.has_value(), tolerance.value_or(0.0), start, fmi3True,
                                     stop),
          "EnterInitializationMode");
  }
  void exitInitialization() override {
    CommonInstance::exitInitialization();
    if (f_.GetNumberOfContinuousStates != nullptr) {
      check(f_.GetNumberOfContinuousStates(handle_, &states_), "GetNumberOfContinuousStates");
    }
    if (f_.GetNumberOfEventIndicators != nullptr) {
      check(f_.GetNumberOfEventIndicators(handle_, &indicators_), "GetNumberOfEventIndicators");
    }
  }

  void get(ValueGroup& group, double* values) override {
    for (ValueGroup::Batch& batch : group.updBatches()) {
      visitType(batch.type, [&](auto native, auto* function, const char* name, auto*, const char*) {
        using Native = decltype(native);
        require(function, name);
        getBatch<Native>(batch, [&](auto* references, auto count, Native* own, auto size) {
          check(function(handle_, references, count, own, size), name);
        });
      });
      gather(batch, values);
    }
  }
  void set(ValueGroup& group, const double* values) override {
    for (ValueGroup::Batch& batch : group.updBatches()) {
      scatter(values, batch);
      visitType(batch.type, [&](auto native, auto*, const char*, auto* function, const char* name) {
        using Native = decltype(native);
        require(function, name);
        setBatch<Native>(batch, [&](auto* references, auto count, const Native* own, auto size) {
          check(function(handle_, references, count, own, size), name);
        });
      });
    }
  }

  EventInfo updateDiscreteStates() override {
    bool again = false, terminate = false, nominals = false, states = false, defined = false;
    double next = 0.0;
    check(f_.UpdateDiscreteStates(handle_, &again, &terminate, &nominals, &states, &defined, &next),
          "UpdateDiscreteStates");
    return {again, terminate, states, defined ? std::optional<double>(next) : std::nullopt};
  }
  bool getDerivatives(double* derivatives, std::size_t count) override {
    const fmi3Status status = f_.GetContinuousStateDerivatives(handle_, derivatives, count);
    return status == fmi3Discard ? false : (check(status, "GetContinuousStateDerivatives"), true);
  }
  void getDirectionalDerivative(const std::vector<std::uint32_t>& unknowns,
                                const std::vector<std::uint32_t>& knowns, const std::vector<double>& seed,
                                double* sensitivity) override {
    require(f_.GetDirectionalDerivative, "GetDirectionalDerivative");
    check(f_.GetDirectionalDerivative(handle_, unknowns.data(), unknowns.size(), knowns.data(), knowns.size(),
                                      seed.data(), seed.size(), sensitivity, unknowns.size()),
          "GetDirectionalDerivative");
  }

  CommunicationStepEnd doStep(double time, double step) override {
    bool event = false, terminate = false, early = false;
    double last = time;
    const fmi3Status status = f_.DoStep(handle_, time, step, true, &event, &terminate, &early, &last);
    if (status == fmi3Discard) {
      return {last, true, terminate};
    }
    check(status, "DoStep");
    return {early || terminate ? last : time + step, false, terminate, event};
  }
  bool hasEventMode() const override { return event_mode_; }
  void enterStepMode() override { check(f_.EnterStepMode(handle_), "EnterStepMode"); }

 private:
  /// Calls visit(a value of the native type, its function to get, that one's name, the same to set).
  template <class Visit>
  void visitType(Type type, const Visit& visit) {
#define TWINMAP_FMI3_VISIT(visit, type) \
  visit(fmi3##type{}, f_.Get##type, "Get" #type, f_.Set##type, "Set" #type)
#define TWINMAP_FMI3_CASE(visit, type) \
  case Type::k##type:                  \
    return TWINMAP_FMI3_VISIT(visit, type);
    switch (type) {
      TWINMAP_FMI3_TYPES(TWINMAP_FMI3_CASE, visit)
      default:  // enumerations
        return TWINMAP_FMI3_VISIT(visit, Int64);
    }
  }

  bool event_mode_;
};

}  // namespace

std::unique_ptr<Instance> makeInstance(const Functions3& functions, const InstanceSource& source) {
  return std::make_unique<Instance3>(functions, source);
}

}  // namespace twinmap::fmi
