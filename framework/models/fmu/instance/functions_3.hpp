#pragma once

#include "framework/models/fmu/headers/fmi3FunctionTypes.h"
#include "framework/models/fmu/instance/shared_library.hpp"
#include "framework/models/fmu/package/model_description.hpp"

namespace twinmap::fmi {

/// The functions of an FMI 3.0 library that twinmap calls; those of the other kind are null, and so may be
/// those that set and read values of a type.
struct Functions3 {
  /// Throws ExperimentError that names a function which the kind demands and the library does not have.
  Functions3(const SharedLibrary& library, Kind kind);

  fmi3GetVersionTYPE* getVersion;
  fmi3SetDebugLoggingTYPE* setDebugLogging;
  fmi3FreeInstanceTYPE* freeInstance;
  fmi3EnterInitializationModeTYPE* enterInitializationMode;
  fmi3ExitInitializationModeTYPE* exitInitializationMode;
  fmi3TerminateTYPE* terminate;
  fmi3ResetTYPE* reset;

  template <class Get, class Set>
  struct Access {
    Get* get;
    Set* set;
  };
  Access<fmi3GetFloat32TYPE, fmi3SetFloat32TYPE> float32;
  Access<fmi3GetFloat64TYPE, fmi3SetFloat64TYPE> float64;
  Access<fmi3GetInt8TYPE, fmi3SetInt8TYPE> int8;
  Access<fmi3GetUInt8TYPE, fmi3SetUInt8TYPE> uint8;
  Access<fmi3GetInt16TYPE, fmi3SetInt16TYPE> int16;
  Access<fmi3GetUInt16TYPE, fmi3SetUInt16TYPE> uint16;
  Access<fmi3GetInt32TYPE, fmi3SetInt32TYPE> int32;
  Access<fmi3GetUInt32TYPE, fmi3SetUInt32TYPE> uint32;
  Access<fmi3GetInt64TYPE, fmi3SetInt64TYPE> int64;
  Access<fmi3GetUInt64TYPE, fmi3SetUInt64TYPE> uint64;
  Access<fmi3GetBooleanTYPE, fmi3SetBooleanTYPE> boolean;

  fmi3InstantiateModelExchangeTYPE* instantiateModelExchange = nullptr;
  fmi3EnterEventModeTYPE* enterEventMode = nullptr;
  fmi3UpdateDiscreteStatesTYPE* updateDiscreteStates = nullptr;
  fmi3EnterContinuousTimeModeTYPE* enterContinuousTimeMode = nullptr;
  fmi3CompletedIntegratorStepTYPE* completedIntegratorStep = nullptr;
  fmi3SetTimeTYPE* setTime = nullptr;
  fmi3SetContinuousStatesTYPE* setContinuousStates = nullptr;
  fmi3GetContinuousStateDerivativesTYPE* getDerivatives = nullptr;
  fmi3GetEventIndicatorsTYPE* getEventIndicators = nullptr;
  fmi3GetContinuousStatesTYPE* getContinuousStates = nullptr;
  fmi3GetNominalsOfContinuousStatesTYPE* getNominals = nullptr;
  fmi3GetDirectionalDerivativeTYPE* getDirectionalDerivative = nullptr;
  fmi3GetNumberOfEventIndicatorsTYPE* getIndicatorCount = nullptr;
  fmi3GetNumberOfContinuousStatesTYPE* getStateCount = nullptr;

  fmi3InstantiateCoSimulationTYPE* instantiateCoSimulation = nullptr;
  fmi3DoStepTYPE* doStep = nullptr;
  fmi3EnterStepModeTYPE* enterStepMode = nullptr;  ///< null: the library has no event mode
};

}  // namespace twinmap::fmi
