/* Features of the response, block after block. */
enum { BLOCK_LINEAR, BLOCK_MAGNITUDE_PHASE, BLOCK_STATISTIC, BLOCK_EXTREMA };
enum { STATISTIC_STDDEV, STATISTIC_RMS, STATISTIC_MIN, STATISTIC_MAX, STATISTIC_PEAK_TO_PEAK };

typedef struct {
  int kind;
  int count;       /* rows of its matrix; statistic: which; extrema: most peaks of each kind */
  int first;       /* where its rows begin in feature_starts, or its samples in window_rows */
  int samples;     /* statistic, extrema: how many samples */
  int maxima, minima, fit_samples; /* extrema */
  double window_start, window_interval, prominence;
} feature_block;

@TABLES@

#if TWINMAP_MATRICES
/* Row r of the matrices times the response. */
static double calc_linear(const twinmap_state *state, int r)
{
  double sum = 0.0;
  int k;
  for (k = feature_starts[r]; k < feature_starts[r + 1]; ++k) {
#if TWINMAP_SELECTED
    sum += state->response[feature_rows[k]];
#else
    sum = multiply_add(feature_weights[k], state->response[feature_rows[k]], sum);
#endif
  }
  return sum;
}
#endif

#if TWINMAP_STATISTICS
static double calc_statistic(const twinmap_state *state, const feature_block *block)
{
  const int *row = window_rows + block->first;
  const double *response = state->response;
  const int n = block->samples;
  double sum = 0.0, squares = 0.0, least = response[row[0]], most = least;
  int i;
  for (i = 0; i < n; ++i) {
    const double value = response[row[i]];
    sum += value;
    least = fmin(least, value);
    most = fmax(most, value);
    squares += block->count == STATISTIC_RMS ? value * value : 0.0;
  }
  switch (block->count) {
    case STATISTIC_RMS:
      return sqrt(squares / n);
    case STATISTIC_MIN:
      return least;
    case STATISTIC_MAX:
      return most;
    case STATISTIC_PEAK_TO_PEAK:
      return most - least;
    default:
      break;
  }
  for (i = 0; i < n; ++i) {
    const double difference = response[row[i]] - sum / n;
    squares += difference * difference;
  }
  return sqrt(squares / (n - 1.0));
}
#endif

#if TWINMAP_EXTREMA
static double value_at(const twinmap_state *state, const feature_block *block, double sign, int i)
{
  return sign * state->response[window_rows[block->first + i]];
}

/* The lowest value between a top and the next higher one in a direction, or the end. */
static double calc_base(const twinmap_state *state, const feature_block *block, double sign, int top, int direction)
{
  const double height = value_at(state, block, sign, top);
  double base = height;
  int i;
  for (i = top + direction; i >= 0 && i < block->samples && value_at(state, block, sign, i) <= height;
       i += direction) {
    base = fmin(base, value_at(state, block, sign, i));
  }
  return base;
}

/* Of equal neighbours the first counts. */
static int is_top(const twinmap_state *state, const feature_block *block, double sign, int i)
{
  const double height = value_at(state, block, sign, i);
  int next = i + 1;
  while (next < block->samples && !(value_at(state, block, sign, next) < height) &&
         !(value_at(state, block, sign, next) > height)) {
    ++next;
  }
  return height > value_at(state, block, sign, i - 1) && next < block->samples &&
         height > value_at(state, block, sign, next);
}

/* The top of the parabola that fits the samples around one, by least squares. */
static void fit_parabola(const twinmap_state *state, const feature_block *block, double sign, int top,
                         double *position, double *height)
{
  const int half = block->fit_samples / 2;
  double sum = 0.0, first = 0.0, second = 0.0, squares = 0.0, fourths = 0.0, n = 2.0 * half + 1.0;
  double c0, c1, c2, shift;
  int i;
  for (i = -half; i <= half; ++i) {
    const double k = i, value = value_at(state, block, sign, top + i);
    sum += value;
    first = multiply_add(k, value, first);
    second = multiply_add(k * k, value, second);
    squares += k * k;
    fourths += k * k * k * k;
  }
  c2 = (n * second - squares * sum) / (n * fourths - squares * squares);
  c1 = first / squares;
  c0 = (sum - c2 * squares) / n;
  shift = -0.5 * c1 / c2;
  if (!(c2 < 0.0) || fabs(shift) > half) {
    *position = top; /* no top near the largest value: noise */
    *height = value_at(state, block, sign, top);
    return;
  }
  *position = top + shift;
  *height = c0 + 0.5 * c1 * shift;
}

/* Value and time of the first peaks of one sign; NaN for those that are not there. */
static void extract_peaks(const twinmap_state *state, const feature_block *block, double sign, double *features)
{
  const int half = block->fit_samples / 2;
  int found = 0, i;
  for (i = half; i + half < block->samples && found < block->count; ++i) {
    if (is_top(state, block, sign, i) &&
        value_at(state, block, sign, i) - fmax(calc_base(state, block, sign, i, -1),
                                               calc_base(state, block, sign, i, 1)) >=
            block->prominence) {
      double position, height;
      fit_parabola(state, block, sign, i, &position, &height);
      features[2 * found] = sign * height;
      features[2 * found + 1] = block->window_start + position * block->window_interval;
      ++found;
    }
  }
  for (i = 2 * found; i < 2 * block->count; ++i) {
    features[i] = HUGE_VAL; /* refused as not finite */
  }
}
#endif

static void extract_features(twinmap_state *state)
{
  double *features = state->features;
  int b;
#if TWINMAP_MATRICES
  int r;
#endif
  for (b = 0; b < TWINMAP_BLOCKS; ++b) {
    const feature_block *block = &feature_blocks[b];
    switch (block->kind) {
#if TWINMAP_MATRICES
      case BLOCK_MAGNITUDE_PHASE:
        for (r = 0; r < block->count; r += 2) {
          const double real = calc_linear(state, block->first + r);
          const double imaginary = calc_linear(state, block->first + r + 1);
          const double magnitude = hypot(real, imaginary);
          *features++ = magnitude;
          *features++ = real / magnitude;
          *features++ = imaginary / magnitude;
        }
        break;
      case BLOCK_LINEAR:
        for (r = 0; r < block->count; ++r) {
          *features++ = calc_linear(state, block->first + r);
        }
        break;
#endif
#if TWINMAP_STATISTICS
      case BLOCK_STATISTIC:
        *features++ = calc_statistic(state, block);
        break;
#endif
#if TWINMAP_EXTREMA
      case BLOCK_EXTREMA:
        if (block->maxima) {
          extract_peaks(state, block, 1.0, features);
          features += 2 * block->count;
        }
        if (block->minima) {
          extract_peaks(state, block, -1.0, features);
          features += 2 * block->count;
        }
        break;
#endif
      default:
        break;
    }
  }
}
