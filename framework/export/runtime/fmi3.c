/* FMI 3.0, Co-Simulation. */
#include "fmi3Functions.h"
#include "fmu.h"

#include <stdlib.h>
#include <string.h>

static const char token[] = "@TOKEN@";

const char *fmi3GetVersion(void) { return fmi3Version; }

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String given, fmi3String resources, fmi3Boolean visible,
                                         fmi3Boolean logging, fmi3Boolean events, fmi3Boolean early,
                                         const fmi3ValueReference required[], size_t count,
                                         fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
                                         fmi3IntermediateUpdateCallback update)
{
  fmu_block *block;
  (void)name, (void)resources, (void)visible, (void)logging, (void)events, (void)early, (void)required;
  (void)count, (void)environment, (void)log, (void)update;
  if (given == NULL || strcmp(given, token) != 0) {
    return NULL;
  }
  block = malloc(sizeof *block);
  if (block != NULL) {
    fmu_reset(block);
  }
  return block;
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String given, fmi3String resources,
                                          fmi3Boolean visible, fmi3Boolean logging,
                                          fmi3InstanceEnvironment environment, fmi3LogMessageCallback log)
{
  (void)name, (void)given, (void)resources, (void)visible, (void)logging, (void)environment, (void)log;
  return NULL;
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String given, fmi3String resources,
                                               fmi3Boolean visible, fmi3Boolean logging,
                                               fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
                                               fmi3ClockUpdateCallback update, fmi3LockPreemptionCallback lock,
                                               fmi3UnlockPreemptionCallback unlock)
{
  (void)name, (void)given, (void)resources, (void)visible, (void)logging, (void)environment, (void)log;
  (void)update, (void)lock, (void)unlock;
  return NULL;
}

void fmi3FreeInstance(fmi3Instance c) { free(c); }

fmi3Status fmi3Reset(fmi3Instance c)
{
  fmu_reset(c);
  return fmi3OK;
}

#define ANSWER(status, name, arguments, ...) \
  fmi3Status name arguments \
  { \
    __VA_ARGS__; \
    return status; \
  }
#define DO_NOTHING(name, arguments, ...) ANSWER(fmi3OK, name, arguments, __VA_ARGS__)
#define REFUSE(name, arguments, ...) ANSWER(fmi3Error, name, arguments, __VA_ARGS__)
DO_NOTHING(fmi3SetDebugLogging, (fmi3Instance c, fmi3Boolean on, size_t n, const fmi3String s[]),
           (void)c, (void)on, (void)n, (void)s)
DO_NOTHING(fmi3EnterInitializationMode, (fmi3Instance c, fmi3Boolean defined, fmi3Float64 tolerance,
                                         fmi3Float64 start, fmi3Boolean stops, fmi3Float64 stop),
           (void)c, (void)defined, (void)tolerance, (void)start, (void)stops, (void)stop)
DO_NOTHING(fmi3ExitInitializationMode, (fmi3Instance c), (void)c)
DO_NOTHING(fmi3Terminate, (fmi3Instance c), (void)c)
DO_NOTHING(fmi3EnterConfigurationMode, (fmi3Instance c), (void)c)
DO_NOTHING(fmi3ExitConfigurationMode, (fmi3Instance c), (void)c)
DO_NOTHING(fmi3EnterStepMode, (fmi3Instance c), (void)c)
DO_NOTHING(fmi3EvaluateDiscreteStates, (fmi3Instance c), (void)c)
REFUSE(fmi3EnterEventMode, (fmi3Instance c), (void)c)
REFUSE(fmi3EnterContinuousTimeMode, (fmi3Instance c), (void)c)

/* One value after another. */
#define GET(name, type, from, call) \
  fmi3Status name(fmi3Instance c, const fmi3ValueReference r[], size_t count, type v[], size_t values) \
  { \
    size_t i; \
    for (i = 0; i < count && i < values; ++i) { \
      from value; \
      if (!call(c, r[i], &value)) { \
        return fmi3Error; \
      } \
      v[i] = (type)value; \
    } \
    return fmi3OK; \
  }
