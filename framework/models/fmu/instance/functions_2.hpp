#pragma once

#include "framework/models/fmu/headers/fmi2FunctionTypes.h"
#include "framework/models/fmu/instance/shared_library.hpp"
#include "framework/models/fmu/package/model_description.hpp"

namespace twinmap::fmi {

/// The functions of an FMI 2.0 library that twinmap calls; those of the other kind are null.
struct Functions2 {
  /// Throws ExperimentError that names a function which the kind demands and the library does not have.
  Functions2(const SharedLibrary& library, Kind kind);

  fmi2GetVersionTYPE* getVersion;
  fmi2SetDebugLoggingTYPE* setDebugLogging;
  fmi2InstantiateTYPE* instantiate;
  fmi2FreeInstanceTYPE* freeInstance;
  fmi2SetupExperimentTYPE* setupExperiment;
  fmi2EnterInitializationModeTYPE* enterInitializationMode;
  fmi2ExitInitializationModeTYPE* exitInitializationMode;
  fmi2TerminateTYPE* terminate;
  fmi2ResetTYPE* reset;
  fmi2GetRealTYPE* getReal;
  fmi2GetIntegerTYPE* getInteger;
  fmi2GetBooleanTYPE* getBoolean;
  fmi2SetRealTYPE* setReal;
  fmi2SetIntegerTYPE* setInteger;
  fmi2SetBooleanTYPE* setBoolean;

  fmi2EnterEventModeTYPE* enterEventMode = nullptr;
  fmi2NewDiscreteStatesTYPE* newDiscreteStates = nullptr;
  fmi2EnterContinuousTimeModeTYPE* enterContinuousTimeMode = nullptr;
  fmi2CompletedIntegratorStepTYPE* completedIntegratorStep = nullptr;
  fmi2SetTimeTYPE* setTime = nullptr;
  fmi2SetContinuousStatesTYPE* setContinuousStates = nullptr;
  fmi2GetDerivativesTYPE* getDerivatives = nullptr;
  fmi2GetEventIndicatorsTYPE* getEventIndicators = nullptr;
  fmi2GetContinuousStatesTYPE* getContinuousStates = nullptr;
  fmi2GetDirectionalDerivativeTYPE* getDirectionalDerivative = nullptr;
  fmi2GetNominalsOfContinuousStatesTYPE* getNominals = nullptr;

  fmi2DoStepTYPE* doStep = nullptr;
  fmi2GetRealStatusTYPE* getRealStatus = nullptr;
  fmi2GetBooleanStatusTYPE* getBooleanStatus = nullptr;
};

}  // namespace twinmap::fmi
