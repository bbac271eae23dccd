/* What the map and its judgement say, put together. */
@TABLES@

#if !TWINMAP_NETWORK
static void correlate(twinmap_result *result)
{
  int a, b;
  for (a = 0; a < TWINMAP_PARAMETERS; ++a) {
    for (b = 0; b < TWINMAP_PARAMETERS; ++b) {
      result->covariance[a * TWINMAP_PARAMETERS + b] =
          result->sd[a] * parameter_correlation[a * TWINMAP_PARAMETERS + b] * result->sd[b];
    }
  }
}
#endif

static void finish(twinmap_result *result)
{
  int a, limited = TWINMAP_UNCALIBRATED;
  for (a = 0; a < TWINMAP_PARAMETERS; ++a) {
    result->lower[a] = result->mean[a] - interval_factor[a] * result->sd[a];
    result->upper[a] = result->mean[a] + interval_factor[a] * result->sd[a];
    limited |= result->ratio_to_limit[a] > 1.5;
  }
#if !TWINMAP_NETWORK
  correlate(result);
#endif
  if (limited) {
    result->statuses |= TWINMAP_STATUS_ESTIMATOR_LIMITED;
  }
  result->status = TWINMAP_TRUST ? TWINMAP_STATUS_OK : TWINMAP_STATUS_NOT_JUDGED;
  for (a = TWINMAP_STATUS_ESTIMATOR_LIMITED; a > 0; a /= 2) {
    if (result->statuses & (unsigned)a) {
      result->status = (twinmap_status)a;
    }
  }
}

static twinmap_error infer_from_features(twinmap_state *state, const double *known, twinmap_result *result)
{
  int i;
  for (i = 0; i < TWINMAP_FEATURES; ++i) {
    if (!(fabs(state->features[i]) <= 1.7976931348623157e308)) {
      return TWINMAP_ERROR_FEATURE;
    }
  }
  for (i = 0; i < TWINMAP_KNOWN; ++i) {
    if (!(fabs(known[i]) <= 1.7976931348623157e308)) {
      return TWINMAP_ERROR_NUMBER;
    }
  }
  memset(result, 0, sizeof *result);
#if TWINMAP_SCORES
  state->explanation_found = 0;
#endif
  infer_by_map(state, known, result);
#if TWINMAP_TRUST
  judge(state, known, result);
#endif
  finish(result);
  return TWINMAP_OK;
}

/* From here on every processor can run what is compiled. */
#ifdef TWINMAP_FUSED
#ifdef __clang__
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#define TWINMAP_PROCESSOR_WILL_DO (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
#else
#define TWINMAP_PROCESSOR_WILL_DO 1
#endif

twinmap_error twinmap_infer_features(twinmap_state *state, const twinmap_real *features, const double *known,
                                     twinmap_result *result)
{
  int i;
  if (!TWINMAP_PROCESSOR_WILL_DO) {
    return TWINMAP_ERROR_PROCESSOR;
  }
  for (i = 0; i < TWINMAP_FEATURES; ++i) {
    state->features[i] = features[i];
  }
  return infer_from_features(state, known, result);
}

#if TWINMAP_SIGNALS
twinmap_error twinmap_resample(twinmap_state *state, int count, const double *times,
                               const twinmap_real *const *signals, double start)
{
  return TWINMAP_PROCESSOR_WILL_DO ? resample(state, count, times, signals, start) : TWINMAP_ERROR_PROCESSOR;
}

twinmap_error twinmap_infer(twinmap_state *state, int count, const double *times,
                            const twinmap_real *const *signals, double start, const double *known,
                            twinmap_result *result)
{
  const twinmap_error error = twinmap_resample(state, count, times, signals, start);
  if (error != TWINMAP_OK) {
    return error;
  }
  extract_features(state);
  return infer_from_features(state, known, result);
}
#endif

const char *twinmap_status_text(twinmap_status status)
{
  switch (status) {
    case TWINMAP_STATUS_MODEL_MISMATCH:
      return "model_mismatch";
    case TWINMAP_STATUS_OUTSIDE_TRAINING:
      return "outside_training";
    case TWINMAP_STATUS_AT_BOUNDS:
      return "at_bounds";
    case TWINMAP_STATUS_UNINFORMATIVE:
      return "uninformative";
    case TWINMAP_STATUS_ESTIMATOR_LIMITED:
      return "estimator_limited";
    case TWINMAP_STATUS_NOT_JUDGED:
      return "not_judged";
    case TWINMAP_STATUS_OK:
      break;
  }
  return "ok";
}
