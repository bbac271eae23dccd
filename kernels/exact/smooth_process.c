/* A function of a smooth process is
     b'(trend's terms) + sum of w k + sum over the variables v of slopes of w_v g D_v,
   w its weights: of n values, then of the slopes at m points, variable by variable. */

/* Replaces s by k; gives g and h. */
static void calc_smooth(int covariance, int count, double *restrict squares, double *restrict slopes,
                        double *restrict curvatures)
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
    squares[i] = multiply_add(5.0 / 3.0, squares[i], 1.0 + distance) * decay;
  }
}

/* x: over the length scales. */
static void calc_point_covariance(const smooth_process *process, const double *x, const smooth_point *at)
{
  const int n = process->points;
  const wide_t *restrict z = process->scaled_points;
  double *restrict difference = at->differences, *restrict squares = at->squares;
  int v, i;
  for (i = 0; i < n; ++i) {
    squares[i] = 0.0;
  }
  for (v = 0; v < process->variables; ++v, difference += n, z += n) {
    const double along = x[v];
    for (i = 0; i < n; ++i) {
      difference[i] = along - z[i];
      squares[i] = multiply_add(difference[i], difference[i], squares[i]);
    }
  }
  memcpy(at->kernel, squares, sizeof(double) * (size_t)n);
  calc_smooth(process->covariance, n, at->kernel, at->slopes, at->curvatures);
}

/* projected = sum over the variables of w_v D_v, for the weights w of slopes. */
static void project_slopes(const smooth_process *process, const wide_t *restrict w, const smooth_point *at)
{
  const int n = process->points, m = process->slope_points;
  const double *restrict a = at->differences;
  double *restrict sum = at->projected;
  int v = 0, i;
  for (i = 0; i < m; ++i) {
    sum[i] = 0.0;
  }
  for (; v + 3 < process->slope_variables; v += 4, a += 4 * n, w += 4 * m) { /* a quarter of the traffic */
    for (i = 0; i < m; ++i) {
      double value = multiply_add(a[i], w[i], sum[i]);
      value = multiply_add(a[n + i], w[m + i], value);
      value = multiply_add(a[2 * n + i], w[2 * m + i], value);
      sum[i] = multiply_add(a[3 * n + i], w[3 * m + i], value);
    }
  }
  for (; v < process->slope_variables; ++v, a += n, w += m) {
    for (i = 0; i < m; ++i) {
      sum[i] = multiply_add(a[i], w[i], sum[i]);
    }
  }
}

/* Sums of the products of f with four columns, `stride` apart. */
static void dot_four(int count, const double *restrict f, const double *restrict column, int stride, double *sums)
{
  double lane[4][LANES] = {{0.0}};
  const int whole = count / LANES * LANES;
  int i, l, k;
  for (i = 0; i < whole; i += LANES) {
    for (l = 0; l < LANES; ++l) {
      lane[0][l] = multiply_add(column[i + l], f[i + l], lane[0][l]);
      lane[1][l] = multiply_add(column[stride + i + l], f[i + l], lane[1][l]);
      lane[2][l] = multiply_add(column[2 * stride + i + l], f[i + l], lane[2][l]);
      lane[3][l] = multiply_add(column[3 * stride + i + l], f[i + l], lane[3][l]);
    }
  }
  for (k = 0; k < 4; ++k) {
    double sum = add_lanes(lane[k]);
    for (i = whole; i < count; ++i) {
      sum = multiply_add(column[k * stride + i], f[i], sum);
    }
    sums[k] = sum;
  }
}

/* The same of `many` columns; of each in the same order. */
static void dot_columns(int count, const double *f, const double *column, int stride, int many, double *sums)
{
  int c = 0, i, l;
  for (; c + 3 < many; c += 4, column += 4 * stride) { /* f is read once for four */
    dot_four(count, f, column, stride, sums + c);
  }
  for (; c < many; ++c, column += stride) {
    double lane[LANES] = {0.0}, sum;
    for (i = 0; i + LANES <= count; i += LANES) {
      for (l = 0; l < LANES; ++l) {
        lane[l] = multiply_add(column[i + l], f[i + l], lane[l]);
      }
    }
    sum = add_lanes(lane);
    for (; i < count; ++i) {
      sum = multiply_add(column[i], f[i], sum);
    }
    sums[c] = sum;
  }
}

/* A function without its trend; leaves in at->projected what its derivatives need too. */
static double calc_function(const smooth_process *process, const wide_t *weights, const smooth_point *at)
{
  double value = dot(process->points, weights, at->kernel);
  if (process->slope_points > 0) {
    project_slopes(process, weights + process->points, at);
    value += dot(process->slope_points, at->slopes, at->projected);
  }
  return value;
}

/* Derivatives of the function evaluated last with respect to the first `variables`, times their length scales.
   rising: room for as many. */
static void calc_function_slopes(const smooth_process *process, const wide_t *restrict weights, const smooth_point *at,
                                 int variables, double *rising, double *derivatives)
{
  const int n = process->points, m = process->slope_points;
  const int rises = m == 0 ? 0 : process->slope_variables < variables ? process->slope_variables : variables;
  const double *restrict slopes = at->slopes, *restrict curvatures = at->curvatures;
  const double *restrict projected = at->projected;
  double *restrict falling = at->buffer;
  int v, i;
  for (i = 0; i < n; ++i) {
    falling[i] = slopes[i] * weights[i];
  }
  for (i = 0; i < m; ++i) {
    falling[i] = multiply_add(curvatures[i], projected[i], falling[i]);
  }
  dot_columns(n, at->buffer, at->differences, n, variables, derivatives);
  dot_columns(m, slopes, weights + n, m, rises, rising);
  for (v = 0; v < variables; ++v) {
    derivatives[v] = (v < rises ? rising[v] : 0.0) - derivatives[v];
  }
}

