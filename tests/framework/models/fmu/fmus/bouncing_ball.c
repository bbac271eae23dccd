/* A ball that falls from `height` and bounces with the restitution e until it rests. */
#include "model.h"

enum { H, V, DH, DV, GRAVITY, RESTITUTION, RESTS };

const int model_states = 2, model_indicators = 1;
const double model_step = 1e-4;

void model_start(Model* model) {
  model->real[H] = 1.0;
  model->real[GRAVITY] = -9.81;
  model->real[RESTITUTION] = 0.7;
}
Status model_initialise(Model* model) {
  (void)model;
  return STATUS_OK;
}
Status model_calc(Model* model) {
  model->real[DH] = model->real[V];
  model->real[DV] = model->real[RESTS] > 0.5 ? 0.0 : model->real[GRAVITY];
  return STATUS_OK;
}
void model_indicate(const Model* model, double* indicators) {
  indicators[0] = model->real[RESTS] > 0.5 ? 1.0 : model->real[H];
}
void model_event(Model* model) {
  double* v = model->real;
  if (v[H] <= 0.0 && v[V] < 0.0) {
    v[H] = 0.0;
    v[V] *= -v[RESTITUTION];
    model->states_changed = true;
    if (v[V] < 1e-3) {
      v[V] = 0.0;
      v[RESTS] = 1.0;
    }
  }
}
