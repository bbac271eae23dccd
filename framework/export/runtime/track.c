/* A belief over the parameters in time. It is what kernels/tracking does, function by function: Kalman's filter,
   rates of walks integrated over a bank of filters, sums of likelihood ratios for changes. */
@TABLES@

enum {
  P = TWINMAP_PARAMETERS,
  N = TWINMAP_TRACK_STATES,
  SLOPES = TWINMAP_TRACK_SLOPES,
  FOLLOWS = TWINMAP_TRACK_FOLLOWS,
  CONDITIONS = TWINMAP_TRACK_CONDITIONS,
  UNKNOWN = TWINMAP_TRACK_UNKNOWN,
  RATES = TWINMAP_TRACK_RATES,
  OCTAVES = TWINMAP_TRACK_OCTAVES,
  PARTS = (OCTAVES - 1) / (RATES - 1), /* of an octave */
  PLACES = TWINMAP_TRACK_PLACES,
  WINDOW = TWINMAP_TRACK_WINDOW
};

static const double bad_share = 0.05; /* of measurements that say nothing */
static const double pi = 3.14159265358979324, log_two = 0.69314718055994531;
static const double normal95 = 1.959963984540054;

typedef twinmap_track_belief belief_t;
typedef twinmap_track_supposed supposed_t;

static int is_number(double x) { return fabs(x) <= 1.7976931348623157e308; }

static double dot(const double *a, const double *b, int count)
{
  double sum = 0.0;
  int i;
  for (i = 0; i < count; ++i) {
    sum += a[i] * b[i];
  }
  return sum;
}

/* The likelihood of an estimate. */

static double to_coordinate(int j, double value)
{
  return ((is_logarithm[j] ? log(value) : value) - center[j]) / half_width[j];
}

static double to_value(int j, double coordinate)
{
  const double value = center[j] + half_width[j] * coordinate;
  return is_logarithm[j] ? exp(value) : value;
}

/* d value / d coordinate. */
static double calc_unit(int j, double value) { return half_width[j] * (is_logarithm[j] ? value : 1.0); }

/* Eigenvalues onto the diagonal of a symmetric matrix, by rotations of Jacobi; eigenvectors in columns. */
static void diagonalize(double *a, double *vectors)
{
  int sweep, i, j, k;
  for (i = 0; i < P; ++i) {
    for (j = 0; j < P; ++j) {
      vectors[i * P + j] = i == j;
    }
  }
  for (sweep = 0; sweep < TWINMAP_TRACK_SWEEPS; ++sweep) {
    for (i = 0; i < P - 1; ++i) {
      for (j = i + 1; j < P; ++j) {
        const double off = a[i * P + j];
        double half, t, c, s;
        if (fabs(off) <= 1e-18 * sqrt(fabs(a[i * P + i] * a[j * P + j]))) {
          continue;
        }
        half = 0.5 * (a[j * P + j] - a[i * P + i]) / off;
        t = (half < 0.0 ? -1.0 : 1.0) / (fabs(half) + sqrt(half * half + 1.0));
        c = 1.0 / sqrt(t * t + 1.0);
        s = t * c;
        for (k = 0; k < P; ++k) {
          const double of_i = a[k * P + i], of_j = a[k * P + j];
          a[k * P + i] = c * of_i - s * of_j;
          a[k * P + j] = s * of_i + c * of_j;
        }
        for (k = 0; k < P; ++k) {
          const double of_i = a[i * P + k], of_j = a[j * P + k];
          a[i * P + k] = c * of_i - s * of_j;
          a[j * P + k] = s * of_i + c * of_j;
        }
        for (k = 0; k < P; ++k) {
          const double of_i = vectors[k * P + i], of_j = vectors[k * P + j];
          vectors[k * P + i] = c * of_i - s * of_j;
          vectors[k * P + j] = s * of_i + c * of_j;
        }
      }
    }
  }
}

/* Of a covariance in the parameters' units, that in coordinates in which the prior is of unit variance. */
static void whiten(const twinmap_result *result, double *whitened)
{
  double scaled[TWINMAP_PARAMETERS];
  int i, j, k, l;
  for (i = 0; i < P; ++i) {
    scaled[i] = 1.0 / calc_unit(i, result->mean[i]);
  }
  for (i = 0; i < P; ++i) {
    for (j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (k = 0; k <= i; ++k) {
        double inner = 0.0;
        for (l = 0; l <= j; ++l) {
          inner += scaled[k] * result->covariance[k * P + l] * scaled[l] * prior_inverse[j * P + l];
        }
        sum += prior_inverse[i * P + k] * inner;
      }
      whitened[i * P + j] = sum;
      whitened[j * P + i] = sum;
    }
  }
}

/* Moments 1 to 4 of the density exp(tilt u - curvature u^2 / 2) between two places, by Simpson's rule. */
static void calc_cut_moments(double tilt, double curvature, double lower, double upper, double *moments)
{
  enum { INTERVALS = 128 };
  const double step = (upper - lower) / INTERVALS;
  double place = tilt / curvature, largest, sums[5] = {0.0, 0.0, 0.0, 0.0, 0.0};
  int i, k;
  place = place < lower ? lower : place > upper ? upper : place;
  largest = place * (tilt - 0.5 * curvature * place);
  for (i = 0; i <= INTERVALS; ++i) {
    const double u = lower + i * step;
    double term = exp(u * (tilt - 0.5 * curvature * u) - largest);
    term *= i == 0 || i == INTERVALS ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    for (k = 0; k < 5; ++k) {
      sums[k] += term;
      term *= u;
    }
  }
  for (k = 1; k < 5; ++k) {
    moments[k] = sums[k] / sums[0];
  }
}