/* With more neighbours no error was predicted better; the factor takes as many as tell a variance to a third. */
enum { NEIGHBOURS = 20, FACTOR_NEIGHBOURS = 16 };

/* The nearest points in the order of their distance, without one (-1: none); of equal ones the first comes
   first. At most `wanted`; returns how many. */
static int find_nearest(int n, const double *squares, int without, int wanted, int *order)
{
  int count = 0, i, k;
  for (i = 0; i < n; ++i) {
    if (i == without || (count == wanted && !(squares[i] < squares[order[count - 1]]))) {
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

/* What of the variance of a value others explain: v'K^-1 v, in place. */
static double explain_variance(int count, double covariance[NEIGHBOURS][NEIGHBOURS], double *cross)
{
  double explained = 0.0;
  int i, j, k;
  for (k = 0; k < count; ++k) {
    const double pivot = covariance[k][k], *column = covariance[k];
    double factor;
    if (pivot <= 1e-13) {
      continue; /* rounding: its point says nothing that those before have not said */
    }
    factor = cross[k] / pivot;
    explained = multiply_add(factor, cross[k], explained);
    for (i = k + 1; i < count; ++i) {
      cross[i] = multiply_add(-factor, column[i], cross[i]);
    }
    for (j = k + 1; j < count; ++j) {
      const double share = column[j] / pivot;
      for (i = j; i < count; ++i) {
        covariance[j][i] = multiply_add(-share, column[i], covariance[j][i]);
      }
    }
  }
  return explained;
}

/* The variance, for one of 1, of a value given those at the nearest points alone, but one (-1: none). */
static double calc_local_variance(const smooth_process *process, const smooth_point *at, int without)
{
  double covariance[NEIGHBOURS][NEIGHBOURS], cross[NEIGHBOURS], slopes[NEIGHBOURS], curvatures[NEIGHBOURS];
  const wide_t *z = process->scaled_points;
  int order[NEIGHBOURS], i, j, v;
  const int count = find_nearest(process->points, at->squares, without, NEIGHBOURS, order);
  for (j = 0; j < count; ++j) {
    for (i = j + 1; i < count; ++i) {
      covariance[j][i] = 0.0;
    }
  }
  for (v = 0; v < process->variables; ++v, z += process->points) {
    for (j = 0; j < count; ++j) {
      for (i = j + 1; i < count; ++i) {
        const double apart = z[order[i]] - z[order[j]];
        covariance[j][i] = multiply_add(apart, apart, covariance[j][i]);
      }
    }
  }
  for (j = 0; j < count; ++j) {
    calc_smooth(process->covariance, count - j - 1, covariance[j] + j + 1, slopes, curvatures);
    covariance[j][j] = 1.0 + process->nugget;
    cross[j] = at->kernel[order[j]];
  }
  return fmax(1.0 - explain_variance(count, covariance, cross), 1e-13) + process->nugget;
}

/* The process's own variance, for one of 1, from L^-1 k. trend: its terms at the point; rest: room for as many. */
static double finish_own_variance(const smooth_process *process, const own_variance *own, const double *trend,
                                  const double *solved, double *rest)
{
  const int n = process->points;
  double of_trend = 0.0;
  int i;
  for (i = 0; i < own->terms; ++i) {
    rest[i] = trend[i] - dot(n, own->solved_terms + i * n, solved);
  }
  solve_rows(own->terms, own->term_factor, rest);
  for (i = 0; i < own->terms; ++i) {
    of_trend = multiply_add(rest[i], rest[i], of_trend);
  }
  return fmax(1.0 - dot(n, solved, solved), 1e-14) + process->nugget + of_trend;
}

static double calc_own_variance(const smooth_process *process, const own_variance *own, const double *trend,
                                const smooth_point *at, double *rest)
{
  const int n = process->points;
  double *solved = at->buffer;
  int i;
  for (i = 0; i < own->padded; ++i) {
    solved[i] = i < n ? at->kernel[i] : 0.0;
  }
  solve_tiles(own->padded / CHUNK, own->tiles, solved);
  return finish_own_variance(process, own, trend, solved, rest);
}

/* By how much the errors near a point are beyond their variance; ratios: of each of the points, left out. */
static double calc_local_factor(const smooth_process *process, const wide_t *ratios, const smooth_point *at)
{
  const double of_all = 4.0; /* where all are near, a fifth of the weight is the whole set's */
  const int n = process->points;
  const double *squares = at->squares;
  double *weights = at->buffer, sum = 0.0, width;
  int order[FACTOR_NEIGHBOURS], i;
  width = fmax(squares[order[find_nearest(n, squares, -1, FACTOR_NEIGHBOURS, order) - 1]], 2.2250738585072014e-308);
  for (i = 0; i < n; ++i) {
    weights[i] = exponential(-squares[i] / width);
  }
  for (i = 0; i < n; ++i) {
    sum += weights[i];
  }
  return (dot(n, ratios, weights) + of_all) / (sum + of_all);
}
