/* The map: Gaussian processes from transformed features to the parameters, each summarised by few inputs z.
   What needs all digits follows from the z themselves: their covariance K = L L' is factorised anew at each
   inference. With k the covariances of a point with the z, a = L^-1 k, b = L_B^-1 a:
     mean             c'a + h(x)'b
     latent variance  k(x, x) - a'a + b'b + e'(R R')^-1 e,   e = h(x) - V'b. */
enum { SQUARED_EXPONENTIAL, MATERN_32, MATERN_52, RATIONAL_QUADRATIC };
enum { PROCESS_INPUTS = TWINMAP_INPUTS + TWINMAP_KNOWN };

typedef struct {
  int covariance, inputs, coefficients;
  double signal_variance, shape, noise_variance, jitter;
  const wide_t *center;
  const wide_t *inverse_square;    /* 1 / l^2 of each feature */
  const real_t *points;            /* z, point by point */
  const wide_t *weights;           /* c */
  const real_t *correction;        /* L_B, column by column */
  const wide_t *whitened_basis;    /* V, a column a coefficient */
  const wide_t *basis_factor;      /* R, row by row */
  const wide_t *mean_coefficients; /* b */
  const wide_t *constant_gradient;
  double mean_slope;
} process;

@TABLES@

/* k of unit variance, and -2 dk / dq, from q = r^2. */
static double evaluate_radial(const process *p, double q, double *slope)
{
  double root, decay, value;
  switch (p->covariance) {
    case MATERN_32:
      root = sqrt(3.0 * q);
      decay = exponential(-root);
      *slope = 3.0 * decay;
      return (1.0 + root) * decay;
    case MATERN_52:
      root = sqrt(5.0 * q);
      decay = exponential(-root);
      *slope = 5.0 / 3.0 * (1.0 + root) * decay;
      return (1.0 + root + 5.0 / 3.0 * q) * decay;
    case RATIONAL_QUADRATIC:
      decay = 1.0 + q / (2.0 * p->shape);
      value = exp(-p->shape * log(decay));
      *slope = value / decay;
      return value;
    default:
      *slope = exponential(-0.5 * q);
      return *slope;
  }
}

/* The covariance of two of a process's inputs, or of one with a point. */
static double calc_point_distance(const process *p, const real_t *z, const double *point)
{
  double sum = 0.0;
  int f;
  for (f = 0; f < PROCESS_INPUTS; ++f) {
    const double difference = z[f] - p->center[f] - point[f];
    sum = multiply_add(difference * difference, p->inverse_square[f], sum);
  }
  return sum;
}

static double calc_pair_distance(const process *p, const real_t *a, const real_t *b)
{
  double sum = 0.0;
  int f;
  for (f = 0; f < PROCESS_INPUTS; ++f) {
    const double difference = (double)a[f] - (double)b[f];
    sum = multiply_add(difference * difference, p->inverse_square[f], sum);
  }
  return sum;
}

/* L, packed. */
static void factorise_inputs(const process *p, double *lower)
{
  double *element = lower, slope;
  int i, j;
  for (j = 0; j < p->inputs; ++j) {
    for (i = j; i < p->inputs; ++i, ++element) {
      *element = p->signal_variance * evaluate_radial(p, calc_pair_distance(p, p->points + i * PROCESS_INPUTS,
                                                                            p->points + j * PROCESS_INPUTS), &slope);
      *element += i == j ? p->jitter : 0.0;
    }
  }
  factorise(p->inputs, lower);
}

/* x = L'^-1 x. */
static void solve_transposed(int n, const double *lower, double *x)
{
  const double *column = lower + n * (n + 1) / 2;
  int j;
  for (j = n - 1; j >= 0; --j) {
    column -= n - j;
    x[j] = (x[j] - dot(n - j - 1, column + 1, x + j + 1)) / column[0];
  }
}

/* x = L_B^-1 x. */
static void solve_correction(const process *p, double *x)
{
  const real_t *column = p->correction;
  int j, i;
  for (j = 0; j < p->inputs; column += p->inputs - j, ++j) {
    x[j] /= column[0];
    for (i = 1; i < p->inputs - j; ++i) {
      x[j + i] = multiply_add(-x[j], column[i], x[j + i]);
    }
  }
}