/* What the bounds -1 and 1 of a uniform prior have added to an estimate with this mean and variance. */
static void calc_box_site(double mean, double variance, double *precision, double *shift)
{
  const double amid = 8.0, reach = 24.0, tolerance = 1e-13, sd = sqrt(variance);
  double lower = (-1.0 - mean) / sd, upper = (1.0 - mean) / sd, tilt = 0.0, curvature = 1.0, m[5];
  int i;
  *precision = 0.0;
  *shift = 0.0;
  if (!(lower < 0.0 && upper > 0.0) || (lower < -amid && upper > amid)) {
    return;
  }
  lower = lower < -reach ? -reach : lower;
  upper = upper > reach ? reach : upper;
  for (i = 0; i < 20; ++i) {
    double by_tilt, by_both, by_curvature, of_square, determinant, more_tilt, more_curvature, size, least,
        share;
    calc_cut_moments(tilt, curvature, lower, upper, m);
    by_tilt = m[2] - m[1] * m[1];
    by_both = m[3] - m[1] * m[2];
    by_curvature = m[4] - m[2] * m[2];
    of_square = 1.0 - m[2];
    determinant = by_tilt * by_curvature - by_both * by_both;
    if (!(determinant > 0.0)) { /* by rounding */
      break;
    }
    more_tilt = (-m[1] * by_curvature - of_square * by_both) / determinant;
    more_curvature = -2.0 * (of_square * by_tilt + m[1] * by_both) / determinant;
    size = fabs(more_tilt) > fabs(more_curvature) ? fabs(more_tilt) : fabs(more_curvature);
    least = curvature * 0.25 - curvature; /* so that it stays positive */
    share = size > 1.0 ? 1.0 / size : 1.0;
    share = share * more_curvature < least ? least / more_curvature : share;
    tilt += share * more_tilt;
    curvature += share * more_curvature;
    if (size < tolerance) {
      break;
    }
  }
  *precision = (1.0 - curvature) / variance;
  *shift = *precision * mean - tilt / sd;
}

/* The information that a measurement adds, on the diagonal of `whitened`, its directions in `vectors`, and how far
   each pulls. mean: of the estimate, in coordinates in which the prior is of mean 0 and unit variance. */
static void calc_gained(twinmap_track *track, const twinmap_result *result, const double *mean, double *pulls)
{
  double information[TWINMAP_PARAMETERS], pull[TWINMAP_PARAMETERS];
  int i, j, k;
  for (i = 0; i < P; ++i) {
    const double value = track->whitened[i * P + i] > 1e-300 ? track->whitened[i * P + i] : 1e-300;
    double along = 0.0;
    for (j = 0; j < P; ++j) {
      along += track->vectors[j * P + i] * mean[j];
    }
    information[i] = 1.0 / value - 1.0;
    pulls[i] = along / value;
  }
  for (i = 0; i < P; ++i) {
    pull[i] = dot(track->vectors + i * P, pulls, P);
    for (j = 0; j < P; ++j) {
      double sum = 0.0;
      for (k = 0; k < P; ++k) {
        sum += track->vectors[i * P + k] * information[k] * track->vectors[j * P + k];
      }
      track->whitened[i * P + j] = sum;
    }
  }
  for (j = 0; j < P; ++j) {
    if (is_uniform[j]) {
      const double root = prior_lower[j * P + j], unit = calc_unit(j, result->mean[j]);
      double precision, shift;
      calc_box_site(to_coordinate(j, result->mean[j]), result->covariance[j * P + j] / (unit * unit), &precision, &shift);
      track->whitened[j * P + j] += 1.0 - root * root * precision;
      pull[j] -= root * (shift - precision * prior_mean[j]);
    }
  }
  diagonalize(track->whitened, track->vectors);
  for (i = 0; i < P; ++i) {
    pulls[i] = 0.0;
    for (j = 0; j < P; ++j) {
      pulls[i] += track->vectors[j * P + i] * pull[j];
    }
  }
}

/* The row of direction i, if the measurement says more of it than the prior. Else the parameters' variances have
   it. */
static void add_direction(twinmap_track *track, int i, double pull)
{
  const double information = track->whitened[i * P + i];
  const int says = information > hardly_informative;
  int j, k;
  for (j = 0; j < P; ++j) {
    double axis = 0.0;
    for (k = 0; k <= j; ++k) {
      axis += prior_lower[j * P + k] * track->vectors[k * P + i];
    }
    track->own_variance[j] += axis * axis * (says ? 1.0 / information : 1e12);
  }
  if (says) {
    const double root = sqrt(information);
    double *row = track->row[track->rows];
    memset(row, 0, sizeof track->row[0]);
    for (j = 0; j < P; ++j) {
      for (k = j; k < P; ++k) {
        row[j] += prior_inverse[k * P + j] * track->vectors[k * P + i];
      }
      row[j] *= root;
    }
    track->value[track->rows] = dot(row, prior_mean, P) + pull / root;
    ++track->rows;
  }
}

/* The likelihood as rows of a linear measurement: the prior that the estimate contains is taken out. */
static void take_likelihood(twinmap_track *track, const twinmap_result *result)
{
  double mean[TWINMAP_PARAMETERS], pulls[TWINMAP_PARAMETERS], shift[TWINMAP_PARAMETERS];
  int i;
  whiten(result, track->whitened);
  diagonalize(track->whitened, track->vectors);
  for (i = 0; i < P; ++i) {
    shift[i] = to_coordinate(i, result->mean[i]) - prior_mean[i];
    mean[i] = dot(prior_inverse + i * P, shift, i + 1);
    track->own_variance[i] = 0.0;
  }
  calc_gained(track, result, mean, pulls);
  for (i = 0; i < P; ++i) {
    add_direction(track, i, pulls[i]);
  }
}

