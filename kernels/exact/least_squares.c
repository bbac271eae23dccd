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

/* What a normal prior draws x with, over half_width_information: its relative information, u x u, times the
   offset of x from its mean. */
static void calc_pull(int u, const wide_t *relative, const wide_t *mean, const double *x, double *offset, double *pull)
{
  int v;
  for (v = 0; v < u; ++v) {
    offset[v] = x[v] - mean[v];
  }
  for (v = 0; v < u; ++v) {
    pull[v] = dot(u, relative + v * u, offset);
  }
}

/* The step, in place of J'residual, under a prior of relative information (u x u) that draws with `pull`; 0
   where the damped information is not positive definite. small: u x u. */
static int solve_step(int u, const double *information, const wide_t *relative, const double *pull, double damping,
                      double *small, double *step)
{
  int v, i;
  for (v = 0; v < u; ++v) {
    for (i = 0; i < u; ++i) {
      const double known = information[v * u + i];
      const double prior = half_width_information * relative[v * u + i];
      small[v * u + i] = known + (i == v ? multiply_add(damping, known, prior) : prior);
    }
    step[v] = multiply_add(-half_width_information, pull[v], step[v]);
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
