/* The processes from parameters to scores (features in units of their noise, projected): a window of scores
   shares a covariance function, its length scales and a trend. With D = (x - z) / l, s = |D|^2, k(s), g = -2
   k', h = -2 g': a score is
     b'(trend's terms) + sum of w k + sum over the variables v of slopes w_v g D_v. */
enum { SMOOTH_EXPONENTIAL, SMOOTH_MATERN_52 };

typedef struct {
  int first, functions;             /* its scores */
  int leading;                      /* of them, from the first on, those that the first search looks at */
  int slope_points, slope_variables; /* whose slopes were learnt too */
  int covariance, quadratic, terms;
  double nugget;
  const wide_t *length_scales;   /* of each variable */
  const wide_t *scaled_points;   /* z / l, variable by variable */
  const wide_t *weights;         /* of each score: of values, then of slopes variable by variable */
  const wide_t *coefficients;    /* of each score: of the terms */
  const wide_t *amplitudes;      /* of each score: its variance where the process's is 1 */
  const wide_t *left_out_ratios; /* of each point, left out: squared error over variance */
  const wide_t *factor;          /* of the covariance, in tiles; NULL: the variance is that of the nearest points */
  const wide_t *solved_terms;    /* L^-1 H', term by term */
  const wide_t *term_factor;     /* lower factor, row by row */
} window;

@TABLES@

/* Replaces s by k; gives g and h. */
static void calc_smooth(int covariance, int count, double *squares, double *slopes, double *curvatures)
{
  int i;
  if (covariance == SMOOTH_EXPONENTIAL) {
    for (i = 0; i < count; ++i) {
      squares[i] = exponential(-0.5 * squares[i]);
      slopes[i] = squares[i];
      curvatures[i] = squares[i];
    }
    return;
  }
  for (i = 0; i < count; ++i) {
    const double distance = sqrt(5.0 * squares[i]), decay = exponential(-distance);
    curvatures[i] = 25.0 / 3.0 * decay;
    slopes[i] = 5.0 / 3.0 * (1.0 + distance) * decay;
    squares[i] = (multiply_add(5.0 / 3.0, squares[i], 1.0 + distance)) * decay;
  }
}

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

/* Where a window's buffers begin. */
static double *differences_of(twinmap_state *state, int index)
{
  return state->differences + index * TWINMAP_VARIABLES * TWINMAP_POINTS;
}

static void calc_point_covariance(twinmap_state *state, int index)
{
  const window *w = &windows[index];
  double *squares = state->squares + index * TWINMAP_POINTS, *kernel = state->kernel + index * TWINMAP_POINTS;
  double *difference = differences_of(state, index);
  int v, i;
  for (i = 0; i < TWINMAP_POINTS; ++i) {
    squares[i] = 0.0;
  }
  for (v = 0; v < TWINMAP_VARIABLES; ++v, difference += TWINMAP_POINTS) {
    const double at = state->at[v] / w->length_scales[v];
    const wide_t *z = w->scaled_points + v * TWINMAP_POINTS;
    for (i = 0; i < TWINMAP_POINTS; ++i) {
      difference[i] = at - z[i];
      squares[i] = multiply_add(difference[i], difference[i], squares[i]);
    }
  }
  for (i = 0; i < TWINMAP_POINTS; ++i) {
    kernel[i] = squares[i];
  }
  calc_smooth(w->covariance, TWINMAP_POINTS, kernel, state->kernel_slopes + index * TWINMAP_POINTS,
              state->curvatures + index * TWINMAP_POINTS);
}

/* Score j of a window at state->at; leaves in state->projected the sums over the variables that its derivatives
   need too. */
