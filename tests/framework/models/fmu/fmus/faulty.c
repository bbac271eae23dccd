/* x' = -x, that fails in the way that the parameter `fault` asks for once the time is 0.5. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "model.h"

enum { X, DX, FAULT };
enum { NONE, CRASHES, HANGS, IS_NAN, ERROR, FATAL, EXITS, PRINTS, AGES };

const int model_states = 1, model_indicators = 0;
const double model_step = 0.01;

static int simulations; /* of this process */

void model_start(Model* model) { model->real[X] = 1.0; }
Status model_initialise(Model* model) {
  (void)model;
  ++simulations;
  return STATUS_OK;
}
Status model_calc(Model* model) {
  model->real[DX] = -model->real[X];
  if (model->time < 0.5) {
    return STATUS_OK;
  }
  switch ((int)lround(model->real[FAULT])) {
    case CRASHES:
      abort();
    case HANGS:
      for (;;) {
        usleep(1000);
      }
    case IS_NAN:
      model->real[X] = model->real[DX] = NAN;
      return STATUS_OK;
    case ERROR:
      model->message = "the spring is torn";
      return STATUS_ERROR;
    case FATAL:
      model->message = "nothing works any more";
      return STATUS_FATAL;
    case EXITS:
      exit(3);
    case PRINTS:
      puts("what an FMU prints disturbs nobody");
      return STATUS_OK;
    case AGES:
      if (simulations > 1) {
        abort();
      }
      return STATUS_OK;
    default:
      return STATUS_OK;
  }
}
void model_indicate(const Model* model, double* indicators) { (void)model, (void)indicators; }
void model_event(Model* model) { (void)model; }
