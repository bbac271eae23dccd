/* The unknown parameters that explain scores, under the prior within the box (normalised, -1 to 1).
   Levenberg and Marquardt's method searches the least of
     r' C^-1 r + log det C + 3 (x - m)' P (x - m),   r = scores - s(x),   C = 1 + D R D,
   m and P the prior's mean and relative information (0 and 1 where it is uniform within the bounds),
   D the standard deviations of the processes and R the correlation of their errors: first with mean error
   variances and the scores that say most, then with C at the point reached, held. */
enum { METRIC_LEADING, METRIC_ROUGH, METRIC_FULL };
enum { EVALUATED_NONE, EVALUATED_LEADING, EVALUATED_ALL };

static double *take(double **room, int count)
{
  double *taken = *room;
  *room += count;
  return taken;
}

/* A search with its buffers in a room of TWINMAP_SEARCH numbers, which need no initialisation but search->scores
   and the known variables of search->at. */
static score_search lay_out_search(const score_problem *problem, void *owner, double *room)
{
  const int r = problem->scores, u = problem->unknown;
  score_search search;
  int i;
  search.problem = problem;
  search.owner = owner;
  search.evaluated = EVALUATED_NONE;
  search.minimum_count = 0;
  search.log_determinant = 0.0;
  search.at = take(&room, problem->variables);
  search.widening = take(&room, problem->windows);
  search.scores = take(&room, r);
  search.values = take(&room, r);
  search.stddev = take(&room, r);
  search.residual = take(&room, r);
  search.jacobian = take(&room, r * u);
  search.scaled_jacobian = take(&room, r * u);
  search.lower = take(&room, r * (r + 1) / 2);
  search.descent = take(&room, u);
  search.step = take(&room, u);
  search.trial = take(&room, u);
  search.offset = take(&room, u);
  search.pull = take(&room, u);
  search.before = take(&room, u);
  search.start = take(&room, MOST_MINIMA * u);
  search.normal = take(&room, u * u);
  search.small = take(&room, u * u);
  for (i = 0; i < MOST_MINIMA; ++i) {
    score_minimum *minimum = &search.minima[i];
    minimum->point = take(&room, u);
    minimum->shift = take(&room, u);
    minimum->mean = take(&room, u);
    minimum->innovation = take(&room, r);
    minimum->information = take(&room, u * u);
    minimum->noise_information = take(&room, u * u);
    minimum->covariance = take(&room, u * u);
  }
  search.mean = take(&room, u);
  search.noise_stddev = take(&room, u);
  search.covariance = take(&room, u * u);
  search.box_buffer = take(&room, u * (u + 3));
  return search;
}

static double largest_difference(int count, const double *a, const double *b)
{
  double largest = 0.0;
  int i;
  for (i = 0; i < count; ++i) {
    largest = fmax(largest, fabs(a[i] - b[i]));
  }
  return largest;
}

/* Values and derivatives, for a trial is nearly always accepted. */
static void evaluate(score_search *s, int metric, const double *unknown)
{
  const score_problem *problem = s->problem;
  const int wanted = metric == METRIC_LEADING ? EVALUATED_LEADING : EVALUATED_ALL;
  const size_t size = sizeof(double) * (size_t)problem->unknown;
  int w;
  if (s->evaluated >= wanted && memcmp(s->at, unknown, size) == 0) {
    return;
  }
  s->evaluated = wanted;
  memcpy(s->at, unknown, size);
  for (w = 0; w < problem->windows; ++w) {
    const score_window *window = &problem->window[w];
    const int count = metric == METRIC_LEADING ? window->leading : window->functions;
    if (count > 0) {
      problem->evaluate(s, w, count);
    }
  }
}

/* x of scores in the units of their errors. */
static void whiten(const score_search *s, int metric, double *x)
{
  const score_problem *problem = s->problem;
  const wide_t *weights = metric == METRIC_LEADING ? problem->leading_weights : problem->rough_weights;
  int i;
  if (metric == METRIC_FULL) {
    solve_columns(problem->scores, s->lower, x);
    return;
  }
  for (i = 0; i < problem->scores; ++i) {
    x[i] *= weights[i];
  }
}

/* What the prior draws an unknown point with, into s->pull. */
static void pull_to_prior(score_search *s, const double *unknown)
{
  calc_pull(s->problem->unknown, s->problem->prior_relative, s->problem->prior_mean, unknown, s->offset, s->pull);
}

static double calc_objective(score_search *s, int metric, const double *unknown)
{
  const int r = s->problem->scores;
  int i;
  evaluate(s, metric, unknown);
  for (i = 0; i < r; ++i) {
    s->residual[i] = s->scores[i] - s->values[i];
  }
  whiten(s, metric, s->residual);
  pull_to_prior(s, unknown);
  return dot(r, s->residual, s->residual) + half_width_information * dot(s->problem->unknown, s->offset, s->pull);
}

