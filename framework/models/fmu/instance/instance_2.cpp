#include <cstdarg>
#include <cstdio>
#include <cstdlib>

#include "framework/models/fmu/instance/common_instance.hpp"

namespace twinmap::fmi {
namespace {

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
  static_cast<MessageLog*>(environment)->add(describeStatus(status), text);
}

class Instance2 final : public CommonInstance<Functions2, fmi2Component> {
 public:
  Instance2(const Functions2& functions, const InstanceSource& source) : CommonInstance(functions, source) {
    const fmi2Type type = source.kind == Kind::kCoSimulation ? fmi2CoSimulation : fmi2ModelExchange;
    const std::string resources = toFileUri(source.resources);
    begin(f_.Instantiate("twinmap", type, source.description.token.c_str(), resources.c_str(), &callbacks_,
                         fmi2False, fmi2False),
          source.description);
  }

  ~Instance2() override { free(); }

  void enterInitialization(double start, double stop, std::optional<double> tolerance) override {
    check(f_.SetupExperiment(handle_, tolerance.has_value(), tolerance.value_or(0.0), start, fmi2True, stop),
          "SetupExperiment");
    check(f_.EnterInitializationMode(handle_), "EnterInitializationMode");
  }

  void get(ValueGroup& group, double* values) override {
    for (ValueGroup::Batch& batch : group.updBatches()) {
      if (batch.type == Type::kFloat64) {
        getBatchOf<fmi2Real>(batch, f_.GetReal, "GetReal");
      } else if (batch.type == Type::kBoolean) {
        getBatchOf<fmi2Boolean>(batch, f_.GetBoolean, "GetBoolean");
      } else {  // also enumerations
        getBatchOf<fmi2Integer>(batch, f_.GetInteger, "GetInteger");
      }
      gather(batch, values);
    }
  }
  void set(ValueGroup& group, const double* values) override {
    for (ValueGroup::Batch& batch : group.updBatches()) {
      scatter(values, batch);
      if (batch.type == Type::kFloat64) {
        setBatchOf<fmi2Real, fmi2Real>(batch, f_.SetReal, "SetReal");
      } else if (batch.type == Type::kBoolean) {
        setBatchOf<bool, fmi2Boolean>(batch, f_.SetBoolean, "SetBoolean");  // an int in FMI 2.0
      } else {
        setBatchOf<fmi2Integer, fmi2Integer>(batch, f_.SetInteger, "SetInteger");
      }
    }
  }

  EventInfo updateDiscreteStates() override {
    fmi2EventInfo info{};
    check(f_.NewDiscreteStates(handle_, &info), "NewDiscreteStates");
    return {
        info.newDiscreteStatesNeeded != fmi2False, info.terminateSimulation != fmi2False,
        info.valuesOfContinuousStatesChanged != fmi2False,
        info.nextEventTimeDefined != fmi2False ? std::optional<double>(info.nextEventTime) : std::nullopt};
  }
  bool getDerivatives(double* derivatives, std::size_t count) override {
    const fmi2Status status = f_.GetDerivatives(handle_, derivatives, count);
    return status == fmi2Discard ? false : (check(status, "GetDerivatives"), true);
  }
  void getDirectionalDerivative(const std::vector<std::uint32_t>& unknowns,
                                const std::vector<std::uint32_t>& knowns, const std::vector<double>& seed,
                                double* sensitivity) override {
    require(f_.GetDirectionalDerivative, "GetDirectionalDerivative");
    check(f_.GetDirectionalDerivative(handle_, unknowns.data(), unknowns.size(), knowns.data(), knowns.size(),
                                      seed.data(), sensitivity),
          "GetDirectionalDerivative");
  }

  CommunicationStepEnd doStep(double time, double step) override {
    const fmi2Status status = f_.DoStep(handle_, time, step, fmi2True);
    if (status == fmi2Pending) {
      throw FmuFailure("fmi2DoStep: the FMU steps asynchronously, which it was not asked to", true);
    }
    if (status != fmi2Discard) {
      check(status, "DoStep");
      return {time + step, false, false};
    }
    CommunicationStepEnd end{time, true, false};
    if (f_.GetRealStatus != nullptr) {
      f_.GetRealStatus(handle_, fmi2LastSuccessfulTime, &end.time);
    }
    fmi2Boolean terminated = fmi2False;
    if (f_.GetBooleanStatus != nullptr &&
        f_.GetBooleanStatus(handle_, fmi2Terminated, &terminated) == fmi2OK) {
      end.terminate = terminated != fmi2False;
    }
    return end;
  }

 private:
  template <class Native, class Get>
  void getBatchOf(ValueGroup::Batch& batch, Get* function, const char* name) {
    getBatch<Native>(batch, [&](auto* references, auto count, Native* values, auto) {
      check(function(handle_, references, count, values), name);
    });
  }
  template <class Rounded, class Native, class Set>
  void setBatchOf(const ValueGroup::Batch& batch, Set* function, const char* name) {
    setBatch<Rounded>(batch, [&](auto* references, auto count, const Rounded* values, auto) {
      if constexpr (std::is_same_v<Rounded, Native>) {
        check(function(handle_, references, count, values), name);
      } else {
        const std::vector<Native> own(values, values + count);
        check(function(handle_, references, count, own.data()), name);
      }
    });
  }

  fmi2CallbackFunctions callbacks_{logFmi2Message, std::calloc, std::free, nullptr, &log_};
};

}  // namespace

std::unique_ptr<Instance> makeInstance(const Functions2& functions, const InstanceSource& source) {
  return std::make_unique<Instance2>(functions, source);
}

}  // namespace twinmap::fmi
