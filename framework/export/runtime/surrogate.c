/* The processes from parameters to scores (features in units of their noise, projected): a window of scores
   shares a covariance function, its length scales and a trend. */
typedef struct {
  int quadratic, terms; /* the trend */
  smooth_process process;
  own_variance own;              /* without tiles: the variance is that of the nearest points */
  const wide_t *length_scales;   /* of each variable */
  const wide_t *weights;         /* of each score */
  const wide_t *coefficients;    /* of each score: of the trend's terms */
  const wide_t *amplitudes;      /* of each score: its variance where the process's is 1 */
  const wide_t *left_out_ratios; /* of each point, left out: squared error over variance */
} window;

@TABLES@

static void calc_terms(const window *w, const double *point, double *terms)
{
  int a, b, row = TWINMAP_VARIABLES + 1;
  terms[0] = 1.0;
  for (a = 0; a < TWINMAP_VARIABLES; ++a) {
    terms[a + 1] = point[a];
  }
  for (a = 0; a < TWINMAP_VARIABLES && w->quadratic; ++a) {
    for (b = a; b < TWINMAP_VARIABLES; ++b) {
      terms[row++] = point[a] * point[b];
    }
  }
}

/* Of the terms, variable by variable. */
static void calc_term_derivatives(const window *w, const double *point, double *derivatives)
{
  int a, b, row = TWINMAP_VARIABLES + 1;
  memset(derivatives, 0, sizeof(double) * (size_t)(w->terms * TWINMAP_VARIABLES));
  for (a = 0; a < TWINMAP_VARIABLES; ++a) {
    derivatives[a * w->terms + a + 1] = 1.0;
  }
  for (a = 0; a < TWINMAP_VARIABLES && w->quadratic; ++a) {
    for (b = a; b < TWINMAP_VARIABLES; ++b, ++row) {
      derivatives[a * w->terms + row] += point[b];
      derivatives[b * w->terms + row] += point[a];
    }
  }
}

static smooth_point find_point(twinmap_state *state, int index)
{
  const int first = index * TWINMAP_POINTS;
  smooth_point at;
  at.differences = state->differences + first * TWINMAP_VARIABLES;
  at.squares = state->squares + first;
  at.kernel = state->kernel + first;
  at.slopes = state->kernel_slopes + first;
  at.curvatures = state->curvatures + first;
  at.projected = state->projected;
  at.buffer = state->buffer;
  return at;
}

/* Score j of a window, of all the number `score`, at search->at and its derivatives with respect to the unknowns:
   each score's weights are read from memory once. */
static void evaluate_score(const score_search *search, const window *w, int j, int score, const smooth_point *at,
                           const double *terms)
{
  const twinmap_state *state = search->owner;
  const smooth_process *process = &w->process;
  const wide_t *weights = w->weights + j * (process->points + process->slope_points * process->slope_variables);
  const wide_t *coefficients = w->coefficients + j * w->terms;
  double derivatives[TWINMAP_UNKNOWN], rising[TWINMAP_UNKNOWN];
  int v;
  search->values[score] = dot(w->terms, coefficients, terms) + calc_function(process, weights, at);
  calc_function_slopes(process, weights, at, TWINMAP_UNKNOWN, rising, derivatives);
  for (v = 0; v < TWINMAP_UNKNOWN; ++v) {
    search->jacobian[v * TWINMAP_SCORES + score] =
        derivatives[v] / w->length_scales[v] + dot(w->terms, coefficients, state->term_derivatives + v * w->terms);
  }
}

/* The first `count` scores of a window. */
static void evaluate_window(const score_search *search, int index, int count)
{
  twinmap_state *state = search->owner;
  const window *w = &windows[index];
  const smooth_point at = find_point(state, index);
  double scaled[TWINMAP_VARIABLES];
  int j, v;
  for (v = 0; v < TWINMAP_VARIABLES; ++v) {
    scaled[v] = search->at[v] / w->length_scales[v];
  }
  calc_point_covariance(&w->process, scaled, &at);
  calc_terms(w, search->at, state->terms + index * TWINMAP_TERMS);
  calc_term_derivatives(w, search->at, state->term_derivatives);
  for (j = 0; j < count; ++j) {
    evaluate_score(search, w, j, score_windows[index].first + j, &at, state->terms + index * TWINMAP_TERMS);
  }
}

/* The standard deviations of a window's scores, at the point evaluated last. */
static void calc_window_stddev(const score_search *search, int index)
{
  twinmap_state *state = search->owner;
  const window *w = &windows[index];
  const smooth_point at = find_point(state, index);
  double rest[TWINMAP_TERMS], variance;
  int j;
  if (w->own.tiles) {
    variance = calc_own_variance(&w->process, &w->own, state->terms + index * TWINMAP_TERMS, &at, rest);
  } else {
    variance = calc_local_variance(&w->process, &at, -1);
  }
  variance *= calc_local_factor(&w->process, w->left_out_ratios, &at);
  for (j = 0; j < score_windows[index].functions; ++j) {
    search->stddev[score_windows[index].first + j] = sqrt(variance * w->amplitudes[j]);
  }
}

static const score_problem problem = {
    TWINMAP_SCORES, TWINMAP_UNKNOWN, TWINMAP_VARIABLES, TWINMAP_WINDOWS, TWINMAP_POINTS,
    score_windows, rough_weights, leading_weights, score_correlation, prior_mean, prior_relative,
    training_points, training_scores, evaluate_window, calc_window_stddev};

/* For the unknowns that explain the features. */
static score_search begin_search(twinmap_state *state, const double *known)
{
  score_search search = lay_out_search(&problem, state, state->search);
  calc_scores(state->features, search.scores);
  set_known(known, search.at);
  return search;
}
