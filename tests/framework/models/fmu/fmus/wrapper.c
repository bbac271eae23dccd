/* FMI 2.0 (-DFMI=2) or 3.0 (-DFMI=3) around a model. The modes of the standard's state machine are enforced, so that a
   test fails where twinmap calls a function in a mode that does not allow it. */
#define _GNU_SOURCE
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model.h"
#if FMI == 2
#include "fmi2Functions.h"
#define NAME(x) fmi2##x
#define TOKEN "{two-2}"
#else
#include "fmi3Functions.h"
#define NAME(x) fmi3##x
#define TOKEN "{two-3}"
#endif

typedef enum { INSTANTIATED = 1, INITIALISING = 2, EVENTS = 4, CONTINUOUS = 8, STEPPING = 16, TERMINATED = 32 } Mode;
enum { ANY = 63 };

typedef struct {
  Model model;
  Mode mode;
  bool co_simulation;
  bool event_mode, early_return; /* of FMI 3.0's co-simulation, as asked for */
  double last_indicators[4];
#if FMI == 2
  const fmi2CallbackFunctions* callbacks;
  double last_time;
#else
  fmi3InstanceEnvironment environment;
  fmi3LogMessageCallback log;
#endif
} Instance;

#define STATUS NAME(Status)
#define ME(c) ((Instance*)(c))

static STATUS report(Instance* own, Status status, const char* message) {
  if (status != STATUS_OK) {
#if FMI == 2
    own->callbacks->logger(own->callbacks->componentEnvironment, "twinmap", (fmi2Status)status, "logStatusError", "%s",
                           message);
#else
    own->log(own->environment, (fmi3Status)status, "logStatusError", message);
#endif
  }
  return (STATUS)status;
}

static bool allowed(Instance* own, int modes, const char* function, STATUS* status) {
  if ((own->mode & modes) != 0) {
    return true;
  }
  char text[128];
  snprintf(text, sizeof text, "%s is not allowed in mode %d", function, (int)own->mode);
  *status = report(own, STATUS_ERROR, text);
  return false;
}

#define REQUIRE(c, modes)                          \
  STATUS refused;                                  \
  if (!allowed(ME(c), modes, __func__, &refused)) { \
    return refused;                                \
  }

#define REQUIRE_FOR(c, condition, modes)                            \
  if (condition) {                                                 \
    STATUS refused_here;                                           \
    if (!allowed(ME(c), modes, __func__, &refused_here)) {         \
      return refused_here;                                         \
    }                                                              \
  }

static STATUS calc(Instance* own) {
  own->model.message = "the model cannot be evaluated";
  const Status status = model_calc(&own->model);
  return report(own, status, own->model.message);
}

static Instance* make(const char* token, bool co_simulation) {
  if (strcmp(token, TOKEN) != 0) {
    return NULL;
  }
  Instance* own = calloc(1, sizeof(Instance));
  own->mode = INSTANTIATED;
  own->co_simulation = co_simulation;
  model_start(&own->model);
  return own;
}

static STATUS initialise(Instance* own) {
  own->model.message = "the initialisation fails";
  const Status status = model_initialise(&own->model);
  if (status != STATUS_OK) {
    return report(own, status, own->model.message);
  }
  const bool steps = own->co_simulation && !own->event_mode;
  own->mode = steps ? STEPPING : EVENTS;
  if (steps) {
    do {
      own->model.again = false;
      model_event(&own->model);
    } while (own->model.again);
    model_indicate(&own->model, own->last_indicators);
  }
  return calc(own);
}

