/* The model of an FMU of FMI 2.0 for Co-Simulation, as a tool would export it: a cart of mass m on a spring c and a
   damper d, with dry friction mu, pushed by the force F. build-fmu makes oscillator.fmu of it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2Functions.h"

enum { X, V, C, D, M, MU, FORCE, X_START, COUNT }; /* value references, as in modelDescription.xml */

typedef struct {
  double value[COUNT];
  double time;
  const fmi2CallbackFunctions* callbacks;
} Cart;

static void set_start_values(Cart* cart) {
  memset(cart->value, 0, sizeof cart->value);
  cart->value[C] = 400.0;
  cart->value[D] = 2.0;
  cart->value[M] = 1.0;
  cart->value[MU] = 0.1;
}

static double calc_acceleration(const Cart* cart, double x, double v) {
  const double* p = cart->value;
  const double friction = p[MU] * tanh(v / 1e-3); /* smooth below 1 mm/s */
  return (p[FORCE] - p[C] * x - p[D] * v - friction) / p[M];
}

/* The classical Runge-Kutta method. */
static void integrate(Cart* cart, double h) {
  double* x = &cart->value[X];
  double* v = &cart->value[V];
  const double v1 = *v, a1 = calc_acceleration(cart, *x, v1);
  const double v2 = *v + 0.5 * h * a1, a2 = calc_acceleration(cart, *x + 0.5 * h * v1, v2);
  const double v3 = *v + 0.5 * h * a2, a3 = calc_acceleration(cart, *x + 0.5 * h * v2, v3);
  const double v4 = *v + h * a3, a4 = calc_acceleration(cart, *x + h * v3, v4);
  *x += h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
  *v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
}

const char* fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }
const char* fmi2GetVersion(void) { return fmi2Version; }

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions* callbacks, fmi2Boolean visible, fmi2Boolean logging) {
  (void)name, (void)guid, (void)resources, (void)visible, (void)logging;
  Cart* cart = type == fmi2CoSimulation ? calloc(1, sizeof(Cart)) : NULL;
  if (cart != NULL) {
    cart->callbacks = callbacks;
    set_start_values(cart);
  }
  return cart;
}

void fmi2FreeInstance(fmi2Component cart) { free(cart); }

fmi2Status fmi2Reset(fmi2Component cart) {
  set_start_values(cart);
  return fmi2OK;
}

fmi2Status fmi2SetupExperiment(fmi2Component cart, fmi2Boolean has_tolerance, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean has_stop, fmi2Real stop) {
  (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
  ((Cart*)cart)->time = start;
  return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component component) {
  Cart* cart = component;
  if (!(cart->value[M] > 0.0)) {
    cart->callbacks->logger(cart->callbacks->componentEnvironment, "cart", fmi2Error, "logStatusError",
                            "the mass m = %g kg must be positive", cart->value[M]);
    return fmi2Error;
  }
  cart->value[X] = cart->value[X_START];
  return fmi2OK;
}
fmi2Status fmi2ExitInitializationMode(fmi2Component cart) { return (void)cart, fmi2OK; }
fmi2Status fmi2Terminate(fmi2Component cart) { return (void)cart, fmi2OK; }
fmi2Status fmi2SetDebugLogging(fmi2Component cart, fmi2Boolean on, size_t n, const fmi2String names[]) {
  return (void)cart, (void)on, (void)n, (void)names, fmi2OK;
}

fmi2Status fmi2GetReal(fmi2Component cart, const fmi2ValueReference references[], size_t n, fmi2Real values[]) {
  for (size_t i = 0; i < n; ++i) {
    values[i] = ((Cart*)cart)->value[references[i]];
  }
  return fmi2OK;
}
fmi2Status fmi2SetReal(fmi2Component cart, const fmi2ValueReference references[], size_t n, const fmi2Real values[]) {
  for (size_t i = 0; i < n; ++i) {
    ((Cart*)cart)->value[references[i]] = values[i];
  }
  return fmi2OK;
}
fmi2Status fmi2GetInteger(fmi2Component cart, const fmi2ValueReference r[], size_t n, fmi2Integer values[]) {
  return (void)cart, (void)r, (void)values, n == 0 ? fmi2OK : fmi2Error;
}
fmi2Status fmi2SetInteger(fmi2Component cart, const fmi2ValueReference r[], size_t n, const fmi2Integer values[]) {
  return (void)cart, (void)r, (void)values, n == 0 ? fmi2OK : fmi2Error;
}
fmi2Status fmi2GetBoolean(fmi2Component cart, const fmi2ValueReference r[], size_t n, fmi2Boolean values[]) {
  return (void)cart, (void)r, (void)values, n == 0 ? fmi2OK : fmi2Error;
}
fmi2Status fmi2SetBoolean(fmi2Component cart, const fmi2ValueReference r[], size_t n, const fmi2Boolean values[]) {
  return (void)cart, (void)r, (void)values, n == 0 ? fmi2OK : fmi2Error;
}

fmi2Status fmi2DoStep(fmi2Component component, fmi2Real t, fmi2Real h, fmi2Boolean no_set_state) {
  (void)t, (void)no_set_state;
  const double longest = 2e-4; /* s; the friction's width of 1 mm/s asks for it */
  Cart* cart = component;
  const int count = (int)ceil(h / longest - 1e-9);
  for (int i = 0; i < count; ++i) {
    integrate(cart, h / count);
  }
  cart->time += h;
  return fmi2OK;
}
fmi2Status fmi2CancelStep(fmi2Component cart) { return (void)cart, fmi2Error; }
