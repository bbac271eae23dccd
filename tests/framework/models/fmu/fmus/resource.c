/* The output is the number in resources/value.txt. */
#include <stdio.h>
#include <string.h>

#include "model.h"

const int model_states = 0, model_indicators = 0;
const double model_step = 0.01;

void model_start(Model* model) { (void)model; }
Status model_initialise(Model* model) {
  char path[1100];
  snprintf(path, sizeof path, "%svalue.txt", model->resources);
  FILE* file = fopen(path, "r");
  if (file == NULL || fscanf(file, "%lf", &model->real[0]) != 1) {
    model->message = "resources/value.txt cannot be read";
    return STATUS_ERROR;
  }
  fclose(file);
  return STATUS_OK;
}
Status model_calc(Model* model) {
  (void)model;
  return STATUS_OK;
}
void model_indicate(const Model* model, double* indicators) { (void)model, (void)indicators; }
void model_event(Model* model) { (void)model; }
