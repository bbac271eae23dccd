/* The map: the processes inverted for each measurement. Distinct minima are mixed by their evidence. */
@TABLES@

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
  score_search search = begin_search(state, known);
  int i, best, p;
  memcpy(state->inputs, search.scores, sizeof(double) * TWINMAP_SCORES);
#if TWINMAP_KNOWN
  memcpy(state->inputs + TWINMAP_SCORES, search.at + TWINMAP_UNKNOWN, sizeof(double) * TWINMAP_KNOWN);
#endif
  search_roughly(&search, find_starts(&search, 0));
  for (i = 0; i < search.minimum_count; ++i) {
    refine_minimum(&search, i, 1);
  }
  best = mix_minima(&search, prior_within, prior_shift);
  state->explanation_found = !search.minima[best].widened;
  memcpy(state->innovation, search.minima[best].innovation, sizeof state->innovation);
  for (p = 0; p < TWINMAP_PARAMETERS; ++p) {
    const double width = box_half_width[p];
    result->mean[p] = multiply_add(width, search.mean[p], box_center[p]);
    result->sd[p] = stddev_scale[p] * width * sqrt(search.covariance[p * TWINMAP_UNKNOWN + p]);
    shrink_to_prior(prior_sd[p], prior_center[p], &result->mean[p], &result->sd[p]);
    result->ratio_to_limit[p] = result->sd[p] / (limit_scale[p] * width * search.noise_stddev[p]);
  }
}
