/* The unknown parameters that explain scores, under the prior within the box (normalised, -1 to 1).
   Levenberg and Marquardt's method searches the least of
     r' C^-1 r + log det C + 3 (x - m)' P (x - m),   r = scores - s(x),   C = 1 + D R D,
   m and P the prior's mean and relative information (0 and 1 where it is uniform within the bounds),
   D the standard deviations of the processes and R the correlation of their errors: first with mean error
   variances and the scores that say most, then with C at the point reached, held. */
enum { MOST_STARTS = 4, R = TWINMAP_SCORES, U = TWINMAP_UNKNOWN };
enum { METRIC_LEADING, METRIC_ROUGH, METRIC_FULL };

static double largest_difference(int count, const double *a, const double *b)
{
  double largest = 0.0;
  int i;
  for (i = 0; i < count; ++i) {
    largest = fmax(largest, fabs(a[i] - b[i]));
  }
  return largest;
}

static int count_of(int metric, const window *w)
{
  return metric == METRIC_LEADING ? w->leading : w->functions;
}

/* state->evaluated. */
enum { EVALUATED_NONE, EVALUATED_LEADING, EVALUATED_ALL };

/* Values and derivatives, for a trial is nearly always accepted. */
static void evaluate(twinmap_state *state, int metric, const double *unknown)
{
  const int wanted = metric == METRIC_LEADING ? EVALUATED_LEADING : EVALUATED_ALL;
  int w;
  if (state->evaluated >= wanted && memcmp(state->at, unknown, sizeof(double) * U) == 0) {
    return;
  }
  state->evaluated = wanted;
  memcpy(state->at, unknown, sizeof(double) * U);
  for (w = 0; w < TWINMAP_WINDOWS; ++w) {
    if (count_of(metric, &windows[w]) > 0) {
      evaluate_window(state, w, count_of(metric, &windows[w]));
    }
  }
}

static double calc_objective(twinmap_state *state, int metric, const double *unknown)
{
  const wide_t *weights = metric == METRIC_LEADING ? leading_weights : rough_weights;
  int i;
  evaluate(state, metric, unknown);
  for (i = 0; i < R; ++i) {
    state->residual[i] = state->scores[i] - state->values[i];
  }
  if (metric == METRIC_FULL) {
    solve_columns(R, state->lower, state->residual);
  } else {
    for (i = 0; i < R; ++i) {
      state->residual[i] *= weights[i];
    }
  }
  calc_pull(U, prior_relative, prior_mean, unknown, state->offset, state->pull);
  return dot(R, state->residual, state->residual) + half_width_information * dot(U, state->offset, state->pull);
}

/* At the point evaluated last. */
static void make_normal_equations(twinmap_state *state, int metric)
{
  const wide_t *weights = metric == METRIC_LEADING ? leading_weights : rough_weights;
  int v, i;
  for (v = 0; v < U; ++v) {
    double *column = state->scaled_jacobian + v * R;
    for (i = 0; i < R; ++i) {
      column[i] = state->jacobian[v * R + i];
    }
    if (metric == METRIC_FULL) {
      solve_columns(R, state->lower, column);
    } else {
      for (i = 0; i < R; ++i) {
        column[i] *= weights[i];
      }
    }
    state->descent[v] = dot(R, column, state->residual);
  }
  calc_information(R, U, state->scaled_jacobian, state->normal);
}

/* Whether a step lowers the objective, with as little damping as that takes. */
static int take_step(twinmap_state *state, int metric, double *unknown, double *objective, double *damping)
{
  const double factor = 10.0, most = 1e6, least = 1e-6;
  int v;
  for (; *damping < most; *damping *= factor) {
    double tried;
    memcpy(state->step, state->descent, sizeof state->step);
    calc_pull(U, prior_relative, prior_mean, unknown, state->offset, state->pull);
    if (!solve_step(U, state->normal, prior_relative, state->pull, *damping, state->small, state->step)) {
      continue;
    }
    for (v = 0; v < U; ++v) {
      state->trial[v] = fmin(fmax(unknown[v] + state->step[v], -1.0), 1.0);
    }
    tried = calc_objective(state, metric, state->trial);
    if (tried < *objective) {
      memcpy(unknown, state->trial, sizeof(double) * U);
      *objective = tried;
      *damping = fmax(*damping / factor, least);
      return 1;
    }
  }
  return 0;
}