#define SET(name, type, call) \
  fmi3Status name(fmi3Instance c, const fmi3ValueReference r[], size_t count, const type v[], size_t values) \
  { \
    size_t i; \
    for (i = 0; i < count && i < values; ++i) { \
      if (!call(c, r[i], v[i])) { \
        return fmi3Error; \
      } \
    } \
    return fmi3OK; \
  }
GET(fmi3GetFloat64, fmi3Float64, double, fmu_get_real)
GET(fmi3GetInt32, fmi3Int32, int, fmu_get_integer)
GET(fmi3GetInt64, fmi3Int64, int, fmu_get_integer)
GET(fmi3GetBoolean, fmi3Boolean, int, fmu_get_boolean)
SET(fmi3SetFloat64, fmi3Float64, fmu_set_real)
SET(fmi3SetBoolean, fmi3Boolean, fmu_set_boolean)

#define VALUES(name, type) \
  REFUSE(name, (fmi3Instance c, const fmi3ValueReference r[], size_t n, type v[], size_t m), \
         (void)c, (void)r, (void)n, (void)v, (void)m)
VALUES(fmi3GetFloat32, fmi3Float32)
VALUES(fmi3GetInt8, fmi3Int8)
VALUES(fmi3GetUInt8, fmi3UInt8)
VALUES(fmi3GetInt16, fmi3Int16)
VALUES(fmi3GetUInt16, fmi3UInt16)
VALUES(fmi3GetUInt32, fmi3UInt32)
VALUES(fmi3GetUInt64, fmi3UInt64)
VALUES(fmi3GetString, fmi3String)
VALUES(fmi3SetFloat32, const fmi3Float32)
VALUES(fmi3SetInt8, const fmi3Int8)
VALUES(fmi3SetUInt8, const fmi3UInt8)
VALUES(fmi3SetInt16, const fmi3Int16)
VALUES(fmi3SetUInt16, const fmi3UInt16)
VALUES(fmi3SetInt32, const fmi3Int32)
VALUES(fmi3SetUInt32, const fmi3UInt32)
VALUES(fmi3SetInt64, const fmi3Int64)
VALUES(fmi3SetUInt64, const fmi3UInt64)
VALUES(fmi3SetString, const fmi3String)
REFUSE(fmi3GetBinary, (fmi3Instance c, const fmi3ValueReference r[], size_t n, size_t s[], fmi3Binary v[], size_t m),
       (void)c, (void)r, (void)n, (void)s, (void)v, (void)m)
REFUSE(fmi3SetBinary,
       (fmi3Instance c, const fmi3ValueReference r[], size_t n, const size_t s[], const fmi3Binary v[], size_t m),
       (void)c, (void)r, (void)n, (void)s, (void)v, (void)m)
REFUSE(fmi3GetClock, (fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3Clock v[]),
       (void)c, (void)r, (void)n, (void)v)
REFUSE(fmi3SetClock, (fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3Clock v[]),
       (void)c, (void)r, (void)n, (void)v)
REFUSE(fmi3GetNumberOfVariableDependencies, (fmi3Instance c, fmi3ValueReference r, size_t *n),
       (void)c, (void)r, (void)n)
REFUSE(fmi3GetVariableDependencies,
       (fmi3Instance c, fmi3ValueReference r, size_t a[], fmi3ValueReference b[], size_t d[],
        fmi3DependencyKind k[], size_t n),
       (void)c, (void)r, (void)a, (void)b, (void)d, (void)k, (void)n)
REFUSE(fmi3GetFMUState, (fmi3Instance c, fmi3FMUState *s), (void)c, (void)s)
REFUSE(fmi3SetFMUState, (fmi3Instance c, fmi3FMUState s), (void)c, (void)s)
REFUSE(fmi3FreeFMUState, (fmi3Instance c, fmi3FMUState *s), (void)c, (void)s)
REFUSE(fmi3SerializedFMUStateSize, (fmi3Instance c, fmi3FMUState s, size_t *n), (void)c, (void)s, (void)n)
REFUSE(fmi3SerializeFMUState, (fmi3Instance c, fmi3FMUState s, fmi3Byte b[], size_t n),
       (void)c, (void)s, (void)b, (void)n)
REFUSE(fmi3DeserializeFMUState, (fmi3Instance c, const fmi3Byte b[], size_t n, fmi3FMUState *s),
       (void)c, (void)s, (void)b, (void)n)