/* A measurement whose model does not hold, or that has no finite estimate, does not update. */
static int informs(const twinmap_result *result)
{
  int i;
  for (i = 0; i < P; ++i) {
    if (!is_number(result->mean[i]) || !is_number(result->sd[i])) {
      return 0;
    }
  }
  return (result->statuses & TWINMAP_STATUS_MODEL_MISMATCH) == 0;
}

/* Kalman's filter. */

static int has_slope(int j)
{
#if TWINMAP_TRACK_SLOPES
  int s;
  for (s = 0; s < SLOPES; ++s) {
    if (slope_parameter[s] == j) {
      return 1;
    }
  }
#else
  (void)j;
#endif
  return 0;
}

/* A walk makes no level less known than anywhere within its bounds, or than before the first measurement. */
static double limit_growth(int j, double growth, const belief_t *belief)
{
  const double prior = prior_covariance[j * P + j], bounds = 1.0 / 3.0;
  const double room = (prior > bounds ? prior : bounds) - belief->covariance[j * N + j];
  return growth < room ? growth : room > 0.0 ? room : 0.0;
}

static void predict(double dt, const double *growth, belief_t *belief)
{
  int j;
#if TWINMAP_TRACK_SLOPES
  int s, i;
  for (s = 0; s < SLOPES; ++s) {
    const int slope = P + s;
    j = slope_parameter[s];
    belief->mean[j] += dt * belief->mean[slope];
    for (i = 0; i < N; ++i) {
      belief->covariance[j * N + i] += dt * belief->covariance[slope * N + i];
    }
    for (i = 0; i < N; ++i) {
      belief->covariance[i * N + j] += dt * belief->covariance[i * N + slope];
    }
  }
#else
  (void)dt;
#endif
  for (j = 0; j < P; ++j) {
    belief->covariance[j * N + j] += has_slope(j) ? growth[j] : limit_growth(j, growth[j], belief);
  }
}

/* The logarithm of a product of positive factors, by one logarithm: sum + log(product). */
static void multiply_log(double factor, double *product, double *sum)
{
  *product *= factor;
  if (!(*product < 1e150 && *product > 1.0 / 1e150)) {
    *sum += log(*product);
    *product = 1.0;
  }
}

/* By one value after another; log of their density. keeps: innovations and gains are kept. */
static double update(twinmap_track *track, belief_t *belief, int keeps)
{
  double gain[TWINMAP_TRACK_STATES], loss = 1.8378770664093453 * track->rows, product = 1.0, sum = 0.0;
  int i, a, b;
  for (i = 0; i < track->rows; ++i) {
    const double *row = track->row[i];
    double variance, value;
    for (a = 0; a < N; ++a) {
      gain[a] = dot(belief->covariance + a * N, row, N);
    }
    variance = dot(row, gain, N) + 1.0;
    value = track->value[i] - dot(row, belief->mean, N);
    for (a = 0; a < N; ++a) {
      belief->mean[a] += value / variance * gain[a];
      for (b = 0; b < N; ++b) {
        belief->covariance[a * N + b] -= gain[a] / variance * gain[b];
      }
    }
    loss += value * value / variance;
    multiply_log(variance, &product, &sum);
    if (keeps) {
      track->innovation[i] = value;
      track->variance[i] = variance;
      for (a = 0; a < N; ++a) {
        track->gain[i][a] = gain[a] / variance;
      }
    }
  }
  return -0.5 * (loss + (sum + log(product)));
}

/* Rates of walks. */

#if TWINMAP_TRACK_UNKNOWN
static double calc_unit_rate(const twinmap_track *track, int j)
{
  return track->interval > 0.0 ? track->variances[j] / track->interval : 0.0;
}

/* log_weights between two filters: a parabola through three. */
static double interpolate(const double *log_weights, int part)
{
  const int nearest = (part + PARTS / 2) / PARTS;
  const int middle = nearest < 1 ? 1 : (nearest > RATES - 2 ? RATES - 2 : nearest);
  const double x = (double)part / PARTS - middle;
  const double before = log_weights[middle - 1], here = log_weights[middle], after = log_weights[middle + 1];
  return here + 0.5 * x * (after - before) + 0.5 * x * x * (after - 2.0 * here + before);
}

/* Weights, of sum 1, of the ratios between those of the filters. */
static void calc_posterior(twinmap_track *track, int u)
{
  double largest, sum = 0.0;
  int i;
  for (i = 0; i < OCTAVES; ++i) {
    track->weights[i] = interpolate(track->log_weights[u], i);
  }
  largest = track->weights[0];
  for (i = 1; i < OCTAVES; ++i) {
    largest = fmax(largest, track->weights[i]);
  }
  for (i = 0; i < OCTAVES; ++i) {
    track->weights[i] = exp(track->weights[i] - largest);
    sum += track->weights[i];
  }
  for (i = 0; i < OCTAVES; ++i) {
    track->weights[i] /= sum;
  }
}

/* The variance of the walk over that of a measurement: its mean, and as many standard deviations above. */
static double calc_square_ratio(twinmap_track *track, int u, double above)
{
  double mean, square;
  int i;
  calc_posterior(track, u);
  mean = dot(track->weights, square_ratios, OCTAVES);
  if (above == 0.0) {
    return mean;
  }
  square = 0.0;
  for (i = 0; i < OCTAVES; ++i) {
    square += track->weights[i] * square_ratios[i] * square_ratios[i];
  }
  return mean + above * sqrt(fmax(0.0, square - mean * mean));
}