/* Of an undamped step that no bound stops, which state->step then is, as the linear model has it. */
static double predicted_gain(twinmap_state *state, const double *unknown)
{
  double gain = 0.0;
  int v;
  memcpy(state->step, state->descent, sizeof state->step);
  calc_pull(U, prior_relative, prior_mean, unknown, state->offset, state->pull);
  if (!solve_step(U, state->normal, prior_relative, state->pull, 0.0, state->small, state->step)) {
    return HUGE_VAL;
  }
  for (v = 0; v < U; ++v) {
    gain += (state->descent[v] - half_width_information * state->pull[v]) * state->step[v];
  }
  return gain;
}

static const double same_place = 0.05;  /* half widths: nearer searches are of one minimum, as errors vary over tenths */
static const double basin_above = 25.0; /* of chi-square: a share of 4e-6 */
static const int few_iterations = 8;    /* where searches end by least_gain, mostly */
static const double least_gain = 0.01; /* a step of a tenth of a standard deviation: the linear model tells the rest */

/* A step that would gain something; 0 where it did not. */
static int move_on(twinmap_state *state, int metric, double *unknown, double *objective, double *damping)
{
  const double before = *objective;
  if (!take_step(state, metric, unknown, objective, damping)) {
    *objective = calc_objective(state, metric, unknown);
    return 0;
  }
  return before - *objective >= least_gain;
}

/* A step; 0 where the search has converged: a step would gain little, or did. */
static int advance(twinmap_state *state, int metric, double *unknown, double *objective, double *damping)
{
  make_normal_equations(state, metric);
  return predicted_gain(state, unknown) >= least_gain && move_on(state, metric, unknown, objective, damping);
}

static const double first_damping = 1e-3;

static double improve(twinmap_state *state, int metric, int steps, double *unknown)
{
  double damping = first_damping, objective = calc_objective(state, metric, unknown);
  int i;
  for (i = 0; i < steps && advance(state, metric, unknown, &objective, &damping); ++i) {
  }
  return objective;
}

/* C at a point, factorised. */
static void update_metric(twinmap_state *state, const double *unknown)
{
  const wide_t *correlation = score_correlation;
  double *lower = state->lower;
  int w, j, i;
  evaluate(state, METRIC_FULL, unknown);
  for (w = 0; w < TWINMAP_WINDOWS; ++w) {
    calc_window_stddev(state, w);
    for (j = windows[w].first; j < windows[w].first + windows[w].functions; ++j) {
      state->stddev[j] *= state->widening[w];
    }
  }
  for (j = 0; j < R; ++j) {
    double *column = lower + find_column(R, j);
    for (i = j; i < R; ++i) {
      column[i - j] = state->stddev[i] * *correlation++ * state->stddev[j];
    }
    column[0] += 1.0;
  }
  factorise(R, lower);
  state->log_determinant = calc_log_determinant(R, lower);
}

static int is_apart(const twinmap_state *state, int count, const double *point)
{
  int i;
  for (i = 0; i < count; ++i) {
    if (!(largest_difference(U, state->minima[i].point, point) > same_place)) {
      return 0;
    }
  }
  return 1;
}

/* Minima of the rough objective from starts (U numbers each), distinct, the best first. */
static void search_roughly(twinmap_state *state, int starts, const double *start)
{
  double point[U];
  int count = 0, s, i, v;
  for (s = 0; s < starts; ++s) {
    double objective, damping = first_damping;
    int moves = 1, alone = 1;
    memcpy(point, start + s * U, sizeof point);
    objective = calc_objective(state, METRIC_LEADING, point);
    for (i = 0; i < few_iterations && moves && alone; ++i) {
      make_normal_equations(state, METRIC_LEADING);
      moves = predicted_gain(state, point) >= least_gain;
      for (v = 0; v < U; ++v) {
        state->trial[v] = point[v] + state->step[v];
      }
      alone = is_apart(state, count, state->trial); /* before the step, which costs an evaluation */
      if (moves && alone) {
        moves = move_on(state, METRIC_LEADING, point, &objective, &damping);
        alone = is_apart(state, count, point);
      }
    }
    if (!alone) {
      continue;
    }
    objective = calc_objective(state, METRIC_ROUGH, point);
    for (i = count++; i > 0 && objective < state->minima[i - 1].objective; --i) {
      memcpy(state->minima[i].point, state->minima[i - 1].point, sizeof point);
      state->minima[i].objective = state->minima[i - 1].objective;
    }
    memcpy(state->minima[i].point, point, sizeof point);
    state->minima[i].objective = objective;
  }
  while (state->minima[count - 1].objective > state->minima[0].objective + basin_above) {
    --count;
  }
  state->minimum_count = count;
}

