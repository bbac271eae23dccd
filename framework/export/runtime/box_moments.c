/* Mean and covariance of exp(-x'Q x / 2 + b'x) within the box [-1, 1]^U, by expectation propagation: one
   normal factor for each variable's two bounds. */
static void calc_interval_moments(double q, double b, double *mean, double *variance)
{
  const int intervals = 64;   /* of Simpson's rule */
  const double reach = 16.0;  /* widths of the normal or the exponential that it is near its mode */
  const double mode = q > 0.0 ? fmin(fmax(b / q, -1.0), 1.0) : (b > 0.0 ? 1.0 : -1.0);
  const double slope = fabs(b - q * mode), width = 1.0 / fmax(fmax(slope, sqrt(q)), 1e-3);
  const double lower = fmax(-1.0, mode - reach * width), upper = fmin(1.0, mode + reach * width);
  const double step = (upper - lower) / intervals, linear = b - q * mode;
  double sum = 0.0, first = 0.0, second = 0.0, shift;
  int i;
  for (i = 0; i <= intervals; ++i) {
    const double d = lower + i * step - mode;
    const double weight = (i == 0 || i == intervals) ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
    const double density = weight * exp(linear * d - 0.5 * q * d * d);
    sum += density;
    first += density * d;
    second += density * d * d;
  }
  shift = first / sum;
  *mean = mode + shift;
  *variance = second / sum - shift * shift;
}

/* The moments with the factors as they are. */
static void update_moments(twinmap_state *state, const double *precision, const double *shift, double *mean,
                           double *covariance)
{
  int i, j;
  memcpy(state->small, precision, sizeof state->small);
  for (i = 0; i < U; ++i) {
    state->small[i * U + i] += state->factor_precision[i];
  }
  (void)factorise_small(state->small, state->small);
  for (j = 0; j < U; ++j) {
    double *column = covariance + j * U; /* symmetric: a row as well */
    for (i = 0; i < U; ++i) {
      column[i] = i == j ? 1.0 : 0.0;
    }
    solve_small(state->small, column);
  }
  for (i = 0; i < U; ++i) {
    state->step[i] = shift[i] + state->factor_shift[i];
  }
  for (i = 0; i < U; ++i) {
    mean[i] = dot(U, covariance + i * U, state->step);
  }
}

static void calc_box_moments(twinmap_state *state, const double *precision, const double *shift, double *mean,
                             double *covariance)
{
  const double tolerance = 1e-4, least_precision = 1e-9;
  int sweep, k;
  for (k = 0; k < U; ++k) {
    state->factor_precision[k] = half_width_information;
    state->factor_shift[k] = 0.0;
  }
  update_moments(state, precision, shift, mean, covariance);
  for (sweep = 0; sweep < 20; ++sweep) {
    double moved = 0.0;
    for (k = 0; k < U; ++k) {
      const double variance = covariance[k * U + k], before = mean[k];
      const double q = fmax(1.0 / variance - state->factor_precision[k], 0.0);
      const double b = before / variance - state->factor_shift[k];
      double found_mean, found_variance;
      calc_interval_moments(q, b, &found_mean, &found_variance);
      state->factor_precision[k] = fmax(1.0 / found_variance - q, least_precision);
      state->factor_shift[k] = found_mean / found_variance - b;
      moved = fmax(moved, fabs(found_mean - before) / sqrt(variance) + fabs(found_variance / variance - 1.0));
      update_moments(state, precision, shift, mean, covariance);
    }
    if (moved < tolerance) {
      break;
    }
  }
}