/* The median of the ratio. */
static double calc_median_ratio(twinmap_track *track, int u)
{
  double sum = 0.0;
  int i;
  calc_posterior(track, u);
  for (i = 0; i < OCTAVES; ++i) {
    const double weight = track->weights[i];
    if (sum + weight >= 0.5) {
      return rate_ratios[0] * exp2((double)i / PARTS + ((0.5 - sum) / weight - 0.5) / PARTS);
    }
    sum += weight;
  }
  return rate_ratios[RATES - 1];
}

/* Mean and variance of the parameter over all rates. */
static void calc_moments(twinmap_track *track, int u, double *mean, double *variance)
{
  const int j = unknown_rates[u];
  double shared[TWINMAP_TRACK_RATES];
  int i, g;
  calc_posterior(track, u);
  for (g = 0; g < RATES; ++g) {
    shared[g] = 0.0;
  }
  for (i = 0; i < OCTAVES; ++i) {
    const int below = i / PARTS < RATES - 2 ? i / PARTS : RATES - 2;
    const double above = (double)i / PARTS - below;
    shared[below] += (1.0 - above) * track->weights[i];
    shared[below + 1] += above * track->weights[i];
  }
  *mean = *variance = 0.0;
  for (g = 0; g < RATES; ++g) {
    *mean += shared[g] * track->filters[u][g].mean[j];
  }
  for (g = 0; g < RATES; ++g) {
    const belief_t *belief = &track->filters[u][g];
    const double off = belief->mean[j] - *mean;
    *variance += shared[g] * (belief->covariance[j * N + j] + off * off);
  }
}
#endif

/* Variance per unit of time of each parameter. */
static void calc_rates(twinmap_track *track, double above, double *rates)
{
  int j;
  for (j = 0; j < P; ++j) {
    rates[j] = track->widening * known_rates[j];
  }
#if TWINMAP_TRACK_UNKNOWN
  for (j = 0; j < UNKNOWN; ++j) {
    rates[unknown_rates[j]] = calc_square_ratio(track, j, above) * calc_unit_rate(track, unknown_rates[j]);
  }
#else
  (void)above;
#endif
}

/* Priors of slopes and coefficients, once their units are known. */

enum { UNITS = SLOPES + FOLLOWS };

static void calc_units(const twinmap_track *track, double *units)
{
  int s;
  for (s = 0; s < SLOPES; ++s) {
    units[s] = track->interval > 0.0 ? 1.0 / (track->interval * track->interval) : 0.0;
  }
#if TWINMAP_TRACK_FOLLOWS
  for (s = 0; s < FOLLOWS; ++s) {
    const double first = track->reference[follow_condition[s]];
    const double stddev = 10.0 / (first != 0.0 ? fabs(first) : 1.0);
    units[SLOPES + s] = is_number(first) ? stddev * stddev : 0.0;
  }
#endif
}

static void add_units(const double *units, const double *before, belief_t *belief)
{
  int s;
  for (s = 0; s < UNITS; ++s) {
    belief->covariance[(P + s) * N + P + s] += units[s] - before[s];
  }
}

static void set_units(twinmap_track *track, const double *before)
{
  double units[UNITS + 1];
  calc_units(track, units);
  add_units(units, before, &track->belief);
#if TWINMAP_TRACK_UNKNOWN
  {
    int u, g;
    for (u = 0; u < UNKNOWN; ++u) {
      for (g = 0; g < RATES; ++g) {
        add_units(units, before, &track->filters[u][g]);
      }
    }
  }
#endif
}

/* What a measurement adds to what is remembered of others. */

static void note_variances(twinmap_track *track)
{
  int j;
  if (track->rows == 0) {
    return;
  }
  track->informed += 1.0;
  for (j = 0; j < P; ++j) {
    const double prior = prior_covariance[j * P + j], own = track->own_variance[j];
    track->variances[j] += ((own < prior ? own : prior) - track->variances[j]) / track->informed;
  }
}

static void note_conditions(twinmap_track *track, const double *conditions)
{
#if TWINMAP_TRACK_CONDITIONS
  double before[UNITS + 1];
  int c;
  calc_units(track, before);
  for (c = 0; c < CONDITIONS; ++c) {
    double off;
    if (!is_number(conditions[c])) {
      continue;
    }
    track->condition_counts[c] += 1.0;
    if (track->condition_counts[c] == 1.0) {
      track->reference[c] = conditions[c];
      continue;
    }
    off = conditions[c] - track->reference[c];
    track->spread[c] += (off * off - track->spread[c]) / (track->condition_counts[c] - 1.0);
  }
  set_units(track, before);
#else
  (void)track;
  (void)conditions;
#endif
}

#if TWINMAP_TRACK_FOLLOWS
/* Noise along a parameter's column of the rows, which are of unit variance again behind it. */
static void add_noise(twinmap_track *track, int j, double variance)
{
  double column[TWINMAP_PARAMETERS], along[TWINMAP_TRACK_STATES], length = 0.0, share, projected = 0.0;
  int i, a;
  for (i = 0; i < track->rows; ++i) {
    column[i] = track->row[i][j];
    length += column[i] * column[i];
  }
  if (!(length > 0.0)) {
    return;
  }
  share = (1.0 - 1.0 / sqrt(1.0 + variance * length)) / length;
  for (a = 0; a < N; ++a) {
    along[a] = 0.0;
    for (i = 0; i < track->rows; ++i) {
      along[a] += track->row[i][a] * column[i];
    }
  }
  for (i = 0; i < track->rows; ++i) {
    projected += column[i] * track->value[i];
  }
  for (i = 0; i < track->rows; ++i) {
    track->value[i] -= share * projected * column[i];
    for (a = 0; a < N; ++a) {
      track->row[i][a] -= share * along[a] * column[i];
    }
  }
}
#endif

