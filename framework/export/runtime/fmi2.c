/* FMI 2.0, Co-Simulation. */
#include "fmi2Functions.h"
#include "fmu.h"

#include <stdlib.h>
#include <string.h>

static const char token[] = "@TOKEN@";

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }
const char *fmi2GetVersion(void) { return fmi2Version; }

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging)
{
  fmu_block *block;
  (void)name, (void)resources, (void)functions, (void)visible, (void)logging;
  if (type != fmi2CoSimulation || guid == NULL || strcmp(guid, token) != 0) {
    return NULL;
  }
  block = malloc(sizeof *block);
  if (block != NULL) {
    fmu_reset(block);
  }
  return block;
}

void fmi2FreeInstance(fmi2Component c) { free(c); }

fmi2Status fmi2Reset(fmi2Component c)
{
  fmu_reset(c);
  return fmi2OK;
}

#define DO_NOTHING(name, arguments, ...) \
  fmi2Status name arguments \
  { \
    __VA_ARGS__; \
    return fmi2OK; \
  }
DO_NOTHING(fmi2SetDebugLogging, (fmi2Component c, fmi2Boolean on, size_t n, const fmi2String s[]),
           (void)c, (void)on, (void)n, (void)s)
DO_NOTHING(fmi2SetupExperiment, (fmi2Component c, fmi2Boolean defined, fmi2Real tolerance, fmi2Real start,
                                 fmi2Boolean stops, fmi2Real stop),
           (void)c, (void)defined, (void)tolerance, (void)start, (void)stops, (void)stop)
DO_NOTHING(fmi2EnterInitializationMode, (fmi2Component c), (void)c)
DO_NOTHING(fmi2ExitInitializationMode, (fmi2Component c), (void)c)
DO_NOTHING(fmi2Terminate, (fmi2Component c), (void)c)

/* One value after another. */
#define ACCESS(name, type, constant, call) \
  fmi2Status name(fmi2Component c, const fmi2ValueReference r[], size_t count, constant type v[]) \
  { \
    size_t i; \
    for (i = 0; i < count; ++i) { \
      if (!call) { \
        return fmi2Error; \
      } \
    } \
    return fmi2OK; \
  }
ACCESS(fmi2GetReal, fmi2Real, , fmu_get_real(c, r[i], &v[i]))
ACCESS(fmi2SetReal, fmi2Real, const, fmu_set_real(c, r[i], v[i]))
ACCESS(fmi2GetInteger, fmi2Integer, , fmu_get_integer(c, r[i], &v[i]))
ACCESS(fmi2GetBoolean, fmi2Boolean, , fmu_get_boolean(c, r[i], &v[i]))
ACCESS(fmi2SetBoolean, fmi2Boolean, const, fmu_set_boolean(c, r[i], v[i]))

#define REFUSE(name, arguments, ...) \
  fmi2Status name arguments \
  { \
    __VA_ARGS__; \
    return fmi2Error; \
  }
#define VALUES(name, type) \
  REFUSE(name, (fmi2Component c, const fmi2ValueReference r[], size_t n, type v[]), (void)c, (void)r, (void)n, (void)v)
VALUES(fmi2SetInteger, const fmi2Integer)
VALUES(fmi2GetString, fmi2String)
VALUES(fmi2SetString, const fmi2String)
REFUSE(fmi2GetFMUstate, (fmi2Component c, fmi2FMUstate *s), (void)c, (void)s)
REFUSE(fmi2SetFMUstate, (fmi2Component c, fmi2FMUstate s), (void)c, (void)s)
REFUSE(fmi2FreeFMUstate, (fmi2Component c, fmi2FMUstate *s), (void)c, (void)s)
REFUSE(fmi2SerializedFMUstateSize, (fmi2Component c, fmi2FMUstate s, size_t *n), (void)c, (void)s, (void)n)
REFUSE(fmi2SerializeFMUstate, (fmi2Component c, fmi2FMUstate s, fmi2Byte b[], size_t n),
       (void)c, (void)s, (void)b, (void)n)
REFUSE(fmi2DeSerializeFMUstate, (fmi2Component c, const fmi2Byte b[], size_t n, fmi2FMUstate *s),
       (void)c, (void)s, (void)b, (void)n)
REFUSE(fmi2GetDirectionalDerivative,
       (fmi2Component c, const fmi2ValueReference u[], size_t nu, const fmi2ValueReference k[], size_t nk,
        const fmi2Real dk[], fmi2Real du[]),
       (void)c, (void)u, (void)nu, (void)k, (void)nk, (void)dk, (void)du)
REFUSE(fmi2SetRealInputDerivatives,
       (fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Integer o[], const fmi2Real v[]),
       (void)c, (void)r, (void)n, (void)o, (void)v)
REFUSE(fmi2GetRealOutputDerivatives,
       (fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Integer o[], fmi2Real v[]),
       (void)c, (void)r, (void)n, (void)o, (void)v)
REFUSE(fmi2CancelStep, (fmi2Component c), (void)c)
REFUSE(fmi2GetStatus, (fmi2Component c, const fmi2StatusKind k, fmi2Status *v), (void)c, (void)k, (void)v)
REFUSE(fmi2GetRealStatus, (fmi2Component c, const fmi2StatusKind k, fmi2Real *v), (void)c, (void)k, (void)v)
REFUSE(fmi2GetIntegerStatus, (fmi2Component c, const fmi2StatusKind k, fmi2Integer *v), (void)c, (void)k, (void)v)
REFUSE(fmi2GetBooleanStatus, (fmi2Component c, const fmi2StatusKind k, fmi2Boolean *v), (void)c, (void)k, (void)v)
REFUSE(fmi2GetStringStatus, (fmi2Component c, const fmi2StatusKind k, fmi2String *v), (void)c, (void)k, (void)v)

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean kept)
{
  (void)step, (void)kept;
  fmu_sample(c, time);
  return fmi2OK;
}
