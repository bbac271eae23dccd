/* Whether a measurement is one that the simulator could have given: what the point that explains its features
   best leaves of them, compared with what is left of simulated measurements; and how far the inputs of the
   map are from all it was trained on. */
@TABLES@

/* state->innovation: what the point that explains the scores best leaves of them, whitened; searched from the
   inferred parameters, other unknowns from the middle of their prior. */
static void explain_scores(twinmap_state *state, const double *known, const double *parameters)
{
  score_search search = begin_search(state, known);
  double inferred[TWINMAP_UNKNOWN];
  int i;
  for (i = 0; i < TWINMAP_UNKNOWN; ++i) {
    inferred[i] = i < TWINMAP_PARAMETERS ? (parameters[i] - box_center[i]) / box_half_width[i] : prior_mean[i];
  }
  search_from(&search, inferred);
  for (i = 0; i < search.minimum_count; ++i) {
    refine_minimum(&search, i, 0);
  }
  memcpy(state->innovation, search.minima[find_least(&search)].innovation, sizeof state->innovation);
}

/* Along a direction among the residuals. */
static double dot_real(const real_t *direction, const double *left)
{
  double lane[LANES] = {0.0}, sum;
  const int whole = TWINMAP_RESIDUALS / LANES;
  int k, l;
  for (k = 0; k < whole; ++k, direction += LANES, left += LANES) {
    for (l = 0; l < LANES; ++l) {
      lane[l] = multiply_add(direction[l], left[l], lane[l]);
    }
  }
  sum = add_lanes(lane);
  for (l = 0; l < TWINMAP_RESIDUALS - whole * LANES; ++l) {
    sum = multiply_add(direction[l], left[l], sum);
  }
  return sum;
}

static void add_direction(double factor, const real_t *direction, double *left)
{
  int i;
  for (i = 0; i < TWINMAP_RESIDUALS; ++i) {
    left[i] = multiply_add(factor, direction[i], left[i]);
  }
}

/* All that the point leaves of the features, in numbers that are independent and of unit variance if the
   model is right. state->innovation: then how much of it is missing along the scores' directions. */
static void calc_leftover(twinmap_state *state)
{
  double *left = state->leftover;
  int i, j;
#if TWINMAP_DIAGONAL_WHITENER
  for (i = 0; i < TWINMAP_RESIDUALS; ++i) {
    left[i] = whitener[i] * state->centered[i];
  }
#else
  for (i = 0; i < TWINMAP_RESIDUALS; ++i) {
    left[i] = 0.0;
  }
  for (j = 0; j < TWINMAP_FEATURES; ++j) {
    add_multiple(TWINMAP_RESIDUALS, state->centered[j], whitener + j * TWINMAP_RESIDUALS, left);
  }
#endif
  for (j = 0; j < TWINMAP_SCORES; ++j) {
    state->innovation[j] -= dot_real(score_directions + j * TWINMAP_RESIDUALS, left);
  }
  for (j = 0; j < TWINMAP_SCORES; ++j) {
    add_direction(state->innovation[j], score_directions + j * TWINMAP_RESIDUALS, left);
  }
#if TWINMAP_UNMODELLED
  {
    double moved[TWINMAP_UNMODELLED];
    for (j = 0; j < TWINMAP_UNMODELLED; ++j) {
      moved[j] = dot_real(unmodelled_directions + j * TWINMAP_RESIDUALS, left);
    }
    for (j = 0; j < TWINMAP_UNMODELLED; ++j) {
      const double stddev = unmodelled_stddev[j], shrinkage = 1.0 / sqrt(1.0 + stddev * stddev);
      add_direction(moved[j] * (shrinkage - 1.0), unmodelled_directions + j * TWINMAP_RESIDUALS, left);
    }
  }
#endif
}

