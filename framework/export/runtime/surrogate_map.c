/* The map: the processes inverted for each measurement. Distinct minima are mixed by their evidence. */
@TABLES@

/* Whether the full metric made a minimum one with an earlier one. */
static int has_earlier_twin(const twinmap_state *state, int index)
{
  int i;
  for (i = 0; i < index; ++i) {
    if (largest_difference(U, state->minima[i].point, state->minima[index].point) < same_place) {
      return 1;
    }
  }
  return 0;
}

static void mix_minima(twinmap_state *state, const double *weight)
{
  double apart[U];
  int i, a, b;
  for (a = 0; a < U; ++a) {
    state->mixed_mean[a] = 0.0;
    for (i = 0; i < state->minimum_count; ++i) {
      state->mixed_mean[a] = multiply_add(weight[i], state->minima[i].mean[a], state->mixed_mean[a]);
    }
  }
  memset(state->mixed_covariance, 0, sizeof state->mixed_covariance);
  for (i = 0; i < state->minimum_count; ++i) {
    for (a = 0; a < U; ++a) {
      apart[a] = state->minima[i].mean[a] - state->mixed_mean[a];
    }
    for (a = 0; a < U; ++a) {
      for (b = 0; b < U; ++b) {
        state->mixed_covariance[a * U + b] +=
            weight[i] * (state->minima[i].covariance[a * U + b] + apart[a] * apart[b]);
      }
    }
  }
}

/* Adds what is known beside the bounds to the information of a normal density and to its shift. */
static void add_prior_within(double *information, double *shift)
{
  int a, b;
  for (a = 0; a < U; ++a) {
    shift[a] += prior_shift[a];
    for (b = 0; b < U; ++b) {
      information[a * U + b] += prior_within[a * U + b];
    }
  }
}

/* Mixed mean and covariance of the unknowns, and what the noise alone would leave. */
static void invert_scores(twinmap_state *state)
{
  double start[MOST_STARTS * U], weight[MOST_STARTS], total = 0.0, least = HUGE_VAL;
  int i, a, best = 0;
  state->evaluated = EVALUATED_NONE;
  search_roughly(state, find_starts(state, 3, start), start);
  for (i = 0; i < state->minimum_count; ++i) {
    refine_minimum(state, i, 1);
    add_prior_within(state->minima[i].information, state->minima[i].shift);
    calc_box_moments(U, state->minima[i].information, state->minima[i].shift, state->box_buffer,
                     state->minima[i].mean, state->minima[i].covariance);
    least = fmin(least, state->minima[i].objective);
  }
  for (i = 0; i < state->minimum_count; ++i) {
    weight[i] = exp(-0.5 * (state->minima[i].objective - least));
    if (i > 0 && has_earlier_twin(state, i)) {
      weight[i] = 0.0;
    }
    if (weight[i] > weight[best]) {
      best = i;
    }
    total += weight[i];
  }
  for (i = 0; i < state->minimum_count; ++i) {
    weight[i] /= total;
  }
  mix_minima(state, weight);
  for (a = 0; a < U; ++a) {
    state->trial[a] = dot(U, state->minima[best].noise_information + a * U, state->minima[best].point);
  }
  add_prior_within(state->minima[best].noise_information, state->trial);
  calc_box_moments(U, state->minima[best].noise_information, state->trial, state->box_buffer, state->noise_stddev,
                   state->normal);
  for (a = 0; a < U; ++a) {
    state->noise_stddev[a] = sqrt(state->normal[a * U + a]);
  }
  state->explanation_found = !state->minima[best].widened;
  keep_explanation(state, best);
}

/* What is less certain than the prior is drawn towards its mean until it is as certain. */
static void shrink_to_prior(double prior, double center, double *mean, double *sd)
{
  if (*sd > prior) {
    *mean = multiply_add(prior / *sd, *mean - center, center);
    *sd = prior;
  }
}

static void infer_by_map(twinmap_state *state, const double *known, twinmap_result *result)
{
  int p;
  calc_scores(state);
  set_known(state, known);
  memcpy(state->inputs, state->scores, sizeof state->scores);
#if TWINMAP_KNOWN
  memcpy(state->inputs + R, state->at + U, sizeof(double) * TWINMAP_KNOWN);
#endif
  invert_scores(state);
  for (p = 0; p < TWINMAP_PARAMETERS; ++p) {
    const double width = box_half_width[p];
    result->mean[p] = multiply_add(width, state->mixed_mean[p], box_center[p]);
    result->sd[p] = stddev_scale[p] * width * sqrt(state->mixed_covariance[p * U + p]);
    shrink_to_prior(prior_sd[p], prior_center[p], &result->mean[p], &result->sd[p]);
    result->ratio_to_limit[p] = result->sd[p] / (limit_scale[p] * width * state->noise_stddev[p]);
  }
}
