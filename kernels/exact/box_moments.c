/* Mean and covariance of exp(-x'Q x / 2 + b'x) within the box [-1, 1]^u, by expectation propagation: one
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

/* The normal factors that stand for the bounds, and room for a factorisation. */
typedef struct {
  double *precision, *shift, *sum, *small; /* u, u, u, u x u */
} box_factors;

/* The moments with the factors as they are. */
static void update_moments(int u, const box_factors *factors, const double *precision, const double *shift,
                           double *mean, double *covariance)
{
  int i, j;
  memcpy(factors->small, precision, sizeof(double) * (size_t)(u * u));
  for (i = 0; i < u; ++i) {
    factors->small[i * u + i] += factors->precision[i];
    factors->sum[i] = shift[i] + factors->shift[i];
  }
  (void)factorise_small(u, factors->small, factors->small);
  for (j = 0; j < u; ++j) {
    double *column = covariance + j * u; /* symmetric: a row as well */
    for (i = 0; i < u; ++i) {
      column[i] = i == j ? 1.0 : 0.0;
    }
    solve_small(u, factors->small, column);
  }
  for (i = 0; i < u; ++i) {
    mean[i] = dot(u, covariance + i * u, factors->sum);
  }
}

/* The same after the precision of factor k alone has grown by `grown`, from the covariance before: u^2 flops
   instead of u^3. 0, and nothing done, where rounding would be a hundred times what it is then. */
static int move_moments(int u, const box_factors *factors, int k, double grown, const double *shift, double *mean,
                        double *covariance)
{
  const double least = 0.01;
  double *before = factors->small;
  const double share = multiply_add(grown, covariance[k * u + k], 1.0);
  int i, j;
  if (!(share > least)) {
    return 0;
  }
  memcpy(before, covariance + k * u, sizeof(double) * (size_t)u);
  for (j = 0; j < u; ++j) {
    const double factor = -grown / share * before[j];
    for (i = 0; i < u; ++i) {
      covariance[j * u + i] = multiply_add(factor, before[i], covariance[j * u + i]);
    }
  }
  factors->sum[k] = shift[k] + factors->shift[k];
  for (i = 0; i < u; ++i) {
    mean[i] = dot(u, covariance + i * u, factors->sum);
  }
  return 1;
}

/* buffer: u (u + 3). */
static void calc_box_moments(int u, const double *precision, const double *shift, double *buffer, double *mean,
                             double *covariance)
{
  const double tolerance = 1e-4, least_precision = 1e-9;
  box_factors factors;
  int sweep, k;
  factors.precision = buffer;
  factors.shift = buffer + u;
  factors.sum = buffer + 2 * u;
  factors.small = buffer + 3 * u;
  for (k = 0; k < u; ++k) {
    factors.precision[k] = half_width_information;
    factors.shift[k] = 0.0;
  }
  update_moments(u, &factors, precision, shift, mean, covariance);
  for (sweep = 0; sweep < 20; ++sweep) {
    double moved = 0.0;
    for (k = 0; k < u; ++k) {
      const double variance = covariance[k * u + k], before = mean[k], precise = factors.precision[k];
      const double q = fmax(1.0 / variance - factors.precision[k], 0.0);
      const double b = before / variance - factors.shift[k];
      double found_mean, found_variance;
      calc_interval_moments(q, b, &found_mean, &found_variance);
      factors.precision[k] = fmax(1.0 / found_variance - q, least_precision);
      factors.shift[k] = found_mean / found_variance - b;
      moved = fmax(moved, fabs(found_mean - before) / sqrt(variance) + fabs(found_variance / variance - 1.0));
      if (k == u - 1 || !move_moments(u, &factors, k, factors.precision[k] - precise, shift, mean, covariance)) {
        update_moments(u, &factors, precision, shift, mean, covariance);
      }
    }
    if (moved < tolerance) {
      break;
    }
  }
}