/* The training simulations of most similar scores that are apart from each other. */
static int find_starts(const twinmap_state *state, int most, double *start)
{
  const double apart = 0.5; /* in half widths: nearer starts lead to the same minimum */
  int found, i, s;
  for (found = 0; found < most; ++found) {
    double least = HUGE_VAL;
    int best = -1;
    for (i = 0; i < TWINMAP_POINTS; ++i) {
      const real_t *scores = training_scores + i * R;
      double misfit = 0.0;
      int far = 1;
      for (s = 0; s < found && far; ++s) {
        far = largest_difference(U, start + s * U, training_points + i * TWINMAP_VARIABLES) > apart;
      }
      for (s = 0; s < R && far; ++s) {
        const double difference = (scores[s] - state->scores[s]) * rough_weights[s];
        misfit = multiply_add(difference, difference, misfit);
      }
      if (far && misfit < least) {
        least = misfit;
        best = i;
      }
    }
    if (best < 0) {
      break;
    }
    memcpy(start + found * U, training_points + best * TWINMAP_VARIABLES, sizeof(double) * U);
  }
  return found;
}

/* Where residuals are beyond what the errors allow, those of the windows to blame are taken to be as large. */
static int widen(twinmap_state *state, const double *unknown)
{
  int widened = 0, w;
  (void)calc_objective(state, METRIC_FULL, unknown);
  if (!is_misfit(dot(R, state->residual, state->residual), R)) {
    return 0;
  }
  for (w = 0; w < TWINMAP_WINDOWS; ++w) {
    const int first = windows[w].first;
    const double factor = calc_widening(windows[w].functions, state->stddev + first, state->scores + first,
                                        state->values + first);
    if (factor > 0.0) {
      state->widening[w] *= factor;
      widened = 1;
    }
  }
  return widened;
}

/* Of a minimum: the point with the full metric, its whitened residual, the normal likelihood around it, the
   objective with its evidence. */
static void refine_minimum(twinmap_state *state, int index, int may_widen)
{
  double *point = state->minima[index].point, before[U], objective;
  int i, v, a, w;
  for (w = 0; w < TWINMAP_WINDOWS; ++w) {
    state->widening[w] = 1.0;
  }
  memcpy(before, point, sizeof before);
  update_metric(state, point);
  objective = improve(state, METRIC_FULL, few_iterations, point);
  if (largest_difference(U, point, before) > same_place) {
    update_metric(state, point);
    objective = improve(state, METRIC_FULL, few_iterations, point);
  }
  memcpy(state->minima[index].innovation, state->residual, sizeof state->innovation);
  state->minima[index].widened = 0;
  for (i = 0; may_widen && i < few_iterations && widen(state, point); ++i) {
    update_metric(state, point);
    objective = improve(state, METRIC_FULL, few_iterations, point);
    state->minima[index].widened = 1;
  }
  make_normal_equations(state, METRIC_FULL);
  memcpy(state->minima[index].information, state->normal, sizeof state->normal);
  calc_information(R, U, state->jacobian, state->minima[index].noise_information);
  for (v = 0; v < U; ++v) {
    state->minima[index].shift[v] = state->descent[v] + dot(U, state->normal + v * U, point);
  }
  for (v = 0; v < U; ++v) {
    for (a = 0; a < U; ++a) {
      state->normal[v * U + a] += half_width_information * prior_relative[v * U + a];
    }
  }
  state->minima[index].objective =
      objective + (state->log_determinant + calc_small_log_determinant(U, state->normal, state->small));
}

/* What a minimum says of the scores: what they leave, whitened, and its point. */
static void keep_explanation(twinmap_state *state, int index)
{
  memcpy(state->explained, state->minima[index].point, sizeof state->explained);
  memcpy(state->innovation, state->minima[index].innovation, sizeof state->innovation);
}
