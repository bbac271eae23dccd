/* A step of Levenberg and Marquardt's method for r residuals and u unknowns that have a normal prior; what is
   u x u is symmetric. */

static const double half_width_information = 3.0; /* 1 / variance of a variable that is uniform on [-1, 1] */

/* J'J for J of r x u, variable by variable. */
static void calc_information(int r, int u, const double *jacobian, double *information)
{
  int a, b;
  for (a = 0; a < u; ++a) {
    for (b = 0; b <= a; ++b) {
      information[a * u + b] = dot(r, jacobian + a * r, jacobian + b * r);
      information[b * u + a] = information[a * u + b];
    }
  }
}

/* The step, in place of J'residual; 0 where the damped information is not positive definite. small: u x u. */
static int solve_step(int u, const double *information, const double *unknown, double damping, double *small,
                      double *step)
{
  int v;
  memcpy(small, information, sizeof(double) * (size_t)(u * u));
  for (v = 0; v < u; ++v) {
    small[v * u + v] += multiply_add(damping, small[v * u + v], half_width_information);
    step[v] = multiply_add(-half_width_information, unknown[v], step[v]);
  }
  if (!factorise_small(u, small, small)) {
    return 0;
  }
  solve_small(u, small, step);
  return 1;
}

/* Four standard deviations above the mean of chi-square: one in 10000 by chance. */
static int is_misfit(double chi_square, int count)
{
  return chi_square > count + 4.0 * sqrt(2.0 * count);
}

/* By how much the errors of `count` scores are to be enlarged to explain the residuals; 0: they do so already.
   stddev: of the errors; the noise has 1. */
static double calc_widening(int count, const double *stddev, const double *scores, const double *values)
{
  double misfit = 0.0, squares = 0.0, variances = 0.0;
  int i;
  for (i = 0; i < count; ++i) {
    const double variance = stddev[i] * stddev[i], difference = scores[i] - values[i];
    const double square = difference * difference;
    misfit += square / (1.0 + variance);
    squares += square;
    variances += variance;
  }
  return is_misfit(misfit, count) ? sqrt(fmax(1.0, (squares / count - 1.0) / (variances / count))) : 0.0;
}