/* One step of the classical Runge-Kutta method. */
static STATUS integrate(Instance* own, double h) {
  Model* model = &own->model;
  const int n = model_states;
  double x[REALS], sum[REALS];
  const double t = model->time, at[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
  memcpy(x, model->real, sizeof x);
  memset(sum, 0, sizeof sum);
  for (int k = 0; k < 4; ++k) {
    for (int i = 0; i < n; ++i) {
      model->real[i] = x[i] + (k == 0 ? 0.0 : h * at[k] * model->real[n + i]);
    }
    model->time = t + h * at[k];
    const STATUS status = calc(own);
    if (status != (STATUS)STATUS_OK) {
      return status;
    }
    for (int i = 0; i < n; ++i) {
      sum[i] += h * weight[k] * model->real[n + i];
    }
  }
  for (int i = 0; i < n; ++i) {
    model->real[i] = x[i] + sum[i];
  }
  model->time = t + h;
  return calc(own);
}

static STATUS handle_events(Instance* own, bool* pending) {
  Model* model = &own->model;
  double indicators[4] = {0};
  model_indicate(model, indicators);
  bool event = model->has_next_event && model->time >= model->next_event - 1e-10;
  for (int i = 0; i < model_indicators; ++i) {
    event = event || (indicators[i] > 0) != (own->last_indicators[i] > 0);
  }
  *pending = event && own->event_mode;
  if (event && !own->event_mode) {
    do {
      model->again = false;
      model_event(model);
    } while (model->again);
    model_indicate(model, indicators);
  }
  memcpy(own->last_indicators, indicators, sizeof indicators);
  return event ? calc(own) : (STATUS)STATUS_OK;
}

/* Steps of at most model_step; stops where the model ends its simulation, and at an event that is pending. */
static STATUS step(Instance* own, double length, bool* pending) {
#ifdef NOISY /* steps that jump with a parameter, as those of an error control do */
  const double own_step = model_step * (20.0 + 10.0 * fmod(98615.0 * own->model.real[4] + 132250.0 * own->model.real[5], 1.0));
#else
  const double own_step = model_step;
#endif
  const long count = lround(ceil(length / own_step - 1e-9));
  for (long i = 0; i < count && !own->model.terminate && !*pending; ++i) {
    STATUS status = integrate(own, length / (double)count);
    if (status == (STATUS)STATUS_OK) {
      status = handle_events(own, pending);
    }
    if (status != (STATUS)STATUS_OK) {
      return status;
    }
  }
  return (STATUS)STATUS_OK;
}

STATUS NAME(Terminate)(void* c) {
  REQUIRE(c, EVENTS | CONTINUOUS | STEPPING);
  ME(c)->mode = TERMINATED;
  return (STATUS)STATUS_OK;
}

STATUS NAME(Reset)(void* c) {
#ifdef NO_RESET
  return report(ME(c), STATUS_ERROR, "this FMU cannot be reset");
#endif
  Model* model = &ME(c)->model;
  char resources[sizeof model->resources];
  memcpy(resources, model->resources, sizeof resources);
  memset(model, 0, sizeof *model);
  memcpy(model->resources, resources, sizeof resources);
  model_start(model);
  ME(c)->mode = INSTANTIATED;
  return (STATUS)STATUS_OK;
}

void NAME(FreeInstance)(void* c) { free(c); }

STATUS NAME(ExitInitializationMode)(void* c) {
  REQUIRE(c, INITIALISING);
  return initialise(ME(c));
}

STATUS NAME(EnterEventMode)(void* c) {
  REQUIRE(c, CONTINUOUS | (ME(c)->event_mode ? STEPPING : 0));
  ME(c)->mode = EVENTS;
  return (STATUS)STATUS_OK;
}

STATUS NAME(EnterContinuousTimeMode)(void* c) {
  REQUIRE(c, EVENTS);
  ME(c)->mode = CONTINUOUS;
  return (STATUS)STATUS_OK;
}

STATUS NAME(SetContinuousStates)(void* c, const double* x, size_t n) {
  REQUIRE(c, CONTINUOUS);
  memcpy(ME(c)->model.real, x, n * sizeof *x);
  return (STATUS)STATUS_OK;
}

STATUS NAME(GetContinuousStates)(void* c, double* x, size_t n) {
  REQUIRE(c, EVENTS | CONTINUOUS);
  memcpy(x, ME(c)->model.real, n * sizeof *x);
  return (STATUS)STATUS_OK;
}

STATUS NAME(GetNominalsOfContinuousStates)(void* c, double* x, size_t n) {
  REQUIRE(c, EVENTS | CONTINUOUS);
  for (size_t i = 0; i < n; ++i) {
    x[i] = 1.0;
  }
  return (STATUS)STATUS_OK;
}

static STATUS get_derivatives(Instance* own, double* dx, size_t n) {
  const STATUS status = calc(own);
  memcpy(dx, own->model.real + model_states, n * sizeof *dx);
  return status;
}

STATUS NAME(GetEventIndicators)(void* c, double* z, size_t n) {
  REQUIRE(c, EVENTS | CONTINUOUS);
  const STATUS status = calc(ME(c));
  double all[4] = {0};
  model_indicate(&ME(c)->model, all);
  memcpy(z, all, n * sizeof *z);
  return status;
}


static STATUS differentiate(Instance* own, const uint32_t* unknowns, size_t n, const uint32_t* knowns, size_t m,
                            const double* seed, double* sensitivity) {
  calc(own);
  for (size_t i = 0; i < n; ++i) {
    sensitivity[i] = 0.0;
    for (size_t j = 0; j < m; ++j) {
      double value = 0.0;
      if (model_differentiate == NULL || !model_differentiate(&own->model, unknowns[i], knowns[j], &value)) {
        return report(own, STATUS_ERROR, "there is no such derivative");
      }
      sensitivity[i] += value * seed[j];
    }
  }
  return (STATUS)STATUS_OK;
}

#if FMI == 2
#include "wrapper_2.inc"
#else
#include "wrapper_3.inc"
#endif