/* At the point evaluated last. */
static void make_normal_equations(score_search *s, int metric)
{
  const int r = s->problem->scores, u = s->problem->unknown;
  int v;
  memcpy(s->scaled_jacobian, s->jacobian, sizeof(double) * (size_t)(r * u));
  for (v = 0; v < u; ++v) {
    double *column = s->scaled_jacobian + v * r;
    whiten(s, metric, column);
    s->descent[v] = dot(r, column, s->residual);
  }
  calc_information(r, u, s->scaled_jacobian, s->normal);
}

/* Into s->step; 0 where the damped information is not positive definite. */
static int solve_from(score_search *s, const double *unknown, double damping)
{
  const score_problem *problem = s->problem;
  memcpy(s->step, s->descent, sizeof(double) * (size_t)problem->unknown);
  pull_to_prior(s, unknown);
  return solve_step(problem->unknown, s->normal, problem->prior_relative, s->pull, damping, s->small, s->step);
}

/* Whether a step lowers the objective, with as little damping as that takes. */
static int take_step(score_search *s, int metric, double *unknown, double *objective, double *damping)
{
  const double factor = 10.0, most = 1e6, least = 1e-6;
  const int u = s->problem->unknown;
  int v;
  for (; *damping < most; *damping *= factor) {
    double tried;
    if (!solve_from(s, unknown, *damping)) {
      continue;
    }
    for (v = 0; v < u; ++v) {
      s->trial[v] = fmin(fmax(unknown[v] + s->step[v], -1.0), 1.0);
    }
    tried = calc_objective(s, metric, s->trial);
    if (tried < *objective) {
      memcpy(unknown, s->trial, sizeof(double) * (size_t)u);
      *objective = tried;
      *damping = fmax(*damping / factor, least);
      return 1;
    }
  }
  return 0;
}

/* Of an undamped step that no bound stops, which s->step then is, as the linear model has it. */
static double predicted_gain(score_search *s, const double *unknown)
{
  double gain = 0.0;
  int v;
  if (!solve_from(s, unknown, 0.0)) {
    return HUGE_VAL;
  }
  for (v = 0; v < s->problem->unknown; ++v) {
    gain += (s->descent[v] - half_width_information * s->pull[v]) * s->step[v];
  }
  return gain;
}

static const double same_place = 0.05;  /* half widths: nearer searches are of one minimum, as errors vary over tenths */
static const double basin_above = 25.0; /* of chi-square: a share of 4e-6 */
static const int few_iterations = 8;    /* where searches end by least_gain, mostly */
static const double least_gain = 0.01;  /* a step of a tenth of a standard deviation: the linear model tells the rest */
static const double first_damping = 1e-3;

/* A step that would gain something; 0 where it did not. */
static int move_on(score_search *s, int metric, double *unknown, double *objective, double *damping)
{
  const double before = *objective;
  if (!take_step(s, metric, unknown, objective, damping)) {
    *objective = calc_objective(s, metric, unknown);
    return 0;
  }
  return before - *objective >= least_gain;
}

/* A step; 0 where the search has converged: a step would gain little, or did. */
static int advance(score_search *s, int metric, double *unknown, double *objective, double *damping)
{
  make_normal_equations(s, metric);
  return predicted_gain(s, unknown) >= least_gain && move_on(s, metric, unknown, objective, damping);
}

static double improve(score_search *s, int metric, double *unknown)
{
  double damping = first_damping, objective = calc_objective(s, metric, unknown);
  int i;
  for (i = 0; i < few_iterations && advance(s, metric, unknown, &objective, &damping); ++i) {
  }
  return objective;
}

/* C at a point, factorised. */
static void update_metric(score_search *s, const double *unknown)
{
  const score_problem *problem = s->problem;
  const wide_t *correlation = problem->correlation;
  const int r = problem->scores;
  int w, j, i;
  evaluate(s, METRIC_FULL, unknown);
  for (w = 0; w < problem->windows; ++w) {
    const int first = problem->window[w].first, end = first + problem->window[w].functions;
    problem->calc_stddev(s, w);
    for (j = first; j < end; ++j) {
      s->stddev[j] *= s->widening[w];
    }
  }
  for (j = 0; j < r; ++j) {
    double *column = s->lower + find_column(r, j);
    for (i = j; i < r; ++i) {
      column[i - j] = s->stddev[i] * *correlation++ * s->stddev[j];
    }
    column[0] += 1.0;
  }
  factorise(r, s->lower);
  s->log_determinant = calc_log_determinant(r, s->lower);
}