/* The rows over the whole state. What a condition that is missing may do is noise. */
static void follow_conditions(twinmap_track *track, const double *conditions)
{
#if TWINMAP_TRACK_FOLLOWS
  int f, i;
  for (f = 0; f < FOLLOWS; ++f) {
    const int c = follow_condition[f];
    const double condition = conditions[c] - track->reference[c];
    if (is_number(condition)) {
      for (i = 0; i < track->rows; ++i) {
        track->row[i][P + SLOPES + f] = condition * track->row[i][follow_parameter[f]];
      }
    }
  }
  for (f = 0; f < FOLLOWS; ++f) {
    const int c = follow_condition[f], s = P + SLOPES + f;
    if (!is_number(conditions[c])) {
      const double mean = track->belief.mean[s];
      add_noise(track, follow_parameter[f],
                (mean * mean + track->belief.covariance[s * N + s]) * track->spread[c]);
    }
  }
#else
  (void)track;
  (void)conditions;
#endif
}

/* Changes. */

static void move_changes(twinmap_track *track, double dt)
{
#if TWINMAP_TRACK_SLOPES
  int m, j, s;
  for (m = 0; m < track->supposed; ++m) {
    for (j = 0; j < P; ++j) {
      double *signature = track->changes[m][j].signature;
      for (s = 0; s < SLOPES; ++s) {
        signature[slope_parameter[s]] += dt * signature[P + s];
      }
    }
  }
#else
  (void)track;
  (void)dt;
#endif
}

static void suppose_changes(twinmap_track *track, double time)
{
  int j;
  if (track->supposed == WINDOW) {
    memmove(track->changes[0], track->changes[1], sizeof track->changes - sizeof track->changes[0]);
#if TWINMAP_TRACK_UNKNOWN
    memmove(track->past_weights[0], track->past_weights[1],
            sizeof track->past_weights - sizeof track->past_weights[0]);
#endif
    --track->supposed;
  }
#if TWINMAP_TRACK_UNKNOWN
  memcpy(track->past_weights[track->supposed], track->log_weights, sizeof track->log_weights);
#endif
  for (j = 0; j < P; ++j) {
    supposed_t *change = &track->changes[track->supposed][j];
    const double stddev = change_stddev[j] > 0.0 ? change_stddev[j] : 3.0 * sqrt(track->variances[j]);
    memset(change, 0, sizeof *change);
    change->signature[j] = 1.0;
    change->time = time;
    change->variance = stddev * stddev;
  }
  ++track->supposed;
}

/* A change of a measurement ago is as wide as that one says at least. */
static void widen_change(const twinmap_track *track, supposed_t *change)
{
  double signature[TWINMAP_TRACK_STATES], descent = 0.0, information = 0.0, size;
  int i, a;
  memcpy(signature, change->signature, sizeof signature);
  for (i = 0; i < track->rows; ++i) {
    const double seen = dot(track->row[i], signature, N);
    descent += seen * track->innovation[i] / track->variance[i];
    information += seen * seen / track->variance[i];
    for (a = 0; a < N; ++a) {
      signature[a] -= seen * track->gain[i][a];
    }
  }
  if (information > 0.0) {
    size = descent / information;
    change->variance = fmax(change->variance, size * size);
  }
}

/* log(e^a + e^b). */
static double add_logs(double a, double b)
{
  const double larger = a > b ? a : b;
  return larger + log1p(exp((a > b ? b : a) - larger));
}

/* unchanged: chi-square of the measurement without a change, and the logarithm of its variances. */
static void weigh_change(const twinmap_track *track, const double *unchanged, double log_bad, int is_used,
                         supposed_t *change)
{
  double size = change->size, variance = change->variance, signature[TWINMAP_TRACK_STATES];
  double chi_square = 0.0, product = 1.0, sum = 0.0, log_good;
  int i, a;
  memcpy(signature, change->signature, sizeof signature);
  for (i = 0; i < track->rows; ++i) {
    const double seen = dot(track->row[i], signature, N);
    const double with = track->variance[i] + seen * seen * variance;
    const double off = track->innovation[i] - seen * size, share = off / with;
    chi_square += off * share;
    multiply_log(with, &product, &sum);
    size += variance * seen * share;
    variance *= track->variance[i] / with;
    for (a = 0; a < N; ++a) {
      signature[a] -= seen * track->gain[i][a];
    }
  }
  log_good = 0.5 * (unchanged[0] - chi_square - (sum + log(product) - unchanged[1]));
  change->log_ratio += add_logs(log_good, log_bad) - add_logs(0.0, log_bad);
  if (log_good > log_bad) {
    change->size = size;
    change->variance = variance;
  }
  if (is_used) {
    memcpy(change->signature, signature, sizeof signature);
  }
}

static void weigh_changes(twinmap_track *track, double log_bad, int is_used)
{
  double unchanged[2] = {0.0, 0.0}, product = 1.0, sum = 0.0;
  int m, j;
  for (m = 0; m < track->rows; ++m) {
    unchanged[0] += track->innovation[m] * track->innovation[m] / track->variance[m];
    multiply_log(track->variance[m], &product, &sum);
  }
  unchanged[1] = sum + log(product);
  for (m = 0; m < track->supposed; ++m) {
    for (j = 0; j < P; ++j) {
      supposed_t *change = &track->changes[m][j];
      const int is_new = m == track->supposed - 1;
      if (is_new) {
        widen_change(track, change);
      }
      weigh_change(track, unchanged, log_bad, is_used, change);
      if (is_new && change->log_ratio > 0.7) {
        change->log_ratio = 0.7; /* one measurement alone may be bad in any way */
      }
    }
  }
}

