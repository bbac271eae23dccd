#include "framework/models/fmu/instance/functions_3.hpp"

namespace twinmap::fmi {
namespace {

#define TWINMAP_FMI3_ACCESS(type) \
  { library.find<fmi3Get##type##TYPE>("fmi3Get" #type), library.find<fmi3Set##type##TYPE>("fmi3Set" #type) }

}  // namespace

Functions3::Functions3(const SharedLibrary& library, Kind kind)
    : getVersion(library.require<fmi3GetVersionTYPE>("fmi3GetVersion")),
      setDebugLogging(library.find<fmi3SetDebugLoggingTYPE>("fmi3SetDebugLogging")),
      freeInstance(library.require<fmi3FreeInstanceTYPE>("fmi3FreeInstance")),
      enterInitializationMode(
          library.require<fmi3EnterInitializationModeTYPE>("fmi3EnterInitializationMode")),
      exitInitializationMode(library.require<fmi3ExitInitializationModeTYPE>("fmi3ExitInitializationMode")),
      terminate(library.require<fmi3TerminateTYPE>("fmi3Terminate")),
      reset(library.find<fmi3ResetTYPE>("fmi3Reset")),
      float32 TWINMAP_FMI3_ACCESS(Float32),
      float64 TWINMAP_FMI3_ACCESS(Float64),
      int8 TWINMAP_FMI3_ACCESS(Int8),
      uint8 TWINMAP_FMI3_ACCESS(UInt8),
      int16 TWINMAP_FMI3_ACCESS(Int16),
      uint16 TWINMAP_FMI3_ACCESS(UInt16),
      int32 TWINMAP_FMI3_ACCESS(Int32),
      uint32 TWINMAP_FMI3_ACCESS(UInt32),
      int64 TWINMAP_FMI3_ACCESS(Int64),
      uint64 TWINMAP_FMI3_ACCESS(UInt64),
      boolean TWINMAP_FMI3_ACCESS(Boolean) {
  if (kind == Kind::kCoSimulation) {
    instantiateCoSimulation = library.require<fmi3InstantiateCoSimulationTYPE>("fmi3InstantiateCoSimulation");
    doStep = library.require<fmi3DoStepTYPE>("fmi3DoStep");
    enterEventMode = library.find<fmi3EnterEventModeTYPE>("fmi3EnterEventMode");
    updateDiscreteStates = library.find<fmi3UpdateDiscreteStatesTYPE>("fmi3UpdateDiscreteStates");
    enterStepMode = library.find<fmi3EnterStepModeTYPE>("fmi3EnterStepMode");
    return;
  }
  instantiateModelExchange =
      library.require<fmi3InstantiateModelExchangeTYPE>("fmi3InstantiateModelExchange");
  enterEventMode = library.require<fmi3EnterEventModeTYPE>("fmi3EnterEventMode");
  updateDiscreteStates = library.require<fmi3UpdateDiscreteStatesTYPE>("fmi3UpdateDiscreteStates");
  enterContinuousTimeMode = library.require<fmi3EnterContinuousTimeModeTYPE>("fmi3EnterContinuousTimeMode");
  completedIntegratorStep = library.require<fmi3CompletedIntegratorStepTYPE>("fmi3CompletedIntegratorStep");
  setTime = library.require<fmi3SetTimeTYPE>("fmi3SetTime");
  setContinuousStates = library.require<fmi3SetContinuousStatesTYPE>("fmi3SetContinuousStates");
  getDerivatives =
      library.require<fmi3GetContinuousStateDerivativesTYPE>("fmi3GetContinuousStateDerivatives");
  getEventIndicators = library.require<fmi3GetEventIndicatorsTYPE>("fmi3GetEventIndicators");
  getContinuousStates = library.require<fmi3GetContinuousStatesTYPE>("fmi3GetContinuousStates");
  getNominals = library.require<fmi3GetNominalsOfContinuousStatesTYPE>("fmi3GetNominalsOfContinuousStates");
  getDirectionalDerivative = library.find<fmi3GetDirectionalDerivativeTYPE>("fmi3GetDirectionalDerivative");
  getIndicatorCount = library.find<fmi3GetNumberOfEventIndicatorsTYPE>("fmi3GetNumberOfEventIndicators");
  getStateCount = library.find<fmi3GetNumberOfContinuousStatesTYPE>("fmi3GetNumberOfContinuousStates");
}

}  // namespace twinmap::fmi
