/* Measurements with twinmap's own answers: simulated ones with noise, some of them disturbed so that the statuses
   occur. Prints what differs; the exit code is 0 if nothing does. */
#include "twinmap_map.h"

#include <math.h>
#include <stdio.h>

@TABLES@

static twinmap_state state;
static double worst_mean, worst_sd;

static int check(int i, int p, const char *what, double found, double expected, double tolerance)
{
  if (fabs(found - expected) <= tolerance) {
    return 0;
  }
  printf("measurement %d, %s of %s: %.17g instead of %.17g\n", i, what, twinmap_parameter_names[p], found,
         expected);
  return 1;
}

static int check_answer(int i, const twinmap_result *result)
{
  const double *mean = expected_mean + i * TWINMAP_PARAMETERS, *sd = expected_sd + i * TWINMAP_PARAMETERS;
  int failures = 0, p;
  for (p = 0; p < TWINMAP_PARAMETERS; ++p) {
    failures += check(i, p, "mean", result->mean[p], mean[p], tolerance_stddevs * sd[p] + tolerance_relative * fabs(mean[p]));
    failures += check(i, p, "sd", result->sd[p], sd[p], (tolerance_stddevs + tolerance_relative) * sd[p]);
    worst_mean = fmax(worst_mean, fabs(result->mean[p] - mean[p]) / sd[p]);
    worst_sd = fmax(worst_sd, fabs(result->sd[p] / sd[p] - 1.0));
  }
  if (result->statuses != (unsigned)expected_statuses[i]) {
    printf("measurement %d: %s (%u) instead of %d\n", i, twinmap_status_text(result->status), result->statuses,
           expected_statuses[i]);
    ++failures;
  }
  return failures;
}

static twinmap_error infer(int i, twinmap_result *result)
{
#if TWINMAP_SIGNALS
  const twinmap_real *signals[TWINMAP_SIGNALS];
  int s;
  for (s = 0; s < TWINMAP_SIGNALS; ++s) {
    signals[s] = measured + (i * TWINMAP_SIGNALS + s) * TWINMAP_GRID;
  }
  return twinmap_infer(&state, TWINMAP_GRID, measured_times + time_axis[i] * TWINMAP_GRID, signals, 0.0,
                       known_inputs + i * TWINMAP_KNOWN, result);
#else
  return twinmap_infer_features(&state, measured + i * TWINMAP_FEATURES, known_inputs + i * TWINMAP_KNOWN, result);
#endif
}

#if TWINMAP_SIGNALS
/* A measurement that ends early must be refused. */
static int check_refusal(void)
{
  const twinmap_real *signals[TWINMAP_SIGNALS];
  twinmap_result result;
  twinmap_error error;
  int s;
  for (s = 0; s < TWINMAP_SIGNALS; ++s) {
    signals[s] = measured + s * TWINMAP_GRID;
  }
  error = twinmap_infer(&state, TWINMAP_GRID - 1, measured_times, signals, 0.0, known_inputs, &result);
  if (error == TWINMAP_OK) {
    printf("a measurement that ends early was not refused\n");
    return 1;
  }
  return 0;
}
#endif

int main(void)
{
  int failures = 0, i;
  for (i = 0; i < MEASUREMENTS; ++i) {
    twinmap_result result;
    const twinmap_error error = infer(i, &result);
    if (error != TWINMAP_OK) {
      printf("measurement %d: error %d\n", i, (int)error);
      ++failures;
    } else {
      failures += check_answer(i, &result);
    }
  }
#if TWINMAP_SIGNALS
  failures += check_refusal();
#endif
  printf("%d measurements, %d differences; means within %.2g sd, standard deviations within %.2g\n", MEASUREMENTS,
         failures, worst_mean, worst_sd);
  return failures > 0;
}