static double basis(int k, const double *point)
{
  return k == 0 ? 1.0 : point[k - 1];
}

static double calc_basis_variance(const process *p, twinmap_state *state)
{
  double *error = state->basis_error, sum = 0.0;
  int i;
  for (i = 0; i < p->coefficients; ++i) {
    error[i] = basis(i, state->point) - dot(p->inputs, p->whitened_basis + i * p->inputs, state->covariances);
  }
  if (p->coefficients > 0) {
    solve_rows(p->coefficients, p->basis_factor, error);
  }
  for (i = 0; i < p->coefficients; ++i) {
    sum = multiply_add(error[i], error[i], sum);
  }
  return sum;
}

/* How much larger the noise of a parameter is where the map is steep than on average. */
static double calc_noise_factor(const process *p, twinmap_state *state)
{
#if TWINMAP_DIRECTIONS
  double *weights = state->distances, sum = 0.0;
  int f, i, r;
  if (!(p->mean_slope > 0.0)) {
    return 1.0;
  }
  for (i = 0; i < p->inputs; ++i) {
    weights[i] = p->weights[i];
  }
  solve_transposed(p->inputs, state->lower_covariance, weights);
  for (f = 0; f < PROCESS_INPUTS; ++f) {
    state->gradient[f] = 0.0;
  }
  for (i = 0; i < p->inputs; ++i) {
    const double weight = p->signal_variance * state->radial_slopes[i] * weights[i];
    for (f = 0; f < PROCESS_INPUTS; ++f) {
      const double difference = p->points[i * PROCESS_INPUTS + f] - p->center[f] - state->point[f];
      state->gradient[f] = multiply_add(weight, difference, state->gradient[f]);
    }
  }
  for (f = 0; f < PROCESS_INPUTS; ++f) {
    state->gradient[f] = multiply_add(state->gradient[f], p->inverse_square[f], p->constant_gradient[f]);
  }
  for (r = 0; r < TWINMAP_DIRECTIONS; ++r) {
    const double slope = dot(PROCESS_INPUTS, noise_directions + r * PROCESS_INPUTS, state->gradient);
    sum = multiply_add(slope, slope, sum);
  }
  return fmax(sum / p->mean_slope, smallest_noise_factor);
#else
  (void)p;
  (void)state;
  return 1.0;
#endif
}

static void infer_parameter(twinmap_state *state, int parameter, twinmap_result *result)
{
  const process *p = &processes[parameter];
  double *a = state->covariances, mean, variance;
  int i;
  for (i = 0; i < PROCESS_INPUTS; ++i) {
    state->point[i] = state->inputs[i] - p->center[i];
  }
  for (i = 0; i < p->inputs; ++i) {
    const double q = calc_point_distance(p, p->points + i * PROCESS_INPUTS, state->point);
    a[i] = p->signal_variance * evaluate_radial(p, q, &state->radial_slopes[i]);
  }
  factorise_inputs(p, state->lower_covariance);
  solve_columns(p->inputs, state->lower_covariance, a);
  mean = dot(p->inputs, p->weights, a);
  for (i = 0; i < p->coefficients; ++i) {
    mean = multiply_add(p->mean_coefficients[i], basis(i, state->point), mean);
  }
  variance = p->signal_variance - dot(p->inputs, a, a);
  solve_correction(p, a);
  variance += dot(p->inputs, a, a) + calc_basis_variance(p, state);
  variance = fmax(variance, 0.0) + p->noise_variance * calc_noise_factor(p, state);
  result->mean[parameter] = multiply_add(target_scale[parameter], mean, target_offset[parameter]);
  result->sd[parameter] = target_scale[parameter] * sqrt(variance);
  result->ratio_to_limit[parameter] = 0.0;
}

static void infer_by_map(twinmap_state *state, const double *known, twinmap_result *result)
{
  int p;
  transform_features(state, known);
  for (p = 0; p < TWINMAP_PARAMETERS; ++p) {
    infer_parameter(state, p, result);
  }
}