#define DERIVATIVE(name) \
  REFUSE(name, \
         (fmi3Instance c, const fmi3ValueReference u[], size_t nu, const fmi3ValueReference k[], size_t nk, \
          const fmi3Float64 s[], size_t ns, fmi3Float64 v[], size_t nv), \
         (void)c, (void)u, (void)nu, (void)k, (void)nk, (void)s, (void)ns, (void)v, (void)nv)
DERIVATIVE(fmi3GetDirectionalDerivative)
DERIVATIVE(fmi3GetAdjointDerivative)
REFUSE(fmi3GetIntervalDecimal,
       (fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3Float64 v[], fmi3IntervalQualifier q[]),
       (void)c, (void)r, (void)n, (void)v, (void)q)
REFUSE(fmi3GetIntervalFraction,
       (fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3UInt64 a[], fmi3UInt64 b[],
        fmi3IntervalQualifier q[]),
       (void)c, (void)r, (void)n, (void)a, (void)b, (void)q)
REFUSE(fmi3GetShiftDecimal, (fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3Float64 v[]),
       (void)c, (void)r, (void)n, (void)v)
REFUSE(fmi3GetShiftFraction,
       (fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3UInt64 a[], fmi3UInt64 b[]),
       (void)c, (void)r, (void)n, (void)a, (void)b)
REFUSE(fmi3SetIntervalDecimal, (fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3Float64 v[]),
       (void)c, (void)r, (void)n, (void)v)
REFUSE(fmi3SetIntervalFraction,
       (fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3UInt64 a[], const fmi3UInt64 b[]),
       (void)c, (void)r, (void)n, (void)a, (void)b)
REFUSE(fmi3SetShiftDecimal, (fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3Float64 v[]),
       (void)c, (void)r, (void)n, (void)v)
REFUSE(fmi3SetShiftFraction,
       (fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3UInt64 a[], const fmi3UInt64 b[]),
       (void)c, (void)r, (void)n, (void)a, (void)b)
REFUSE(fmi3CompletedIntegratorStep,
       (fmi3Instance c, fmi3Boolean kept, fmi3Boolean *event, fmi3Boolean *ends),
       (void)c, (void)kept, (void)event, (void)ends)
REFUSE(fmi3SetTime, (fmi3Instance c, fmi3Float64 t), (void)c, (void)t)
REFUSE(fmi3SetContinuousStates, (fmi3Instance c, const fmi3Float64 v[], size_t n), (void)c, (void)v, (void)n)
#define NUMBERS(name) REFUSE(name, (fmi3Instance c, fmi3Float64 v[], size_t n), (void)c, (void)v, (void)n)
NUMBERS(fmi3GetContinuousStateDerivatives)
NUMBERS(fmi3GetEventIndicators)
NUMBERS(fmi3GetContinuousStates)
NUMBERS(fmi3GetNominalsOfContinuousStates)
REFUSE(fmi3GetNumberOfEventIndicators, (fmi3Instance c, size_t *n), (void)c, (void)n)
REFUSE(fmi3GetNumberOfContinuousStates, (fmi3Instance c, size_t *n), (void)c, (void)n)
REFUSE(fmi3GetOutputDerivatives,
       (fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3Int32 o[], fmi3Float64 v[], size_t m),
       (void)c, (void)r, (void)n, (void)o, (void)v, (void)m)
REFUSE(fmi3ActivateModelPartition, (fmi3Instance c, fmi3ValueReference r, fmi3Float64 t), (void)c, (void)r, (void)t)

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean *again, fmi3Boolean *ends, fmi3Boolean *nominals,
                                    fmi3Boolean *values, fmi3Boolean *defined, fmi3Float64 *next)
{
  (void)c, (void)next;
  *again = *ends = *nominals = *values = *defined = fmi3False;
  return fmi3OK;
}

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 step, fmi3Boolean kept, fmi3Boolean *event,
                      fmi3Boolean *ends, fmi3Boolean *early, fmi3Float64 *last)
{
  (void)kept;
  fmu_sample(c, time);
  *event = *ends = *early = fmi3False;
  *last = time + step;
  return fmi3OK;
}