static double evaluate_score(twinmap_state *state, int index, int j)
{
  const window *w = &windows[index];
  const int m = w->slope_points;
  const wide_t *weights = w->weights + j * (TWINMAP_POINTS + m * w->slope_variables);
  const double *difference = differences_of(state, index);
  double *sum = state->projected;
  double value = dot_table(w->terms, w->coefficients + j * w->terms, state->terms + index * TWINMAP_TERMS);
  int v, i;
  value += dot_table(TWINMAP_POINTS, weights, state->kernel + index * TWINMAP_POINTS);
  if (m > 0) {
    weights += TWINMAP_POINTS;
    for (i = 0; i < m; ++i) {
      sum[i] = difference[i] * weights[i];
    }
    for (v = 1; v + 1 < w->slope_variables; v += 2) { /* two at a time: half the traffic */
      const double *other = difference + 2 * TWINMAP_POINTS;
      difference += TWINMAP_POINTS;
      weights += m;
      for (i = 0; i < m; ++i) {
        sum[i] = multiply_add(other[i], weights[m + i], multiply_add(difference[i], weights[i], sum[i]));
      }
      difference = other;
      weights += m;
    }
    for (; v < w->slope_variables; ++v) {
      difference += TWINMAP_POINTS;
      weights += m;
      for (i = 0; i < m; ++i) {
        sum[i] = multiply_add(difference[i], weights[i], sum[i]);
      }
    }
    value += dot(m, state->kernel_slopes + index * TWINMAP_POINTS, sum);
  }
  return value;
}

/* Its derivatives with respect to the unknowns, into the jacobian. */
static void derive_score(twinmap_state *state, int index, int j)
{
  const window *w = &windows[index];
  const int m = w->slope_points;
  const wide_t *weights = w->weights + j * (TWINMAP_POINTS + m * w->slope_variables);
  const double *slopes = state->kernel_slopes + index * TWINMAP_POINTS;
  const double *curvatures = state->curvatures + index * TWINMAP_POINTS;
  double *falling = state->buffer;
  int v, i;
  for (i = 0; i < TWINMAP_POINTS; ++i) {
    falling[i] = slopes[i] * weights[i];
  }
  for (i = 0; i < m; ++i) {
    falling[i] = multiply_add(curvatures[i], state->projected[i], falling[i]);
  }
  for (v = 0; v < TWINMAP_UNKNOWN; ++v) {
    double slope = -dot(TWINMAP_POINTS, differences_of(state, index) + v * TWINMAP_POINTS, falling);
    if (v < w->slope_variables) {
      slope += dot_table(m, weights + TWINMAP_POINTS + v * m, slopes);
    }
    state->jacobian[v * TWINMAP_SCORES + w->first + j] =
        slope / w->length_scales[v] +
        dot_table(w->terms, w->coefficients + j * w->terms, state->term_derivatives + v * w->terms);
  }
}

/* The first `count` scores of a window at state->at, with their derivatives: each score's weights are read from
   memory once. */
static void evaluate_window(twinmap_state *state, int index, int count)
{
  const window *w = &windows[index];
  int j;
  calc_point_covariance(state, index);
  calc_terms(w, state->at, state->terms + index * TWINMAP_TERMS);
  calc_term_derivatives(w, state->at, state->term_derivatives);
  for (j = 0; j < count; ++j) {
    state->values[w->first + j] = evaluate_score(state, index, j);
    derive_score(state, index, j);
  }
}

enum { NEIGHBOURS = 20, FACTOR_NEIGHBOURS = 16 };

/* The nearest points in the order of their distance; of equal ones the first comes first. */
static int find_nearest(const double *squares, int wanted, int *order)
{
  int count = 0, i, k;
  for (i = 0; i < TWINMAP_POINTS; ++i) {
    if (count == wanted && !(squares[i] < squares[order[count - 1]])) {
      continue;
    }
    k = count < wanted ? count++ : count - 1;
    for (; k > 0 && squares[i] < squares[order[k - 1]]; --k) {
      order[k] = order[k - 1];
    }
    order[k] = i;
  }
  return count;
}

