/* x'' = -c x - d x' + F and its directional derivatives; a power as an output that is not a state. */
#include "model.h"

enum { X, V, DX, DV, C, D, F, P };

const int model_states = 2, model_indicators = 0;
const double model_step = 1e-3;

void model_start(Model* model) {
  model->real[X] = 0.1;
  model->real[C] = 40.0;
  model->real[D] = 0.5;
}
Status model_initialise(Model* model) {
  (void)model;
  return STATUS_OK;
}
Status model_calc(Model* model) {
  double* v = model->real;
  v[DX] = v[V];
  v[DV] = -v[C] * v[X] - v[D] * v[V] + v[F];
  v[P] = v[D] * v[V] * v[V];
  return STATUS_OK;
}
void model_indicate(const Model* model, double* indicators) { (void)model, (void)indicators; }
void model_event(Model* model) { (void)model; }

bool model_differentiate(const Model* model, uint32_t unknown, uint32_t known, double* value) {
  const double* v = model->real;
  *value = 0.0;
  if (unknown == DX) {
    *value = known == V ? 1.0 : 0.0;
  } else if (unknown == DV) {
    *value = known == X ? -v[C] : known == V ? -v[D] : known == C ? -v[X] : known == D ? -v[V] : known == F ? 1.0 : 0.0;
#ifdef WRONG_DERIVATIVE
    *value = known == C ? 0.0 : *value; /* as an FMU that does not know its parameters */
#endif
  } else if (unknown == P) {
    *value = known == V ? 2.0 * v[D] * v[V] : known == D ? v[V] * v[V] : 0.0;
  } else {
    return false;
  }
  return known == X || known == V || known == C || known == D || known == F;
}
