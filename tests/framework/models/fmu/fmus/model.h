/* A model of the tests as plain equations. wrapper.c makes an FMU of FMI 2.0 or 3.0 of it, for both kinds. Value
   references: reals from 0, with the states first and their derivatives after them; the others as below. */
#ifndef MODEL_H
#define MODEL_H

#include <stdbool.h>
#include <stdint.h>

enum { REALS = 40, INTEGERS = 8, BOOLEANS = 4, FLOATS = 4, ELEMENTS = 4 };
enum { FIRST_INTEGER = 100, FIRST_BOOLEAN = 200, FIRST_FLOAT = 300, ARRAY_IN = 400, ARRAY_OUT = 401 };

typedef enum { STATUS_OK, STATUS_WARNING, STATUS_DISCARD, STATUS_ERROR, STATUS_FATAL } Status;

typedef struct {
  double time;
  double real[REALS];
  int64_t integer[INTEGERS]; /* Int32, Int64, enumeration, UInt8 ..., by their own references */
  bool boolean[BOOLEANS];
  float single[FLOATS];
  double array_in[ELEMENTS], array_out[ELEMENTS];
  bool has_next_event;
  double next_event;
  bool again, terminate, states_changed; /* of an event */
  const char* message;                   /* logged with a status that is not STATUS_OK */
  char resources[1024];
} Model;

extern const int model_states, model_indicators;
extern const double model_step; /* s, of the solver of the co-simulation */

void model_start(Model*);
Status model_initialise(Model*);
/* Derivatives and outputs from time, states, parameters and inputs. */
Status model_calc(Model*);
void model_indicate(const Model*, double* indicators);
void model_event(Model*);
/* Optional: whether a real may be set at events only. */
bool model_is_discrete(uint32_t reference) __attribute__((weak));
/* Optional: d unknown / d known, of reals; false where the standard does not permit to ask. */
bool model_differentiate(const Model*, uint32_t unknown, uint32_t known, double* value) __attribute__((weak));

#endif