/* The variance, for one of 1, of a value given those at the nearest points alone. */
static double calc_local_variance(const window *w, const double *squares, const double *kernel)
{
  double covariance[NEIGHBOURS][NEIGHBOURS], cross[NEIGHBOURS], column[NEIGHBOURS], slope, curvature;
  double explained = 0.0;
  int order[NEIGHBOURS], i, j, k, v;
  const int count = find_nearest(squares, NEIGHBOURS, order);
  for (j = 0; j < count; ++j) {
    covariance[j][j] = 1.0 + w->nugget;
    cross[j] = kernel[order[j]];
    for (i = j + 1; i < count; ++i) {
      double square = 0.0;
      for (v = 0; v < TWINMAP_VARIABLES; ++v) {
        const double apart =
            w->scaled_points[v * TWINMAP_POINTS + order[i]] - w->scaled_points[v * TWINMAP_POINTS + order[j]];
        square = multiply_add(apart, apart, square);
      }
      covariance[j][i] = square;
    }
  }
  for (j = 0; j < count; ++j) {
    for (i = j + 1; i < count; ++i) {
      calc_smooth(w->covariance, 1, &covariance[j][i], &slope, &curvature);
    }
  }
  for (k = 0; k < count; ++k) {
    const double pivot = covariance[k][k];
    double factor;
    if (pivot <= 1e-13) {
      continue; /* rounding: its point says nothing that those before have not said */
    }
    factor = cross[k] / pivot;
    explained = multiply_add(factor, cross[k], explained);
    for (i = k + 1; i < count; ++i) {
      column[i] = covariance[k][i];
      cross[i] = multiply_add(-factor, column[i], cross[i]);
    }
    for (j = k + 1; j < count; ++j) {
      const double share = column[j] / pivot;
      for (i = j; i < count; ++i) {
        covariance[j][i] = multiply_add(-share, column[i], covariance[j][i]);
      }
    }
  }
  return fmax(1.0 - explained, 1e-13) + w->nugget;
}

static double calc_own_variance(twinmap_state *state, const window *w, const double *kernel, const double *terms)
{
  double rest[TWINMAP_TERMS], of_trend = 0.0;
  double *solved = state->buffer;
  int i;
  memset(solved, 0, sizeof(double) * TWINMAP_PADDED_POINTS);
  for (i = 0; i < TWINMAP_POINTS; ++i) {
    solved[i] = kernel[i];
  }
  solve_tiles(TWINMAP_PADDED_POINTS / CHUNK, w->factor, solved);
  for (i = 0; i < w->terms; ++i) {
    rest[i] = terms[i] - dot_table(TWINMAP_POINTS, w->solved_terms + i * TWINMAP_POINTS, solved);
  }
  solve_rows(w->terms, w->term_factor, rest);
  for (i = 0; i < w->terms; ++i) {
    of_trend = multiply_add(rest[i], rest[i], of_trend);
  }
  return fmax(1.0 - dot(TWINMAP_POINTS, solved, solved), 1e-14) + w->nugget + of_trend;
}

/* By how much the errors near a point, left out, are beyond their variance. */
static double calc_local_factor(twinmap_state *state, const window *w, const double *squares)
{
  const double of_all = 4.0; /* where all are near, a fifth of the weight is the whole set's */
  int order[FACTOR_NEIGHBOURS], i;
  const int reach = find_nearest(squares, FACTOR_NEIGHBOURS, order) - 1;
  const double width = fmax(squares[order[reach]], 2.2250738585072014e-308);
  double above, sum = 0.0;
  for (i = 0; i < TWINMAP_POINTS; ++i) {
    state->buffer[i] = exponential(-squares[i] / width);
  }
  above = dot_table(TWINMAP_POINTS, w->left_out_ratios, state->buffer);
  for (i = 0; i < TWINMAP_POINTS; ++i) {
    sum += state->buffer[i];
  }
  return (above + of_all) / (sum + of_all);
}

/* The standard deviations of a window's scores, at the point evaluated last. */
static void calc_window_stddev(twinmap_state *state, int index)
{
  const window *w = &windows[index];
  const double *squares = state->squares + index * TWINMAP_POINTS, *kernel = state->kernel + index * TWINMAP_POINTS;
  const double variance = w->factor ? calc_own_variance(state, w, kernel, state->terms + index * TWINMAP_TERMS)
                                    : calc_local_variance(w, squares, kernel);
  const double scaled = variance * calc_local_factor(state, w, squares);
  int j;
  for (j = 0; j < w->functions; ++j) {
    state->stddev[w->first + j] = sqrt(scaled * w->amplitudes[j]);
  }
}
