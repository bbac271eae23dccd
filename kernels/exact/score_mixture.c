/* Refined minima of scores as one distribution within the box: each the moments of its likelihood and the prior
   there, mixed by their evidence. */

/* Whether the full metric made a minimum one with an earlier one. */
static int has_earlier_twin(const score_search *s, int index)
{
  int i;
  for (i = 0; i < index; ++i) {
    if (largest_difference(s->problem->unknown, s->minima[i].point, s->minima[index].point) < same_place) {
      return 1;
    }
  }
  return 0;
}

/* Adds what is known beside the bounds to the information of a normal density and to its shift. */
static void add_prior_within(int u, const wide_t *within, const wide_t *prior_shift, double *information, double *shift)
{
  int i;
  for (i = 0; i < u; ++i) {
    shift[i] += prior_shift[i];
  }
  for (i = 0; i < u * u; ++i) {
    information[i] += within[i];
  }
}

static void mix_moments(score_search *s)
{
  const int u = s->problem->unknown;
  int i, a, b;
  for (a = 0; a < u; ++a) {
    s->mean[a] = 0.0;
    for (i = 0; i < s->minimum_count; ++i) {
      s->mean[a] = multiply_add(s->share[i], s->minima[i].mean[a], s->mean[a]);
    }
  }
  for (i = 0; i < u * u; ++i) {
    s->covariance[i] = 0.0;
  }
  for (i = 0; i < s->minimum_count; ++i) {
    for (a = 0; a < u; ++a) {
      s->offset[a] = s->minima[i].mean[a] - s->mean[a];
    }
    for (a = 0; a < u; ++a) {
      for (b = 0; b < u; ++b) {
        s->covariance[a * u + b] +=
            s->share[i] * (s->minima[i].covariance[a * u + b] + s->offset[a] * s->offset[b]);
      }
    }
  }
}

/* Shares of the evidence; the largest. */
static int calc_shares(score_search *s)
{
  double total = 0.0, least = HUGE_VAL;
  int i, best = 0;
  for (i = 0; i < s->minimum_count; ++i) {
    least = fmin(least, s->minima[i].objective);
  }
  for (i = 0; i < s->minimum_count; ++i) {
    s->share[i] = i > 0 && has_earlier_twin(s, i) ? 0.0 : exp(-0.5 * (s->minima[i].objective - least));
    if (s->share[i] > s->share[best]) {
      best = i;
    }
    total += s->share[i];
  }
  for (i = 0; i < s->minimum_count; ++i) {
    s->share[i] /= total;
  }
  return best;
}

/* Mean and covariance of the unknowns from the refined minima, and what the noise alone would leave at that of
   most evidence, which is returned. within, prior_shift: what the prior says beside the bounds. */
static int mix_minima(score_search *s, const wide_t *within, const wide_t *prior_shift)
{
  const int u = s->problem->unknown, best = calc_shares(s);
  const score_minimum *likeliest = &s->minima[best];
  int i, v;
  for (i = 0; i < s->minimum_count; ++i) {
    score_minimum *minimum = &s->minima[i];
    add_prior_within(u, within, prior_shift, minimum->information, minimum->shift);
    calc_box_moments(u, minimum->information, minimum->shift, s->box_buffer, minimum->mean, minimum->covariance);
  }
  mix_moments(s);
  for (v = 0; v < u; ++v) {
    s->trial[v] = dot(u, likeliest->noise_information + v * u, likeliest->point);
  }
  add_prior_within(u, within, prior_shift, likeliest->noise_information, s->trial);
  calc_box_moments(u, likeliest->noise_information, s->trial, s->box_buffer, s->noise_stddev, s->normal);
  for (v = 0; v < u; ++v) {
    s->noise_stddev[v] = sqrt(s->normal[v * u + v]);
  }
  return best;
}
