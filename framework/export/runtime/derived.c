/* What follows from the parameters: their names, units, and the expressions themselves. */
@TABLES@
/* The values at a point of the parameters, one operation after another as the experiment's expressions say. */
static void calc_derived(const double *parameters, double *values)
{
@EXPRESSIONS@}

static void calc_derived_gradient(const double *at, int quantity, double *gradient)
{
  double moved[TWINMAP_PARAMETERS], above[TWINMAP_DERIVED], below[TWINMAP_DERIVED];
  int a;
  memcpy(moved, at, sizeof moved);
  for (a = 0; a < TWINMAP_PARAMETERS; ++a) {
    moved[a] = at[a] + derived_step[a];
    calc_derived(moved, above);
    moved[a] = at[a] - derived_step[a];
    calc_derived(moved, below);
    moved[a] = at[a];
    gradient[a] = (above[quantity] - below[quantity]) / (2.0 * derived_step[a]);
  }
}

/* The way of one standard deviation of the quantity, through the parameters that are likeliest for each of its
   values: covariance times gradient. Returns that standard deviation, to first order. */
static double calc_derived_way(const twinmap_result *result, int quantity, double *way)
{
  double gradient[TWINMAP_PARAMETERS], variance = 0.0;
  int a, b;
  calc_derived_gradient(result->mean, quantity, gradient);
  for (a = 0; a < TWINMAP_PARAMETERS; ++a) {
    way[a] = 0.0;
    for (b = 0; b < TWINMAP_PARAMETERS; ++b) {
      way[a] += result->covariance[a * TWINMAP_PARAMETERS + b] * gradient[b];
    }
    variance += gradient[a] * way[a];
  }
  for (a = 0; a < TWINMAP_PARAMETERS; ++a) {
    way[a] /= sqrt(variance);
  }
  return sqrt(variance);
}

/* The value so many standard deviations along the way, within the bounds. */
static double calc_derived_at(const twinmap_result *result, int quantity, const double *way, double along)
{
  double at[TWINMAP_PARAMETERS], values[TWINMAP_DERIVED];
  int a;
  for (a = 0; a < TWINMAP_PARAMETERS; ++a) {
    const double lower = fmin(derived_lower[a], result->mean[a]), upper = fmax(derived_upper[a], result->mean[a]);
    at[a] = fmax(lower, fmin(upper, result->mean[a] + along * way[a]));
  }
  calc_derived(at, values);
  return values[quantity];
}

void twinmap_derive(const twinmap_result *result, twinmap_derived *derived)
{
  int k, i;
  for (k = 0; k < TWINMAP_DERIVED; ++k) {
    double way[TWINMAP_PARAMETERS], sum = 0.0, first = 0.0, second = 0.0;
    const double stddev = calc_derived_way(result, k, way);
    double middle, lower, upper;
    if (!(stddev > 0.0 && stddev <= 1.7976931348623157e308)) {
      derived->mean[k] = derived->sd[k] = derived->lower[k] = derived->upper[k] = NAN;
      continue;
    }
    middle = calc_derived_at(result, k, way, 0.0);
    lower = fmin(calc_derived_at(result, k, way, -derived_factor), calc_derived_at(result, k, way, derived_factor));
    upper = fmax(calc_derived_at(result, k, way, -derived_factor), calc_derived_at(result, k, way, derived_factor));
    for (i = -120; i <= 120; ++i) {
      const double along = 0.05 * i, value = calc_derived_at(result, k, way, along);
      if (fabs(value) <= 1.7976931348623157e308) {
        const double weight = exp(-0.5 * along * along);
        sum += weight;
        first += weight * (value - middle);
        second += weight * (value - middle) * (value - middle);
        if (fabs(along) <= derived_factor) {
          lower = fmin(lower, value);
          upper = fmax(upper, value);
        }
      }
    }
    derived->mean[k] = middle + first / sum;
    derived->sd[k] = sqrt(second / sum - (first / sum) * (first / sum));
    derived->lower[k] = lower;
    derived->upper[k] = upper;
  }
}
