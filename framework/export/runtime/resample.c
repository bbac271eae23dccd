/* Measured signals at the times of the grid. */
@TABLES@

/* How many of increasing times are before t, or (with `equal`) at most t. */
static int count_before(int count, const double *times, double start, double t, int equal)
{
  int below = 0, end = count;
  while (below < end) {
    const int middle = below + (end - below) / 2;
    const double at = times[middle] - start;
    if (at < t || (equal && at == t)) {
      below = middle + 1;
    } else {
      end = middle;
    }
  }
  return below;
}

/* The median of the differences (the upper one of an even number), found by counting. */
static double calc_median_step(int count, const double *times, double start)
{
  const int rank = (count - 1) / 2;
  double low = HUGE_VAL, high = 0.0;
  int i;
  for (i = 1; i < count; ++i) {
    const double step = (times[i] - start) - (times[i - 1] - start);
    low = fmin(low, step);
    high = fmax(high, step);
  }
  while (low < high) {
    const double middle = low + 0.5 * (high - low);
    double below = low, above = high;
    int smaller = 0;
    for (i = 1; i < count; ++i) {
      const double step = (times[i] - start) - (times[i - 1] - start);
      if (step <= middle) {
        ++smaller;
        below = fmax(below, step);
      } else {
        above = fmin(above, step);
      }
    }
    if (rank < smaller) {
      if (below >= high) {
        return high; /* neighbouring numbers */
      }
      high = below;
    } else {
      low = above;
    }
  }
  return low;
}

/* Weights of the polynomial through four samples, at t. */
static void calc_lagrange(const double *times, double start, double t, double *weights)
{
  int i, j;
  for (i = 0; i < 4; ++i) {
    weights[i] = 1.0;
    for (j = 0; j < 4; ++j) {
      if (i != j) {
        weights[i] *= (t - (times[j] - start)) / ((times[i] - start) - (times[j] - start));
      }
    }
  }
}

/* Whether four samples have a gap. */
static int has_gap(const double *times, double start, double step)
{
  int i;
  for (i = 0; i < 3; ++i) {
    if ((times[i + 1] - start) - (times[i] - start) > 1.5 * step) {
      return 1;
    }
  }
  return 0;
}

static int is_dead(const twinmap_real *values, int count)
{
  int i;
  for (i = 1; i < count; ++i) {
    if (values[i] < values[0] || values[i] > values[0]) {
      return 0;
    }
  }
  return count >= 4;
}

static twinmap_error find_dead(int count, const double *times, const twinmap_real *const *signals, double start)
{
  const double from = grid_times[0], to = grid_times[TWINMAP_GRID - 1];
  const int before = count_before(count, times, start, from, 1), first = before > 0 ? before - 1 : 0;
  const int end = count_before(count, times, start, to, 0) + 1;
  int s;
  for (s = 0; s < TWINMAP_SIGNALS; ++s) {
    if (is_dead(signals[s] + first, (end < count ? end : count) - first)) {
      return TWINMAP_ERROR_DEAD;
    }
  }
  return TWINMAP_OK;
}

/* The response at grid time i, from samples that cover it. */
static twinmap_error resample_at(twinmap_state *state, int count, const double *times,
                                 const twinmap_real *const *signals, double start, double step, int i)
{
  const double t = grid_times[i], tolerance = 1e-6 * step;
  const int next = count_before(count, times, start, t - tolerance, 0);
  double weights[4];
  int first, s, k;
  if (next < count && fabs((times[next] - start) - t) <= tolerance) {
    for (s = 0; s < TWINMAP_SIGNALS; ++s) {
      state->response[s * TWINMAP_GRID + i] = signals[s][next];
    }
    return TWINMAP_OK;
  }
  if (count < 4 || step > 1.01 * grid_interval) {
    return TWINMAP_ERROR_RATE;
  }
  first = next - 2 < 0 ? 0 : (next - 2 > count - 4 ? count - 4 : next - 2);
  if (has_gap(times + first, start, step)) {
    return TWINMAP_ERROR_GAP;
  }
  calc_lagrange(times + first, start, t, weights);
  for (s = 0; s < TWINMAP_SIGNALS; ++s) {
    double sum = 0.0;
    for (k = 0; k < 4; ++k) {
      sum += weights[k] * signals[s][first + k];
    }
    state->response[s * TWINMAP_GRID + i] = sum;
  }
  return TWINMAP_OK;
}

/* The samples that matter: those that the grid needs and three beside; whether they can be used. */
static twinmap_error choose_samples(int count, const double *times, double start, int *first, int *used)
{
  const int margin = 3;
  int i, end;
  for (i = 1; i < count; ++i) {
    if (!(times[i] > times[i - 1])) {
      return TWINMAP_ERROR_TIMES;
    }
  }
  if (count < 2) {
    return TWINMAP_ERROR_TIMES;
  }
  *first = count_before(count, times, start, grid_times[0], 1) - 1 - margin;
  *first = *first < 0 ? 0 : *first;
  end = count_before(count, times, start, grid_times[TWINMAP_GRID - 1], 0) + 1 + margin;
  *used = (end < count ? end : count) - *first;
  return *used < 2 ? TWINMAP_ERROR_COVER : TWINMAP_OK;
}

static twinmap_error resample(twinmap_state *state, int count, const double *times,
                              const twinmap_real *const *signals, double start)
{
  const twinmap_real *shifted[TWINMAP_SIGNALS];
  int first, used, i, s;
  double step;
  twinmap_error error = choose_samples(count, times, start, &first, &used);
  if (error != TWINMAP_OK) {
    return error;
  }
  times += first;
  for (s = 0; s < TWINMAP_SIGNALS; ++s) {
    shifted[s] = signals[s] + first;
  }
  step = calc_median_step(used, times, start);
  if (times[0] - start > grid_times[0] + 1e-6 * step ||
      times[used - 1] - start < grid_times[TWINMAP_GRID - 1] - 1e-6 * step) {
    return TWINMAP_ERROR_COVER;
  }
  error = find_dead(used, times, shifted, start);
  for (i = 0; i < TWINMAP_GRID && error == TWINMAP_OK; ++i) {
    error = resample_at(state, used, times, shifted, start, step, i);
  }
  for (i = 0; i < TWINMAP_ROWS && error == TWINMAP_OK; ++i) {
    if (!(fabs(state->response[i]) <= 1.7976931348623157e308)) {
      error = TWINMAP_ERROR_NUMBER;
    }
  }
  return error;
}
