#include "framework/models/fmu/instance/functions_2.hpp"

namespace twinmap::fmi {

Functions2::Functions2(const SharedLibrary& library, Kind kind)
    : getVersion(library.require<fmi2GetVersionTYPE>("fmi2GetVersion")),
      setDebugLogging(library.find<fmi2SetDebugLoggingTYPE>("fmi2SetDebugLogging")),
      instantiate(library.require<fmi2InstantiateTYPE>("fmi2Instantiate")),
      freeInstance(library.require<fmi2FreeInstanceTYPE>("fmi2FreeInstance")),
      setupExperiment(library.require<fmi2SetupExperimentTYPE>("fmi2SetupExperiment")),
      enterInitializationMode(
          library.require<fmi2EnterInitializationModeTYPE>("fmi2EnterInitializationMode")),
      exitInitializationMode(library.require<fmi2ExitInitializationModeTYPE>("fmi2ExitInitializationMode")),
      terminate(library.require<fmi2TerminateTYPE>("fmi2Terminate")),
      reset(library.find<fmi2ResetTYPE>("fmi2Reset")),
      getReal(library.require<fmi2GetRealTYPE>("fmi2GetReal")),
      getInteger(library.require<fmi2GetIntegerTYPE>("fmi2GetInteger")),
      getBoolean(library.require<fmi2GetBooleanTYPE>("fmi2GetBoolean")),
      setReal(library.require<fmi2SetRealTYPE>("fmi2SetReal")),
      setInteger(library.require<fmi2SetIntegerTYPE>("fmi2SetInteger")),
      setBoolean(library.require<fmi2SetBooleanTYPE>("fmi2SetBoolean")) {
  if (kind == Kind::kCoSimulation) {
    doStep = library.require<fmi2DoStepTYPE>("fmi2DoStep");
    getRealStatus = library.find<fmi2GetRealStatusTYPE>("fmi2GetRealStatus");
    getBooleanStatus = library.find<fmi2GetBooleanStatusTYPE>("fmi2GetBooleanStatus");
    return;
  }
  enterEventMode = library.require<fmi2EnterEventModeTYPE>("fmi2EnterEventMode");
  newDiscreteStates = library.require<fmi2NewDiscreteStatesTYPE>("fmi2NewDiscreteStates");
  enterContinuousTimeMode = library.require<fmi2EnterContinuousTimeModeTYPE>("fmi2EnterContinuousTimeMode");
  completedIntegratorStep = library.require<fmi2CompletedIntegratorStepTYPE>("fmi2CompletedIntegratorStep");
  setTime = library.require<fmi2SetTimeTYPE>("fmi2SetTime");
  setContinuousStates = library.require<fmi2SetContinuousStatesTYPE>("fmi2SetContinuousStates");
  getDerivatives = library.require<fmi2GetDerivativesTYPE>("fmi2GetDerivatives");
  getEventIndicators = library.require<fmi2GetEventIndicatorsTYPE>("fmi2GetEventIndicators");
  getContinuousStates = library.require<fmi2GetContinuousStatesTYPE>("fmi2GetContinuousStates");
  getNominals = library.require<fmi2GetNominalsOfContinuousStatesTYPE>("fmi2GetNominalsOfContinuousStates");
  getDirectionalDerivative = library.find<fmi2GetDirectionalDerivativeTYPE>("fmi2GetDirectionalDerivative");
}

}  // namespace twinmap::fmi
