/* A life of estimates with what `twinmap track` believes behind each: a step, bad ones, ones that do not update.
   Prints what differs; the exit code is 0 if nothing does. */
#include "twinmap_track.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

@TABLES@

static twinmap_track track;
static twinmap_result result;
static double worst;

/* In half-widths of the bounds and in the value itself. */
static int check(int i, int p, const char *what, double found, double expected, double most)
{
  const double apart = fabs(found - expected) / (half_widths[p] + fabs(expected));
  worst = fmax(worst, apart);
  if (apart <= most) {
    return 0;
  }
  printf("measurement %d, %s of %s: %.17g instead of %.17g\n", i, what, twinmap_parameter_names[p], found,
         expected);
  return 1;
}

static int check_answer(int i, const twinmap_track_answer *answer)
{
  int failures = 0, p;
  for (p = 0; p < TWINMAP_PARAMETERS; ++p) {
    failures += check(i, p, "mean", answer->mean[p], expected_mean[i * TWINMAP_PARAMETERS + p], tolerance);
    failures += check(i, p, "sd", answer->sd[p], expected_sd[i * TWINMAP_PARAMETERS + p], tolerance);
    /* the weights of rates are exponentials of sums */
    failures += check(i, p, "walk", answer->walk[p], expected_walk[i * TWINMAP_PARAMETERS + p], 100.0 * tolerance);
  }
  if ((int)answer->alarm != expected_alarm[i] ||
      (answer->alarm == TWINMAP_TRACK_CHANGE && answer->parameter != expected_parameter[i])) {
    printf("measurement %d: alarm %d of parameter %d instead of %d of %d\n", i, (int)answer->alarm,
           answer->parameter, expected_alarm[i], expected_parameter[i]);
    ++failures;
  }
  return failures;
}

/* In an array of its own, as not a number stands for one that is missing. */
static const double *read_conditions(int i)
{
#if TWINMAP_TRACK_CONDITIONS
  static double conditions[TWINMAP_TRACK_CONDITIONS];
  int c;
  for (c = 0; c < TWINMAP_TRACK_CONDITIONS; ++c) {
    const double value = measured_conditions[i * TWINMAP_TRACK_CONDITIONS + c];
    conditions[c] = value > -1e300 ? value : -HUGE_VAL;
  }
  return conditions;
#else
  (void)i;
  return NULL;
#endif
}

static void read_measurement(int i)
{
  int p, q;
  memset(&result, 0, sizeof result);
  for (p = 0; p < TWINMAP_PARAMETERS; ++p) {
    result.mean[p] = measured_mean[i * TWINMAP_PARAMETERS + p];
    for (q = 0; q < TWINMAP_PARAMETERS; ++q) {
      result.covariance[p * TWINMAP_PARAMETERS + q] =
          measured_covariance[(i * TWINMAP_PARAMETERS + p) * TWINMAP_PARAMETERS + q];
    }
    result.sd[p] = sqrt(result.covariance[p * TWINMAP_PARAMETERS + p]);
  }
  result.statuses = measured_mismatch[i] ? (unsigned)TWINMAP_STATUS_MODEL_MISMATCH : 0u;
}

/* A time that goes back must be refused, and change nothing. */
static int check_refusal(void)
{
  static twinmap_track before;
  twinmap_track_answer answer;
  before = track;
  if (twinmap_track_update(&track, &result, track.time - 1.0, read_conditions(0), &answer) != TWINMAP_TRACK_ERROR_TIME ||
      memcmp(&before, &track, sizeof track) != 0) {
    printf("a time that goes back was not refused\n");
    return 1;
  }
  return 0;
}

int main(void)
{
  int failures = 0, i;
  twinmap_track_begin(&track);
  for (i = 0; i < MEASUREMENTS; ++i) {
    twinmap_track_answer answer;
    read_measurement(i);
    if (twinmap_track_update(&track, &result, times[i], read_conditions(i), &answer) != TWINMAP_TRACK_OK) {
      printf("measurement %d: refused\n", i);
      ++failures;
    } else {
      failures += check_answer(i, &answer);
    }
  }
  failures += check_refusal();
  printf("%d tracked, %d differences; within %.2g\n", MEASUREMENTS, failures, worst);
  return failures > 0;
}
