/* The map: Gaussian processes from transformed features to the parameters. At a point x, with k the
   covariances with the inputs z of a process, v = L^-1 k (of a sparse one also a = L_B^-1 v):
     mean             k'w + h(x)'b
     latent variance  k(x, x) - v'v + a'a + e'(R R')^-1 e,   e = h(x) - V'v or h(x) - V'a. */
enum { SQUARED_EXPONENTIAL, MATERN_32, MATERN_52, RATIONAL_QUADRATIC, BATCH = 4 };
enum { PROCESS_INPUTS = TWINMAP_INPUTS + TWINMAP_KNOWN };

/* Parameters that share their inputs, and so the pass over them. */
typedef struct {
  int first, count, chunks;
  const wide_t *center;
  const wide_t *inputs;         /* z - center: chunks of CHUNK inputs, feature by feature */
  const wide_t *inverse_square; /* 1 / l^2: of each feature BATCH numbers, or one where count is 1 */
} process_batch;

typedef struct {
  int covariance, inputs, chunks, coefficients;
  double signal_variance, shape, linear_variance, noise_variance;
  const wide_t *weights;           /* w, zero beyond the inputs */
  const wide_t *factor;            /* L in tiles */
  const wide_t *correction;        /* L_B in tiles, or NULL */
  const wide_t *whitened_basis;    /* V, a column a coefficient */
  const wide_t *basis_factor;      /* R, row by row */
  const wide_t *mean_coefficients; /* b */
  const wide_t *constant_gradient; /* of the linear terms */
  double mean_slope;               /* of the squared slopes along the noise, at the training inputs */
} process;

@TABLES@

static void calc_distances_of_one(const process_batch *batch, const double *point, double *distances)
{
  const wide_t *z = batch->inputs;
  int c, f, i;
  for (c = 0; c < batch->chunks; ++c) {
    double sum[CHUNK] = {0.0};
    for (f = 0; f < PROCESS_INPUTS; ++f, z += CHUNK) {
      for (i = 0; i < CHUNK; ++i) {
        const double difference = z[i] - point[f];
        sum[i] = multiply_add(difference * difference, batch->inverse_square[f], sum[i]);
      }
    }
    for (i = 0; i < CHUNK; ++i) {
      distances[c * CHUNK + i] = sum[i];
    }
  }
}

static void calc_distances_of_batch(const process_batch *batch, const double *point, double *distances)
{
  const int stride = batch->chunks * CHUNK;
  const wide_t *z = batch->inputs;
  int c, f, i;
  for (c = 0; c < batch->chunks; ++c) {
    double *d0 = distances + c * CHUNK, *d1 = d0 + stride, *d2 = d1 + stride, *d3 = d2 + stride;
    double s0[CHUNK] = {0.0}, s1[CHUNK] = {0.0}, s2[CHUNK] = {0.0}, s3[CHUNK] = {0.0};
    const wide_t *w = batch->inverse_square;
    for (f = 0; f < PROCESS_INPUTS; ++f, z += CHUNK, w += BATCH) {
      for (i = 0; i < CHUNK; ++i) {
        const double difference = z[i] - point[f], square = difference * difference;
        s0[i] = multiply_add(square, w[0], s0[i]);
        s1[i] = multiply_add(square, w[1], s1[i]);
        s2[i] = multiply_add(square, w[2], s2[i]);
        s3[i] = multiply_add(square, w[3], s3[i]);
      }
    }
    for (i = 0; i < CHUNK; ++i) {
      d0[i] = s0[i];
      d1[i] = s1[i];
      d2[i] = s2[i];
      d3[i] = s3[i];
    }
  }
}

/* k and -2 dk / dq of unit variance, from q = r^2. */
static void evaluate_radial(const process *p, const double *q, double *value, double *weight)
{
  const int count = p->chunks * CHUNK;
  int i;
  switch (p->covariance) {
    case MATERN_32:
      for (i = 0; i < count; ++i) {
        const double root = sqrt(3.0 * q[i]), decay = exponential(-root);
        value[i] = (1.0 + root) * decay;
        weight[i] = 3.0 * decay;
      }
      break;
    case MATERN_52:
      for (i = 0; i < count; ++i) {
        const double root = sqrt(5.0 * q[i]), decay = exponential(-root);
        const double rest = (1.0 + root) * decay;
        value[i] = multiply_add(5.0 / 3.0 * q[i], decay, rest);
        weight[i] = rest * (5.0 / 3.0);
      }
      break;
    case RATIONAL_QUADRATIC:
      for (i = 0; i < count; ++i) {
        const double base = 1.0 + q[i] / (2.0 * p->shape);
        value[i] = exp(-p->shape * log(base));
        weight[i] = value[i] / base;
      }
      break;
    default:
      for (i = 0; i < count; ++i) {
        value[i] = exponential(-0.5 * q[i]);
        weight[i] = value[i];
      }
  }
}

static double basis(int k, const double *point)
{
  return k == 0 ? 1.0 : point[k - 1];
}

