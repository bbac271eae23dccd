/* A counter that grows by one each second, by time events; it ends its simulation at 10. */
#include "model.h"

const int model_states = 0, model_indicators = 0;
const double model_step = 0.01;

void model_start(Model* model) { model->integer[0] = 1; }
Status model_initialise(Model* model) {
  model->has_next_event = true;
  model->next_event = 1.0;
  return STATUS_OK;
}
Status model_calc(Model* model) {
  model->real[0] = (double)model->integer[0];
  return STATUS_OK;
}
void model_indicate(const Model* model, double* indicators) { (void)model, (void)indicators; }
void model_event(Model* model) {
  if (model->time >= model->next_event - 1e-10) {
    ++model->integer[0];
    model->next_event += 1.0;
    model->terminate = model->integer[0] >= 11;
  }
}
