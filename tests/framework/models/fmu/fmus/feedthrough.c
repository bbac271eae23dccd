/* Outputs are inputs or parameters of every type; none has a state. */
#include "model.h"

const int model_states = 0, model_indicators = 0;
const double model_step = 0.01;

void model_start(Model* model) {
  model->real[2] = 2.0;  /* a parameter */
  model->integer[4] = 1; /* an enumeration */
  for (int i = 0; i < ELEMENTS; ++i) {
    model->array_in[i] = i + 1;
  }
}
Status model_initialise(Model* model) {
  (void)model;
  return STATUS_OK;
}
Status model_calc(Model* model) {
  model->real[1] = model->real[0]; /* continuous input */
  model->real[3] = model->real[2];
  model->real[5] = model->real[4]; /* discrete input */
  for (int i = 0; i < 4; ++i) {
    model->integer[2 * (i / 2) + 1] = model->integer[2 * (i / 2)];
  }
  model->integer[5] = model->integer[4];
  model->boolean[1] = model->boolean[0];
  model->single[1] = model->single[0];
  for (int i = 0; i < ELEMENTS; ++i) {
    model->array_out[i] = 10.0 * model->array_in[i];
  }
  return STATUS_OK;
}
void model_indicate(const Model* model, double* indicators) { (void)model, (void)indicators; }
void model_event(Model* model) { (void)model; }
bool model_is_discrete(uint32_t reference) { return reference == 4; }