/* Leaves k in the covariances, -2 dk / dq in the radial slopes; gives the mean and k(x, x). */
static double calc_mean(const process *p, const process_batch *batch, int of_batch, twinmap_state *state,
                        double *prior)
{
  const int count = p->chunks * CHUNK;
  double *k = state->covariances, mean;
  int i;
  evaluate_radial(p, state->distances + of_batch * count, k, state->radial_slopes);
  for (i = 0; i < count; ++i) {
    k[i] *= p->signal_variance;
  }
  *prior = p->signal_variance;
  if (p->linear_variance > 0.0) {
    const wide_t *z = batch->inputs;
    int c, f;
    for (c = 0; c < p->chunks; ++c) {
      for (f = 0; f < PROCESS_INPUTS; ++f, z += CHUNK) {
        for (i = 0; i < CHUNK; ++i) {
          k[c * CHUNK + i] = multiply_add(z[i], p->linear_variance * state->point[f], k[c * CHUNK + i]);
        }
      }
    }
    for (f = 0; f < PROCESS_INPUTS; ++f) {
      *prior = multiply_add(p->linear_variance * state->point[f], state->point[f], *prior);
    }
  }
  for (i = p->inputs; i < count; ++i) {
    k[i] = 0.0;
  }
  mean = dot(count, p->weights, k);
  for (i = 0; i < p->coefficients; ++i) {
    mean = multiply_add(p->mean_coefficients[i], basis(i, state->point), mean);
  }
  return mean;
}

/* Destroys the covariances. */
static double calc_latent_variance(const process *p, double prior, twinmap_state *state)
{
  const int count = p->chunks * CHUNK;
  double *v = state->covariances, variance;
  int i;
  solve_tiles(p->chunks, p->factor, v);
  variance = prior - dot(count, v, v);
  if (p->correction) {
    solve_tiles(p->chunks, p->correction, v);
    variance += dot(count, v, v);
  }
  if (p->coefficients > 0) {
    double *error = state->basis_error, sum = 0.0;
    for (i = 0; i < p->coefficients; ++i) {
      error[i] = basis(i, state->point) - dot(count, p->whitened_basis + i * count, v);
    }
    solve_rows(p->coefficients, p->basis_factor, error);
    for (i = 0; i < p->coefficients; ++i) {
      sum = multiply_add(error[i], error[i], sum);
    }
    variance += sum;
  }
  return fmax(variance, 0.0);
}

#if TWINMAP_DIRECTIONS
static double add_all(int count, const double *values)
{
  double first[LANES] = {0.0}, second[LANES] = {0.0};
  int i, l;
  for (i = 0; i < count; i += 2 * LANES) { /* CHUNK is a multiple of it */
    for (l = 0; l < LANES; ++l) {
      first[l] += values[i + l];
      second[l] += values[i + LANES + l];
    }
  }
  for (l = 0; l < LANES; ++l) {
    first[l] += second[l];
  }
  return add_lanes(first);
}

/* dm/dx = sum of w (-2 dk/dq) (z - x) / l^2. */
static void calc_gradient(const process *p, const process_batch *batch, int of_batch, twinmap_state *state)
{
  const int count = p->chunks * CHUNK, stride = batch->count == 1 ? 1 : BATCH;
  double *weight = state->radial_slopes, sum;
  const wide_t *z = batch->inputs;
  int c, f, i, l;
  for (i = 0; i < count; ++i) {
    weight[i] *= p->signal_variance * p->weights[i];
  }
  sum = add_all(count, weight);
  for (f = 0; f < PROCESS_INPUTS; ++f) {
    state->gradient[f] = -sum * state->point[f];
  }
  for (c = 0; c < p->chunks; ++c) {
    for (f = 0; f < PROCESS_INPUTS; ++f, z += CHUNK) {
      double lane[LANES] = {0.0};
      for (i = 0; i < CHUNK; i += LANES) {
        for (l = 0; l < LANES; ++l) {
          lane[l] = multiply_add(z[i + l], weight[c * CHUNK + i + l], lane[l]);
        }
      }
      state->gradient[f] += add_lanes(lane);
    }
  }
  for (f = 0; f < PROCESS_INPUTS; ++f) {
    state->gradient[f] =
        multiply_add(state->gradient[f], batch->inverse_square[f * stride + of_batch], p->constant_gradient[f]);
  }
}
#endif

/* How much larger the noise of a parameter is where the map is steep than on average. */
static double calc_noise_factor(const process *p, twinmap_state *state)
{
#if TWINMAP_DIRECTIONS
  double sum = 0.0;
  int r;
  if (!(p->mean_slope > 0.0)) {
    return 1.0;
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

static void infer_by_map(twinmap_state *state, const double *known, twinmap_result *result)
{
  int b, i;
  transform_features(state, known);
  for (b = 0; b < TWINMAP_BATCHES; ++b) {
    const process_batch *batch = &process_batches[b];
    for (i = 0; i < PROCESS_INPUTS; ++i) {
      state->point[i] = state->inputs[i] - batch->center[i];
    }
    if (batch->count == 1) {
      calc_distances_of_one(batch, state->point, state->distances);
    } else {
      calc_distances_of_batch(batch, state->point, state->distances);
    }
    for (i = 0; i < batch->count; ++i) {
      const int parameter = batch->first + i;
      const process *p = &processes[parameter];
      double prior, latent;
      const double mean = calc_mean(p, batch, i, state, &prior);
      latent = calc_latent_variance(p, prior, state);
#if TWINMAP_DIRECTIONS
      calc_gradient(p, batch, i, state);
#endif
      result->mean[parameter] = multiply_add(target_scale[parameter], mean, target_offset[parameter]);
      result->sd[parameter] =
          target_scale[parameter] *
          sqrt(multiply_add(p->noise_variance, calc_noise_factor(p, state), latent));
      result->ratio_to_limit[parameter] = 0.0;
    }
  }
}