/* The stretch of 1, 2, 4, 8 ... neighbours whose sum of squares is least likely (Wilson and Hilferty). */
static void find_anomaly(const double *residual, twinmap_result *result)
{
  int run, count, i;
  result->anomaly_score = -HUGE_VAL;
  result->anomaly_first = 0;
  result->anomaly_count = 0;
  for (run = 0; run < TWINMAP_RUNS; ++run) {
    const int begin = residual_runs[2 * run], length = residual_runs[2 * run + 1];
    for (count = 1; count <= length; count *= 2) {
      const double variance = 2.0 / (9.0 * count);
      double most = -1.0, score;
      int first = 0;
      for (i = begin; i + count <= begin + length; i += count > 1 ? count / 2 : 1) {
        const double sum = dot(count, residual + i, residual + i);
        if (sum > most) {
          most = sum;
          first = i;
        }
      }
      score = (cbrt(most / count) - (1.0 - variance)) / sqrt(variance);
      if (score > result->anomaly_score) {
        result->anomaly_score = score;
        result->anomaly_first = first;
        result->anomaly_count = count;
      }
    }
  }
}

/* The share of simulated measurements whose statistic is at least the value. */
static double calc_p_value(int count, const real_t *sorted, double value)
{
  int below = 0, end = count;
  while (below < end) {
    const int middle = (below + end) / 2;
    if (sorted[middle] < value) {
      below = middle + 1;
    } else {
      end = middle;
    }
  }
  return (count - below + 1.0) / (count + 1.0);
}

/* To the nearest training input, over the largest of simulated measurements. */
static double calc_cloud_distance(twinmap_state *state)
{
  enum { DIMENSIONS = TWINMAP_INPUTS + TWINMAP_KNOWN };
  const real_t *z = cloud_inputs;
  double least = HUGE_VAL;
  int c, f, i;
  for (f = 0; f < DIMENSIONS; ++f) {
    state->cloud_point[f] = state->inputs[f] / cloud_scale[f];
  }
  for (c = 0; c < TWINMAP_CLOUD; c += CHUNK) {
    double sum[CHUNK] = {0.0};
    for (f = 0; f < DIMENSIONS; ++f, z += CHUNK) {
      for (i = 0; i < CHUNK; ++i) {
        const double difference = z[i] - state->cloud_point[f];
        sum[i] = multiply_add(difference, difference, sum[i]);
      }
    }
    for (i = 0; i < CHUNK && c + i < TWINMAP_CLOUD_COUNT; ++i) {
      least = fmin(least, sum[i]);
    }
  }
  return sqrt(least) / cloud_reach;
}

static unsigned find_statuses(const twinmap_result *result)
{
  const double share_of_prior = 0.9, far_away = 1.5;
  unsigned statuses = 0;
  int p;
  if (result->p_value < trust_level) {
    statuses |= TWINMAP_STATUS_MODEL_MISMATCH;
  }
  if (result->distance > far_away) {
    statuses |= TWINMAP_STATUS_OUTSIDE_TRAINING;
  }
  for (p = 0; p < TWINMAP_PARAMETERS; ++p) {
    const double half_width = box_half_width[p], sd = result->sd[p];
    if (fabs(result->mean[p] - box_center[p]) > half_width) {
      statuses |= TWINMAP_STATUS_AT_BOUNDS;
    }
    if (sd > share_of_prior * prior_sd[p]) {
      statuses |= TWINMAP_STATUS_UNINFORMATIVE;
    }
  }
  return statuses;
}

static void judge(twinmap_state *state, const double *known, twinmap_result *result)
{
  int i;
  for (i = 0; i < TWINMAP_FEATURES; ++i) {
    state->centered[i] = state->features[i] - feature_center[i];
  }
  if (!state->explanation_found) { /* else the map's own search found it */
    explain_scores(state, known, result->mean);
  }
  calc_leftover(state);
  result->chi_square = dot(TWINMAP_RESIDUALS, state->leftover, state->leftover);
  result->residuals = TWINMAP_RESIDUALS;
  find_anomaly(state->leftover, result);
  result->chi_square_p_value = calc_p_value(TWINMAP_REFERENCES, chi_square_reference, result->chi_square);
  result->anomaly_p_value = calc_p_value(TWINMAP_ANOMALY_REFERENCES, anomaly_reference, result->anomaly_score);
  result->p_value = fmin(1.0, 2.0 * fmin(result->chi_square_p_value, result->anomaly_p_value));
  result->distance = calc_cloud_distance(state);
  result->statuses = find_statuses(result);
}
