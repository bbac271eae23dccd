/* Functions of the Functional Mock-up Interface 2.0, as a source-code FMU declares them: their names begin with
   FMI2_FUNCTION_PREFIX where that is defined, as it is in libraries that hold several FMUs. */
#ifndef fmi2Functions_h
#define fmi2Functions_h

#include "fmi2FunctionTypes.h"
#include "fmi2TypesPlatform.h"

#ifdef __cplusplus
extern "C" {
#endif

#ifndef FMI2_Export
#define FMI2_Export __attribute__((visibility("default")))
#endif

#define fmi2Paste(a, b) a##b
#define fmi2PasteB(a, b) fmi2Paste(a, b)
#ifdef FMI2_FUNCTION_PREFIX
#define fmi2FullName(name) fmi2PasteB(FMI2_FUNCTION_PREFIX, name)
#else
#define fmi2FullName(name) name
#endif

#define fmi2Version "2.0"

#define fmi2GetTypesPlatform fmi2FullName(fmi2GetTypesPlatform)
#define fmi2GetVersion fmi2FullName(fmi2GetVersion)
#define fmi2SetDebugLogging fmi2FullName(fmi2SetDebugLogging)
#define fmi2Instantiate fmi2FullName(fmi2Instantiate)
#define fmi2FreeInstance fmi2FullName(fmi2FreeInstance)
#define fmi2SetupExperiment fmi2FullName(fmi2SetupExperiment)
#define fmi2EnterInitializationMode fmi2FullName(fmi2EnterInitializationMode)
#define fmi2ExitInitializationMode fmi2FullName(fmi2ExitInitializationMode)
#define fmi2Terminate fmi2FullName(fmi2Terminate)
#define fmi2Reset fmi2FullName(fmi2Reset)
#define fmi2GetReal fmi2FullName(fmi2GetReal)
#define fmi2GetInteger fmi2FullName(fmi2GetInteger)
#define fmi2GetBoolean fmi2FullName(fmi2GetBoolean)
#define fmi2GetString fmi2FullName(fmi2GetString)
#define fmi2SetReal fmi2FullName(fmi2SetReal)
#define fmi2SetInteger fmi2FullName(fmi2SetInteger)
#define fmi2SetBoolean fmi2FullName(fmi2SetBoolean)
#define fmi2SetString fmi2FullName(fmi2SetString)
#define fmi2GetFMUstate fmi2FullName(fmi2GetFMUstate)
#define fmi2SetFMUstate fmi2FullName(fmi2SetFMUstate)
#define fmi2FreeFMUstate fmi2FullName(fmi2FreeFMUstate)
#define fmi2SerializedFMUstateSize fmi2FullName(fmi2SerializedFMUstateSize)
#define fmi2SerializeFMUstate fmi2FullName(fmi2SerializeFMUstate)
#define fmi2DeSerializeFMUstate fmi2FullName(fmi2DeSerializeFMUstate)
#define fmi2GetDirectionalDerivative fmi2FullName(fmi2GetDirectionalDerivative)
#define fmi2EnterEventMode fmi2FullName(fmi2EnterEventMode)
#define fmi2NewDiscreteStates fmi2FullName(fmi2NewDiscreteStates)
#define fmi2EnterContinuousTimeMode fmi2FullName(fmi2EnterContinuousTimeMode)
#define fmi2CompletedIntegratorStep fmi2FullName(fmi2CompletedIntegratorStep)
#define fmi2SetTime fmi2FullName(fmi2SetTime)
#define fmi2SetContinuousStates fmi2FullName(fmi2SetContinuousStates)
#define fmi2GetDerivatives fmi2FullName(fmi2GetDerivatives)
#define fmi2GetEventIndicators fmi2FullName(fmi2GetEventIndicators)
#define fmi2GetContinuousStates fmi2FullName(fmi2GetContinuousStates)
#define fmi2GetNominalsOfContinuousStates fmi2FullName(fmi2GetNominalsOfContinuousStates)
#define fmi2SetRealInputDerivatives fmi2FullName(fmi2SetRealInputDerivatives)
#define fmi2GetRealOutputDerivatives fmi2FullName(fmi2GetRealOutputDerivatives)
#define fmi2DoStep fmi2FullName(fmi2DoStep)
#define fmi2CancelStep fmi2FullName(fmi2CancelStep)
#define fmi2GetStatus fmi2FullName(fmi2GetStatus)
#define fmi2GetRealStatus fmi2FullName(fmi2GetRealStatus)
#define fmi2GetIntegerStatus fmi2FullName(fmi2GetIntegerStatus)
#define fmi2GetBooleanStatus fmi2FullName(fmi2GetBooleanStatus)
#define fmi2GetStringStatus fmi2FullName(fmi2GetStringStatus)

#define fmi2Declare(name) FMI2_Export fmi2##name##TYPE fmi2##name;
fmi2Declare(GetTypesPlatform) fmi2Declare(GetVersion) fmi2Declare(SetDebugLogging) fmi2Declare(Instantiate)
fmi2Declare(FreeInstance) fmi2Declare(SetupExperiment) fmi2Declare(EnterInitializationMode)
fmi2Declare(ExitInitializationMode) fmi2Declare(Terminate) fmi2Declare(Reset) fmi2Declare(GetReal)
fmi2Declare(GetInteger) fmi2Declare(GetBoolean) fmi2Declare(GetString) fmi2Declare(SetReal) fmi2Declare(SetInteger)
fmi2Declare(SetBoolean) fmi2Declare(SetString) fmi2Declare(GetFMUstate) fmi2Declare(SetFMUstate)
fmi2Declare(FreeFMUstate) fmi2Declare(SerializedFMUstateSize) fmi2Declare(SerializeFMUstate)
fmi2Declare(DeSerializeFMUstate) fmi2Declare(GetDirectionalDerivative) fmi2Declare(EnterEventMode)
fmi2Declare(NewDiscreteStates) fmi2Declare(EnterContinuousTimeMode) fmi2Declare(CompletedIntegratorStep)
fmi2Declare(SetTime) fmi2Declare(SetContinuousStates) fmi2Declare(GetDerivatives) fmi2Declare(GetEventIndicators)
fmi2Declare(GetContinuousStates) fmi2Declare(GetNominalsOfContinuousStates) fmi2Declare(SetRealInputDerivatives)
fmi2Declare(GetRealOutputDerivatives) fmi2Declare(DoStep) fmi2Declare(CancelStep) fmi2Declare(GetStatus)
fmi2Declare(GetRealStatus) fmi2Declare(GetIntegerStatus) fmi2Declare(GetBooleanStatus) fmi2Declare(GetStringStatus)

#ifdef __cplusplus
}
#endif

#endif