static double find_largest(const twinmap_track *track)
{
  double largest = 0.0;
  int m, j;
  for (m = 0; m < track->supposed; ++m) {
    for (j = 0; j < P; ++j) {
      largest = fmax(largest, track->changes[m][j].log_ratio);
    }
  }
  return largest;
}

static double calc_share(const twinmap_track *track, int m, int j, double largest)
{
  return change_weight[j] * exp(track->changes[m][j].log_ratio - largest);
}

static double sum_shares(const twinmap_track *track, double largest)
{
  double sum = 0.0;
  int m, j;
  for (m = 0; m < track->supposed; ++m) {
    for (j = 0; j < P; ++j) {
      sum += calc_share(track, m, j, largest);
    }
  }
  return sum;
}

/* Of a walk of that ratio, between those that lives were simulated for. */
static double calc_threshold(int j, double ratio)
{
  const double *logs = log_thresholds + j * PLACES;
  const double place = fmin(ratio / (ratio + threshold_ratio), threshold_places[PLACES - 1]);
  int below = 0;
  double share;
  while (below + 2 < PLACES && threshold_places[below + 1] < place) {
    ++below;
  }
  share = (place - threshold_places[below]) / (threshold_places[below + 1] - threshold_places[below]);
  return exp((1.0 - share) * logs[below] + share * logs[below + 1]);
}

/* Shiryaev and Roberts' sum over its threshold: 1 is an alarm. */
static double calc_statistic(twinmap_track *track)
{
  const double largest = find_largest(track);
  double rates[TWINMAP_PARAMETERS], mean = 0.0;
  int j;
  calc_rates(track, 0.0, rates);
  for (j = 0; j < P; ++j) {
    mean += change_weight[j] * calc_threshold(j, sqrt(rates[j] * track->interval / track->variances[j]));
  }
  return exp(largest) * sum_shares(track, largest) / mean;
}

/* Which it most likely is. The place of it among the measurements that changes are supposed before. */
static int describe_change(const twinmap_track *track, twinmap_track_answer *answer)
{
  const double largest = find_largest(track);
  double total = 0.0, of_parameter[TWINMAP_PARAMETERS], best = -1.0, sum = 0.0;
  int m, j, place = 0, has_begun = 0;
  for (j = 0; j < P; ++j) {
    of_parameter[j] = 0.0;
    for (m = 0; m < track->supposed; ++m) {
      of_parameter[j] += calc_share(track, m, j, largest);
    }
    total += of_parameter[j];
  }
  answer->parameter = 0;
  for (j = 1; j < P; ++j) {
    if (of_parameter[j] > of_parameter[answer->parameter]) {
      answer->parameter = j;
    }
  }
  j = answer->parameter;
  answer->probability = of_parameter[j] / total;
  answer->change_earliest = answer->change_latest = track->changes[track->supposed - 1][j].time;
  for (m = 0; m < track->supposed; ++m) {
    const double share = calc_share(track, m, j, largest);
    if (share > best) {
      best = share;
      place = m;
    }
    sum += share / of_parameter[j];
    if (!has_begun && sum >= 0.025) {
      answer->change_earliest = track->changes[m][j].time;
      has_begun = 1;
    }
    if (sum <= 0.975) {
      answer->change_latest = track->changes[m][j].time;
    }
  }
  answer->change_time = track->changes[place][j].time;
  answer->change_latest = fmax(answer->change_latest, answer->change_time);
  answer->change_size = middle_unit[j] * track->changes[place][j].size;
  answer->change_sd = middle_unit[j] * sqrt(track->changes[place][j].variance);
  return place;
}

#if TWINMAP_TRACK_UNKNOWN
/* log of a mixture of two distributions over rates, into the second. */
static void mix(const double *log_one, double *log_other, double share_of_one)
{
  double mixed[TWINMAP_TRACK_RATES], largest_one = log_one[0], largest_other = log_other[0];
  double sum_one = 0.0, sum_other = 0.0, largest = 0.0;
  int g;
  for (g = 1; g < RATES; ++g) {
    largest_one = fmax(largest_one, log_one[g]);
    largest_other = fmax(largest_other, log_other[g]);
  }
  for (g = 0; g < RATES; ++g) {
    sum_one += exp(log_one[g] - largest_one);
    sum_other += exp(log_other[g] - largest_other);
  }
  for (g = 0; g < RATES; ++g) {
    mixed[g] = share_of_one * exp(log_one[g] - largest_one) / sum_one +
               (1.0 - share_of_one) * exp(log_other[g] - largest_other) / sum_other;
    largest = fmax(largest, mixed[g]);
  }
  for (g = 0; g < RATES; ++g) {
    log_other[g] = log(fmax(mixed[g] / largest, 1e-300));
  }
}
#endif

