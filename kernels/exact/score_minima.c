/* Minima of a search for the unknowns that explain scores: found roughly, then refined. */

/* From the first `count` minima. */
static int is_apart(const score_search *s, int count, const double *point)
{
  int i;
  for (i = 0; i < count; ++i) {
    if (!(largest_difference(s->problem->unknown, s->minima[i].point, point) > same_place)) {
      return 0;
    }
  }
  return 1;
}

/* From a point, by the scores that say most; 0 where an earlier search, one of the first `count`, came by. */
static int search_alone(score_search *s, int count, double *point)
{
  double objective = calc_objective(s, METRIC_LEADING, point), damping = first_damping;
  int moves = 1, alone = 1, i, v;
  for (i = 0; i < few_iterations && moves && alone; ++i) {
    make_normal_equations(s, METRIC_LEADING);
    moves = predicted_gain(s, point) >= least_gain;
    for (v = 0; v < s->problem->unknown; ++v) {
      s->trial[v] = point[v] + s->step[v];
    }
    alone = is_apart(s, count, s->trial); /* before the step, which costs an evaluation */
    if (moves && alone) {
      moves = move_on(s, METRIC_LEADING, point, &objective, &damping);
      alone = is_apart(s, count, point);
    }
  }
  return alone;
}

/* Minima of the rough objective from the first starts, distinct, the best first. */
static void search_roughly(score_search *s, int starts)
{
  const int u = s->problem->unknown;
  score_minimum *minima = s->minima;
  int count = 0, k, i;
  for (k = 0; k < starts; ++k) {
    memcpy(minima[count].point, s->start + k * u, sizeof(double) * (size_t)u);
    if (!search_alone(s, count, minima[count].point)) {
      continue;
    }
    minima[count].objective = calc_objective(s, METRIC_ROUGH, minima[count].point);
    for (i = count++; i > 0 && minima[i].objective < minima[i - 1].objective; --i) {
      const score_minimum better = minima[i];
      minima[i] = minima[i - 1];
      minima[i - 1] = better;
    }
  }
  while (minima[count - 1].objective > minima[0].objective + basin_above) {
    --count;
  }
  s->minimum_count = count;
}

/* Into start from `found` on: the training simulations of most similar scores that are apart from each other.
   Returns how many starts there are then. */
static int find_starts(score_search *s, int found)
{
  const double apart = 0.5; /* in half widths: nearer starts lead to the same minimum */
  const score_problem *problem = s->problem;
  const int r = problem->scores, u = problem->unknown, first = found, most = found + 3;
  int i, k;
  for (; found < most; ++found) {
    double least = HUGE_VAL;
    const wide_t *best = NULL;
    for (i = 0; i < problem->points; ++i) {
      const real_t *scores = problem->training_scores + i * r;
      const wide_t *point = problem->training_points + i * problem->variables;
      double misfit = 0.0;
      int far = 1;
      for (k = first; k < found && far; ++k) {
        far = largest_difference(u, s->start + k * u, point) > apart;
      }
      for (k = 0; k < r && far && misfit < least; ++k) {
        const double difference = (scores[k] - s->scores[k]) * problem->rough_weights[k];
        misfit = multiply_add(difference, difference, misfit);
      }
      if (far && (best == NULL || misfit < least)) {
        least = misfit;
        best = point;
      }
    }
    if (best == NULL) {
      break;
    }
    memcpy(s->start + found * u, best, sizeof(double) * (size_t)u);
  }
  return found;
}

/* Where residuals are beyond what the errors allow, those of the windows to blame are taken to be as large; 0
   where none is. Next to a jump, such as that of a contact made or missed, no simulation tells how wrong a
   process is. */
static int widen(score_search *s, const double *unknown)
{
  const score_problem *problem = s->problem;
  int widened = 0, w;
  (void)calc_objective(s, METRIC_FULL, unknown);
  if (!is_misfit(dot(problem->scores, s->residual, s->residual), problem->scores)) {
    return 0;
  }
  for (w = 0; w < problem->windows; ++w) {
    const int first = problem->window[w].first;
    const double factor =
        calc_widening(problem->window[w].functions, s->stddev + first, s->scores + first, s->values + first);
    if (factor > 0.0) {
      s->widening[w] *= factor;
      widened = 1;
    }
  }
  return widened;
}

/* The point with the full metric, and its whitened residual. */
static void move_to_minimum(score_search *s, score_minimum *minimum, int may_widen)
{
  const score_problem *problem = s->problem;
  double *point = minimum->point;
  int i;
  for (i = 0; i < problem->windows; ++i) {
    s->widening[i] = 1.0;
  }
  memcpy(s->before, point, sizeof(double) * (size_t)problem->unknown);
  update_metric(s, point);
  minimum->objective = improve(s, METRIC_FULL, point);
  if (largest_difference(problem->unknown, point, s->before) > same_place) {
    update_metric(s, point);
    minimum->objective = improve(s, METRIC_FULL, point);
  }
  memcpy(minimum->innovation, s->residual, sizeof(double) * (size_t)problem->scores);
  minimum->widened = 0;
  for (i = 0; may_widen && i < few_iterations && widen(s, point); ++i) {
    update_metric(s, point);
    minimum->objective = improve(s, METRIC_FULL, point);
    minimum->widened = 1;
  }
}

/* Of a minimum: the point with the full metric, its whitened residual, the normal likelihood around it, the
   objective with its evidence. may_widen: where scores are to be explained at any cost, not where they are to be
   judged. */
static void refine_minimum(score_search *s, int index, int may_widen)
{
  const int r = s->problem->scores, u = s->problem->unknown;
  score_minimum *minimum = &s->minima[index];
  int v, i;
  move_to_minimum(s, minimum, may_widen);
  make_normal_equations(s, METRIC_FULL);
  memcpy(minimum->information, s->normal, sizeof(double) * (size_t)(u * u));
  calc_information(r, u, s->jacobian, minimum->noise_information);
  for (v = 0; v < u; ++v) {
    minimum->shift[v] = s->descent[v] + dot(u, s->normal + v * u, minimum->point);
  }
  for (i = 0; i < u * u; ++i) {
    s->normal[i] += half_width_information * s->problem->prior_relative[i];
  }
  minimum->objective += s->log_determinant + calc_small_log_determinant(u, s->normal, s->small);
}

#if TWINMAP_TRUST
/* From a point (u), and, if that explains too little, from the most similar simulations. */
static void search_from(score_search *s, const double *point)
{
  int v;
  for (v = 0; v < s->problem->unknown; ++v) {
    s->start[v] = fmin(fmax(point[v], -1.0), 1.0);
  }
  search_roughly(s, 1);
  if (is_misfit(s->minima[0].objective, s->problem->scores)) {
    search_roughly(s, find_starts(s, 1));
  }
}

/* Of the minima refined. */
static int find_least(const score_search *s)
{
  int i, least = 0;
  for (i = 1; i < s->minimum_count; ++i) {
    if (s->minima[i].objective < s->minima[least].objective) {
      least = i;
    }
  }
  return least;
}
#endif
