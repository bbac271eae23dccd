#pragma once

#include "framework/models/fmu/headers/fmi2FunctionTypes.h"
#include "framework/models/fmu/headers/fmi3FunctionTypes.h"
#include "framework/models/fmu/instance/shared_library.hpp"
#include "framework/models/fmu/package/model_description.hpp"

namespace twinmap::fmi {

// The functions that twinmap calls: the name after "fmi2" or "fmi3", the need of Model Exchange and of
// Co-Simulation. First those that both versions have.
#define TWINMAP_FMI_FUNCTIONS(F)                   \
  F(GetVersion, Required, Required)                \
  F(SetDebugLogging, Optional, Optional)           \
  F(FreeInstance, Required, Required)              \
  F(EnterInitializationMode, Required, Required)   \
  F(ExitInitializationMode, Required, Required)    \
  F(Terminate, Required, Required)                 \
  F(Reset, Optional, Optional)                     \
  F(EnterEventMode, Required, Optional)            \
  F(EnterContinuousTimeMode, Required, None)       \
  F(CompletedIntegratorStep, Required, None)       \
  F(SetTime, Required, None)                       \
  F(SetContinuousStates, Required, None)           \
  F(GetEventIndicators, Required, None)            \
  F(GetContinuousStates, Required, None)           \
  F(GetNominalsOfContinuousStates, Required, None) \
  F(GetDirectionalDerivative, Optional, None)      \
  F(DoStep, None, Required)

#define TWINMAP_FMI2_FUNCTIONS(F)        \
  TWINMAP_FMI_FUNCTIONS(F)               \
  F(Instantiate, Required, Required)     \
  F(SetupExperiment, Required, Required) \
  F(GetReal, Required, Required)         \
  F(SetReal, Required, Required)         \
  F(GetInteger, Required, Required)      \
  F(SetInteger, Required, Required)      \
  F(GetBoolean, Required, Required)      \
  F(SetBoolean, Required, Required)      \
  F(NewDiscreteStates, Required, None)   \
  F(GetDerivatives, Required, None)      \
  F(GetRealStatus, None, Optional)       \
  F(GetBooleanStatus, None, Optional)

// F(argument, type) of each type of numbers
#define TWINMAP_FMI3_TYPES(F, argument) \
  F(argument, Float64)                  \
  F(argument, Float32)                  \
  F(argument, Int64)                    \
  F(argument, UInt64)                   \
  F(argument, Int32)                    \
  F(argument, UInt32)                   \
  F(argument, Int16) F(argument, UInt16) F(argument, Int8) F(argument, UInt8) F(argument, Boolean)
#define TWINMAP_FMI3_ACCESS(F, Type) F(Get##Type, Optional, Optional) F(Set##Type, Optional, Optional)

#define TWINMAP_FMI3_FUNCTIONS(F)                                                 \
  TWINMAP_FMI_FUNCTIONS(F)                                                        \
  F(InstantiateModelExchange, Required, None)                                     \
  F(InstantiateCoSimulation, None, Required)                                      \
  F(UpdateDiscreteStates, Required, Optional)                                     \
  F(EnterStepMode, None, Optional) /* without it the library has no event mode */ \
  F(GetContinuousStateDerivatives, Required, None)                                \
  F(GetNumberOfEventIndicators, Optional, None)                                   \
  F(GetNumberOfContinuousStates, Optional, None) TWINMAP_FMI3_TYPES(TWINMAP_FMI3_ACCESS, F)

#define TWINMAP_FMI2_MEMBER(name, exchange, simulation) fmi2##name##TYPE* name;
#define TWINMAP_FMI3_MEMBER(name, exchange, simulation) fmi3##name##TYPE* name;
#define TWINMAP_FMI_LOAD(name, exchange, simulation) \
  library.load(name, kPrefix, #name, kind == Kind::kCoSimulation ? Need::k##simulation : Need::k##exchange);

/// The functions of an FMI 2.0 library; those that the kind does not need or the library does not have are
/// null.
struct Functions2 {
  static constexpr const char* kPrefix = "fmi2";
  TWINMAP_FMI2_FUNCTIONS(TWINMAP_FMI2_MEMBER)

  /// Throws ExperimentError that names a function which the kind demands and the library does not have.
  Functions2(const SharedLibrary& library, Kind kind) { TWINMAP_FMI2_FUNCTIONS(TWINMAP_FMI_LOAD) }
};

/// The same of an FMI 3.0 library, which may also lack those that set and read values of a type.
struct Functions3 {
  static constexpr const char* kPrefix = "fmi3";
  TWINMAP_FMI3_FUNCTIONS(TWINMAP_FMI3_MEMBER)

  Functions3(const SharedLibrary& library, Kind kind) { TWINMAP_FMI3_FUNCTIONS(TWINMAP_FMI_LOAD) }
};

}  // namespace twinmap::fmi