/* The belief over all supposed changes and none, with odds that are even at the threshold. */
static void add_changes(twinmap_track *track, double probability)
{
  const double largest = find_largest(track), total = sum_shares(track, largest);
  belief_t *belief = &track->belief;
  double mean[TWINMAP_TRACK_STATES];
  int m, j, a, b;
  for (a = 0; a < N; ++a) {
    mean[a] = 0.0;
  }
  for (m = 0; m < track->supposed; ++m) {
    for (j = 0; j < P; ++j) {
      const supposed_t *change = &track->changes[m][j];
      const double own = probability * calc_share(track, m, j, largest) / total;
      for (a = 0; a < N; ++a) {
        mean[a] += own * change->size * change->signature[a];
      }
    }
  }
  for (m = 0; m < track->supposed; ++m) {
    for (j = 0; j < P; ++j) {
      const supposed_t *change = &track->changes[m][j];
      const double own = probability * calc_share(track, m, j, largest) / total;
      for (a = 0; a < N; ++a) {
        const double off_a = change->size * change->signature[a] - mean[a];
        for (b = 0; b < N; ++b) {
          belief->covariance[a * N + b] += own * (change->variance * change->signature[a] * change->signature[b] +
                                                  off_a * (change->size * change->signature[b] - mean[b]));
        }
      }
    }
  }
  for (a = 0; a < N; ++a) {
    for (b = 0; b < N; ++b) {
      belief->covariance[a * N + b] += (1.0 - probability) * mean[a] * mean[b];
    }
    belief->mean[a] += mean[a];
  }
}

/* Rates are as before the likeliest change, or as without any. place: of that one. */
static void confirm_change(twinmap_track *track, int place, double odds)
{
  const double probability = odds / (1.0 + odds);
  add_changes(track, probability);
#if TWINMAP_TRACK_UNKNOWN
  {
    int u, g;
    for (u = 0; u < UNKNOWN; ++u) {
      mix(track->past_weights[place][u], track->log_weights[u], probability);
      for (g = 0; g < RATES; ++g) {
        track->filters[u][g] = track->belief;
      }
    }
  }
#else
  (void)place;
#endif
  track->supposed = track->run_of_bad = 0;
}

static void forget_levels(belief_t *belief)
{
  int i, j;
  for (i = 0; i < P; ++i) {
    for (j = 0; j < P; ++j) {
      belief->covariance[i * N + j] += prior_covariance[i * P + j];
    }
  }
}

/* Levels as little known as before the first measurement. */
static void begin_anew(twinmap_track *track)
{
  forget_levels(&track->belief);
#if TWINMAP_TRACK_UNKNOWN
  {
    int u, g;
    for (u = 0; u < UNKNOWN; ++u) {
      for (g = 0; g < RATES; ++g) {
        forget_levels(&track->filters[u][g]);
      }
    }
  }
#endif
  track->supposed = track->run_of_bad = 0;
}

/* One measurement. */

static void move_to(twinmap_track *track, double time)
{
  const double dt = track->count > 0.0 ? time - track->time : 0.0;
  double growth[TWINMAP_PARAMETERS];
  int j;
  if (dt > 0.0 && track->interval == 0.0) {
    double before[UNITS + 1];
    calc_units(track, before);
    track->interval = dt;
    set_units(track, before);
  }
  calc_rates(track, 0.6, growth);
  for (j = 0; j < P; ++j) {
    growth[j] *= dt;
  }
  predict(dt, growth, &track->belief);
#if TWINMAP_TRACK_UNKNOWN
  {
    int u, g;
    for (u = 0; u < UNKNOWN; ++u) {
      const double usual = growth[unknown_rates[u]];
      for (g = 0; g < RATES; ++g) {
        growth[unknown_rates[u]] =
            rate_ratios[g] * rate_ratios[g] * calc_unit_rate(track, unknown_rates[u]) * dt;
        predict(dt, growth, &track->filters[u][g]);
      }
      growth[unknown_rates[u]] = usual;
    }
  }
#endif
  move_changes(track, dt);
  suppose_changes(track, time);
  track->time = time;
  track->count += 1.0;
}

/* log of the odds that a measurement is bad, by the length of its innovation. */
static double calc_log_bad(double chi_square, int degrees)
{
  const double square = fmax(chi_square, degrees); /* nearer than noise is as good as that */
  const double log_bad = log(2.0 * 10.0 / pi) - log(10.0 * 10.0 + square);
  const double log_good =
      0.5 * (degrees - 1.0) * log(square) - 0.5 * square - (0.5 * degrees - 1.0) * log_two - log_gamma_half[degrees];
  return log(bad_share / (1.0 - bad_share)) + log_bad - log_good;
}

static void take(twinmap_track *track)
{
  track->belief = track->updated;
#if TWINMAP_TRACK_UNKNOWN
  {
    int u, g;
    for (u = 0; u < UNKNOWN; ++u) {
      double largest = -HUGE_VAL;
      for (g = 0; g < RATES; ++g) {
        track->log_weights[u][g] += update(track, &track->filters[u][g], 0);
        largest = fmax(largest, track->log_weights[u][g]);
      }
      for (g = 0; g < RATES; ++g) {
        track->log_weights[u][g] -= largest;
      }
    }
  }
#endif
}

/* Where even changes do not explain measurements. */
static int widen_rates(twinmap_track *track)
{
  if (track->surprises <= 10.0) {
    return 0;
  }
  track->widening *= 4.0;
  track->surprises = 0.0;
#if TWINMAP_TRACK_UNKNOWN
  {
    int u;
    for (u = 0; u < UNKNOWN; ++u) {
      memcpy(track->log_weights[u], log_rate_prior, sizeof log_rate_prior);
    }
  }
#endif
  return 1;
}

static void look_for_changes(twinmap_track *track, twinmap_track_answer *answer)
{
  answer->alarm_statistic = calc_statistic(track);
  if (track->rows > 0) {
    track->run_of_bad = answer->fits ? 0 : track->run_of_bad + 1;
    track->surprises += (answer->fits ? 0.0 : 1.0) - track->surprises / 20.0;
  }
  if (answer->alarm_statistic >= 1.0) {
    answer->alarm = TWINMAP_TRACK_CHANGE;
    confirm_change(track, describe_change(track, answer), answer->alarm_statistic);
  } else if (track->run_of_bad == 4) {
    answer->alarm = TWINMAP_TRACK_ANEW;
    begin_anew(track);
  }
  answer->uncalibrated = widen_rates(track);
}

