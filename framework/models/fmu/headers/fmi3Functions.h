/* Functions of the Functional Mock-up Interface 3.0, as a source-code FMU declares them: their names begin with
   FMI3_FUNCTION_PREFIX where that is defined, as it is in libraries that hold several FMUs. */
#ifndef fmi3Functions_h
#define fmi3Functions_h

#include "fmi3FunctionTypes.h"
#include "fmi3PlatformTypes.h"

#ifdef __cplusplus
extern "C" {
#endif

#ifndef FMI3_Export
#define FMI3_Export __attribute__((visibility("default")))
#endif

#define fmi3Paste(a, b) a##b
#define fmi3PasteB(a, b) fmi3Paste(a, b)
/* whoever compiles the sources of an FMU overrides the prefix that they set */
#if !defined(FMI3_OVERRIDE_FUNCTION_PREFIX) && defined(FMI3_FUNCTION_PREFIX)
#define FMI3_ACTUAL_FUNCTION_PREFIX FMI3_FUNCTION_PREFIX
#endif
#ifdef FMI3_ACTUAL_FUNCTION_PREFIX
#define fmi3FullName(name) fmi3PasteB(FMI3_ACTUAL_FUNCTION_PREFIX, name)
#else
#define fmi3FullName(name) name
#endif

#define fmi3Version "3.0"

#define fmi3GetVersion fmi3FullName(fmi3GetVersion)
#define fmi3SetDebugLogging fmi3FullName(fmi3SetDebugLogging)
#define fmi3InstantiateModelExchange fmi3FullName(fmi3InstantiateModelExchange)
#define fmi3InstantiateCoSimulation fmi3FullName(fmi3InstantiateCoSimulation)
#define fmi3InstantiateScheduledExecution fmi3FullName(fmi3InstantiateScheduledExecution)
#define fmi3FreeInstance fmi3FullName(fmi3FreeInstance)
#define fmi3EnterInitializationMode fmi3FullName(fmi3EnterInitializationMode)
#define fmi3ExitInitializationMode fmi3FullName(fmi3ExitInitializationMode)
#define fmi3EnterEventMode fmi3FullName(fmi3EnterEventMode)
#define fmi3Terminate fmi3FullName(fmi3Terminate)
#define fmi3Reset fmi3FullName(fmi3Reset)
#define fmi3EnterConfigurationMode fmi3FullName(fmi3EnterConfigurationMode)
#define fmi3ExitConfigurationMode fmi3FullName(fmi3ExitConfigurationMode)
#define fmi3GetFloat32 fmi3FullName(fmi3GetFloat32)
#define fmi3GetFloat64 fmi3FullName(fmi3GetFloat64)
#define fmi3GetInt8 fmi3FullName(fmi3GetInt8)
#define fmi3GetUInt8 fmi3FullName(fmi3GetUInt8)
#define fmi3GetInt16 fmi3FullName(fmi3GetInt16)
#define fmi3GetUInt16 fmi3FullName(fmi3GetUInt16)
#define fmi3GetInt32 fmi3FullName(fmi3GetInt32)
#define fmi3GetUInt32 fmi3FullName(fmi3GetUInt32)
#define fmi3GetInt64 fmi3FullName(fmi3GetInt64)
#define fmi3GetUInt64 fmi3FullName(fmi3GetUInt64)
#define fmi3GetBoolean fmi3FullName(fmi3GetBoolean)
#define fmi3GetString fmi3FullName(fmi3GetString)
#define fmi3GetBinary fmi3FullName(fmi3GetBinary)
#define fmi3GetClock fmi3FullName(fmi3GetClock)
#define fmi3SetFloat32 fmi3FullName(fmi3SetFloat32)
#define fmi3SetFloat64 fmi3FullName(fmi3SetFloat64)
#define fmi3SetInt8 fmi3FullName(fmi3SetInt8)
#define fmi3SetUInt8 fmi3FullName(fmi3SetUInt8)
#define fmi3SetInt16 fmi3FullName(fmi3SetInt16)
#define fmi3SetUInt16 fmi3FullName(fmi3SetUInt16)
#define fmi3SetInt32 fmi3FullName(fmi3SetInt32)
#define fmi3SetUInt32 fmi3FullName(fmi3SetUInt32)
#define fmi3SetInt64 fmi3FullName(fmi3SetInt64)
#define fmi3SetUInt64 fmi3FullName(fmi3SetUInt64)
#define fmi3SetBoolean fmi3FullName(fmi3SetBoolean)
#define fmi3SetString fmi3FullName(fmi3SetString)
#define fmi3SetBinary fmi3FullName(fmi3SetBinary)
#define fmi3SetClock fmi3FullName(fmi3SetClock)
#define fmi3GetNumberOfVariableDependencies fmi3FullName(fmi3GetNumberOfVariableDependencies)
#define fmi3GetVariableDependencies fmi3FullName(fmi3GetVariableDependencies)
#define fmi3GetFMUState fmi3FullName(fmi3GetFMUState)
#define fmi3SetFMUState fmi3FullName(fmi3SetFMUState)
#define fmi3FreeFMUState fmi3FullName(fmi3FreeFMUState)
#define fmi3SerializedFMUStateSize fmi3FullName(fmi3SerializedFMUStateSize)
#define fmi3SerializeFMUState fmi3FullName(fmi3SerializeFMUState)
#define fmi3DeserializeFMUState fmi3FullName(fmi3DeserializeFMUState)
#define fmi3GetDirectionalDerivative fmi3FullName(fmi3GetDirectionalDerivative)
#define fmi3GetAdjointDerivative fmi3FullName(fmi3GetAdjointDerivative)
#define fmi3GetIntervalDecimal fmi3FullName(fmi3GetIntervalDecimal)
#define fmi3GetIntervalFraction fmi3FullName(fmi3GetIntervalFraction)
#define fmi3GetShiftDecimal fmi3FullName(fmi3GetShiftDecimal)
#define fmi3GetShiftFraction fmi3FullName(fmi3GetShiftFraction)
#define fmi3SetIntervalDecimal fmi3FullName(fmi3SetIntervalDecimal)
#define fmi3SetIntervalFraction fmi3FullName(fmi3SetIntervalFraction)
#define fmi3SetShiftDecimal fmi3FullName(fmi3SetShiftDecimal)
#define fmi3SetShiftFraction fmi3FullName(fmi3SetShiftFraction)
#define fmi3EvaluateDiscreteStates fmi3FullName(fmi3EvaluateDiscreteStates)
#define fmi3UpdateDiscreteStates fmi3FullName(fmi3UpdateDiscreteStates)
#define fmi3EnterContinuousTimeMode fmi3FullName(fmi3EnterContinuousTimeMode)
#define fmi3CompletedIntegratorStep fmi3FullName(fmi3CompletedIntegratorStep)
#define fmi3SetTime fmi3FullName(fmi3SetTime)
#define fmi3SetContinuousStates fmi3FullName(fmi3SetContinuousStates)
#define fmi3GetContinuousStateDerivatives fmi3FullName(fmi3GetContinuousStateDerivatives)
#define fmi3GetEventIndicators fmi3FullName(fmi3GetEventIndicators)
#define fmi3GetContinuousStates fmi3FullName(fmi3GetContinuousStates)
#define fmi3GetNominalsOfContinuousStates fmi3FullName(fmi3GetNominalsOfContinuousStates)
#define fmi3GetNumberOfEventIndicators fmi3FullName(fmi3GetNumberOfEventIndicators)
#define fmi3GetNumberOfContinuousStates fmi3FullName(fmi3GetNumberOfContinuousStates)
#define fmi3EnterStepMode fmi3FullName(fmi3EnterStepMode)
#define fmi3GetOutputDerivatives fmi3FullName(fmi3GetOutputDerivatives)
#define fmi3DoStep fmi3FullName(fmi3DoStep)
#define fmi3ActivateModelPartition fmi3FullName(fmi3ActivateModelPartition)

#define fmi3Declare(name) FMI3_Export fmi3##name##TYPE fmi3##name;
fmi3Declare(GetVersion) fmi3Declare(SetDebugLogging) fmi3Declare(InstantiateModelExchange)
fmi3Declare(InstantiateCoSimulation) fmi3Declare(InstantiateScheduledExecution) fmi3Declare(FreeInstance)
fmi3Declare(EnterInitializationMode) fmi3Declare(ExitInitializationMode) fmi3Declare(EnterEventMode)
fmi3Declare(Terminate) fmi3Declare(Reset) fmi3Declare(EnterConfigurationMode) fmi3Declare(ExitConfigurationMode)
fmi3Declare(GetFloat32) fmi3Declare(GetFloat64) fmi3Declare(GetInt8) fmi3Declare(GetUInt8) fmi3Declare(GetInt16)
fmi3Declare(GetUInt16) fmi3Declare(GetInt32) fmi3Declare(GetUInt32) fmi3Declare(GetInt64) fmi3Declare(GetUInt64)
fmi3Declare(GetBoolean) fmi3Declare(GetString) fmi3Declare(GetBinary) fmi3Declare(GetClock) fmi3Declare(SetFloat32)
fmi3Declare(SetFloat64) fmi3Declare(SetInt8) fmi3Declare(SetUInt8) fmi3Declare(SetInt16) fmi3Declare(SetUInt16)
fmi3Declare(SetInt32) fmi3Declare(SetUInt32) fmi3Declare(SetInt64) fmi3Declare(SetUInt64) fmi3Declare(SetBoolean)
fmi3Declare(SetString) fmi3Declare(SetBinary) fmi3Declare(SetClock) fmi3Declare(GetNumberOfVariableDependencies)
fmi3Declare(GetVariableDependencies) fmi3Declare(GetFMUState) fmi3Declare(SetFMUState) fmi3Declare(FreeFMUState)
fmi3Declare(SerializedFMUStateSize) fmi3Declare(SerializeFMUState) fmi3Declare(DeserializeFMUState)
fmi3Declare(GetDirectionalDerivative) fmi3Declare(GetAdjointDerivative) fmi3Declare(GetIntervalDecimal)
fmi3Declare(GetIntervalFraction) fmi3Declare(GetShiftDecimal) fmi3Declare(GetShiftFraction)
fmi3Declare(SetIntervalDecimal) fmi3Declare(SetIntervalFraction) fmi3Declare(SetShiftDecimal)
fmi3Declare(SetShiftFraction) fmi3Declare(EvaluateDiscreteStates) fmi3Declare(UpdateDiscreteStates)
fmi3Declare(EnterContinuousTimeMode) fmi3Declare(CompletedIntegratorStep) fmi3Declare(SetTime)
fmi3Declare(SetContinuousStates) fmi3Declare(GetContinuousStateDerivatives) fmi3Declare(GetEventIndicators)
fmi3Declare(GetContinuousStates) fmi3Declare(GetNominalsOfContinuousStates) fmi3Declare(GetNumberOfEventIndicators)
fmi3Declare(GetNumberOfContinuousStates) fmi3Declare(EnterStepMode) fmi3Declare(GetOutputDerivatives)
fmi3Declare(DoStep) fmi3Declare(ActivateModelPartition)

#ifdef __cplusplus
}
#endif

#endif
