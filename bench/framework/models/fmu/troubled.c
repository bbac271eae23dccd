/* x = 1 + a t that crashes for 1 % of the samples, hangs for 0.1 %, gives NaN for 1 % and leaks 100 kB a sample, as
   bench/framework/models/external/troubled.py does; or takes `work` seconds of processor time and waits `wait` seconds. With wrapper.c of
   the tests. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "model.h"

enum { X, DX, A, WORK, TROUBLE, WAIT };

const int model_states = 1, model_indicators = 0;
const double model_step = 0.1;

static void* volatile leaked; /* else the compiler would leave the leak out */

static void work(double seconds) {
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  const double end = (double)now.tv_sec + 1e-9 * (double)now.tv_nsec + seconds;
  do {
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  } while ((double)now.tv_sec + 1e-9 * (double)now.tv_nsec < end);
}

void model_start(Model* model) { model->real[X] = 1.0; }
Status model_initialise(Model* model) {
  work(model->real[WORK]);
  usleep((useconds_t)(1e6 * model->real[WAIT]));
  if (model->real[TROUBLE] > 0.5) {
    leaked = malloc(100000);
    memset(leaked, 1, 100000);
    const double fate = fmod(model->real[A] * 1e6, 1000.0);
    if (fate < 10.0) {
      abort();
    }
    while (fate < 11.0) {
      sleep(1);
    }
    if (fate < 21.0) {
      model->real[X] = NAN;
    }
  }
  return STATUS_OK;
}
Status model_calc(Model* model) {
  model->real[DX] = model->real[A];
  return STATUS_OK;
}
void model_indicate(const Model* model, double* indicators) { (void)model, (void)indicators; }
void model_event(Model* model) { (void)model; }