static void advance(twinmap_track *track, double time, const double *conditions, twinmap_track_answer *answer)
{
  double log_bad = -1e300;
  int i;
  move_to(track, time);
  note_variances(track);
  note_conditions(track, conditions);
  follow_conditions(track, conditions);
  track->updated = track->belief;
  update(track, &track->updated, 1);
  for (i = 0; i < track->rows; ++i) {
    answer->chi_square += track->innovation[i] * track->innovation[i] / track->variance[i];
  }
  answer->degrees = track->rows;
  if (track->rows > 0) {
    log_bad = calc_log_bad(answer->chi_square, track->rows);
  }
  answer->fits = track->rows > 0 && log_bad < 0.0;
  if (answer->fits) {
    take(track);
  }
  weigh_changes(track, log_bad, answer->fits);
  look_for_changes(track, answer);
  answer->fits |= track->rows == 0; /* nothing speaks against it */
}

/* What is believed, over all rates, in the parameters' units. */

static void average_rates(twinmap_track *track, belief_t *belief)
{
  *belief = track->belief;
#if TWINMAP_TRACK_UNKNOWN
  {
    int u, a;
    for (u = 0; u < UNKNOWN; ++u) {
      const int j = unknown_rates[u];
      double mean, variance, scale;
      calc_moments(track, u, &mean, &variance);
      scale = sqrt(variance / belief->covariance[j * N + j]);
      belief->mean[j] = mean;
      for (a = 0; a < N; ++a) {
        belief->covariance[j * N + a] *= scale;
      }
      for (a = 0; a < N; ++a) {
        belief->covariance[a * N + j] *= scale;
      }
    }
  }
#endif
  {
    int j;
    for (j = 0; j < P; ++j) {
      belief->covariance[j * N + j] += shared_variance[j] > 0.0 ? shared_variance[j] * track->variances[j] : 0.0;
    }
  }
}

static void describe_walks(twinmap_track *track, const double *unit, twinmap_track_answer *answer)
{
  double rates[TWINMAP_PARAMETERS];
  int j;
  calc_rates(track, 0.0, rates);
  for (j = 0; j < P; ++j) {
    answer->walk[j] = unit[j] * sqrt(rates[j] * track->interval);
  }
#if TWINMAP_TRACK_UNKNOWN
  for (j = 0; j < UNKNOWN; ++j) {
    const int i = unknown_rates[j];
    answer->walk[i] = unit[i] * sqrt(track->variances[i]) * calc_median_ratio(track, j);
  }
#endif
}

static void describe_belief(twinmap_track *track, twinmap_track_answer *answer)
{
  belief_t *belief = &track->updated; /* free until the next measurement */
  double unit[TWINMAP_PARAMETERS];
  int i, j;
  average_rates(track, belief);
  for (j = 0; j < P; ++j) {
    const double mean = belief->mean[j], sd = sqrt(belief->covariance[j * N + j]);
    answer->mean[j] = to_value(j, mean);
    unit[j] = calc_unit(j, answer->mean[j]);
    answer->sd[j] = unit[j] * sd;
    answer->lower[j] = to_value(j, mean - normal95 * sd);
    answer->upper[j] = to_value(j, mean + normal95 * sd);
  }
#if TWINMAP_TRACK_SLOPES
  for (i = 0; i < SLOPES; ++i) {
    const int slope = P + i;
    j = slope_parameter[i];
    answer->slope[j] = unit[j] * belief->mean[slope];
    answer->slope_sd[j] = unit[j] * sqrt(belief->covariance[slope * N + slope]);
  }
#endif
  for (i = 0; i < P; ++i) {
    for (j = 0; j < P; ++j) {
      answer->covariance[i * P + j] = unit[i] * unit[j] * belief->covariance[i * N + j];
    }
  }
  describe_walks(track, unit, answer);
}

void twinmap_track_begin(twinmap_track *track)
{
  int i, j;
  memset(track, 0, sizeof *track);
  track->widening = 1.0;
  for (i = 0; i < P; ++i) {
    track->belief.mean[i] = prior_mean[i];
    for (j = 0; j < P; ++j) {
      track->belief.covariance[i * N + j] = prior_covariance[i * P + j];
    }
  }
#if TWINMAP_TRACK_CONDITIONS
  for (i = 0; i < CONDITIONS; ++i) {
    track->reference[i] = HUGE_VAL; /* none yet */
  }
#endif
#if TWINMAP_TRACK_UNKNOWN
  for (i = 0; i < UNKNOWN; ++i) {
    for (j = 0; j < RATES; ++j) {
      track->filters[i][j] = track->belief;
    }
    memcpy(track->log_weights[i], log_rate_prior, sizeof log_rate_prior);
  }
#endif
}

twinmap_track_error twinmap_track_update(twinmap_track *track, const twinmap_result *result, double time,
                                         const double *conditions, twinmap_track_answer *answer)
{
  if (!is_number(time) || (track->count > 0.0 && time < track->time)) {
    return TWINMAP_TRACK_ERROR_TIME;
  }
  memset(answer, 0, sizeof *answer);
  track->rows = 0;
  if (informs(result)) {
    take_likelihood(track, result);
  }
  answer->updates = track->rows > 0;
  advance(track, time, conditions, answer);
  describe_belief(track, answer);
  return TWINMAP_TRACK_OK;
}
