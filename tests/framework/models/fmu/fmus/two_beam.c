/* The two connected rigid beams; from the static equilibrium of the values y_start and theta_start. */
#include <math.h>

#include "model.h"

enum { Y, THETA, V, W, DY, DTHETA, DV, DW, D_Y, D_THETA, K_Y, K_THETA, FORCE, MOMENT, Y_START, THETA_START };

const int model_states = 4, model_indicators = 0;
const double model_step = 2e-4; /* an error of 1e-9 of the range */

void model_start(Model* model) {
  double* v = model->real;
  v[D_Y] = 1.0;
  v[D_THETA] = 2e-4;
  v[K_Y] = 10.0;
  v[K_THETA] = 0.036;
}

Status model_initialise(Model* model) {
  model->real[Y] = model->real[Y_START];
  model->real[THETA] = model->real[THETA_START];
  return STATUS_OK;
}

Status model_calc(Model* model) {
  const double m1 = 3.3, m2 = 0.13, y_com = 0.034, z_com = 0.022, inertia = 1.3e-4, g = 9.81;
  double* v = model->real;
  const double c = cos(v[THETA]), s = sin(v[THETA]);
  const double a = y_com * s + z_com * c, b = y_com * c - z_com * s;
  const double m11 = m1 + m2, m12 = -m2 * a, m22 = inertia + m2 * (y_com * y_com + z_com * z_com);
  const double f1 = v[FORCE] + m2 * b * v[W] * v[W] - v[D_Y] * v[V] - v[K_Y] * v[Y];
  const double f2 = v[MOMENT] - v[D_THETA] * v[W] - v[K_THETA] * v[THETA] - m2 * g * b;
  const double determinant = m11 * m22 - m12 * m12;
  v[DY] = v[V];
  v[DTHETA] = v[W];
  v[DV] = (m22 * f1 - m12 * f2) / determinant;
  v[DW] = (m11 * f2 - m12 * f1) / determinant;
  return STATUS_OK;
}

void model_indicate(const Model* model, double* indicators) { (void)model, (void)indicators; }
void model_event(Model* model) { (void)model; }
