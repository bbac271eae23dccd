/* The map: a neural network beside a regression. Its inputs x are projected features and known inputs, its
   targets the parameters on [-1, 1] of their bounds,
     y = offset + regression of x and of products of its first numbers + scale t,
   where hidden layers h -> SiLU(weights h + biases), SiLU(a) = a / (1 + exp(-a)), end in a head that says of t:
   means m, logarithms o and the strictly lower triangle of A make (1 + A)' D (t - m), D = diag(exp o), standard
   normal. */
typedef struct {
  int inputs, outputs;
  const real_t *weights; /* input by input */
  const real_t *biases;
} layer;

enum { P = TWINMAP_PARAMETERS, K = TWINMAP_INPUTS + TWINMAP_KNOWN };

@TABLES@

static void make_inputs(twinmap_state *state, const double *known)
{
  int i;
  for (i = 0; i < TWINMAP_FEATURES; ++i) {
    state->deviations[i] = state->features[i] - input_center[i];
  }
  for (i = 0; i < TWINMAP_INPUTS; ++i) {
    state->inputs[i] = dot(TWINMAP_FEATURES, input_projection + i * TWINMAP_FEATURES, state->deviations);
  }
#if TWINMAP_KNOWN
  for (i = 0; i < TWINMAP_KNOWN; ++i) {
    state->inputs[TWINMAP_INPUTS + i] = (known[i] - known_center[i]) / known_half_width[i];
  }
#else
  (void)known;
#endif
}

#if TWINMAP_PRODUCTS
/* x_i x_j of the first SQUARED inputs, then x_i x_j x_k of the first CUBED, i <= j <= k. */
static void calc_products(const double *x, double *product)
{
  int i, j, k;
  for (j = 0; j < TWINMAP_SQUARED; ++j) {
    for (i = 0; i <= j; ++i) {
      *product++ = x[j] * x[i];
    }
  }
  for (k = 0; k < TWINMAP_CUBED; ++k) {
    for (j = 0; j <= k; ++j) {
      const double both = x[k] * x[j];
      for (i = 0; i <= j; ++i) {
        *product++ = both * x[i];
      }
    }
  }
}
#endif

/* y += factor x. */
static void add_weights(int count, double factor, const real_t *x, double *y)
{
  int i;
  for (i = 0; i < count; ++i) {
    y[i] = multiply_add(x[i], factor, y[i]);
  }
}

/* What the head says; it lies in the state. */
static const double *calc_head(twinmap_state *state)
{
  const double *input = state->inputs;
  double *output = state->units, *other = state->other_units;
  int l, i;
  for (l = 0; l < TWINMAP_LAYERS; ++l) {
    const layer *at = &layers[l];
    double *swap = output;
    for (i = 0; i < at->outputs; ++i) {
      output[i] = at->biases[i];
    }
    for (i = 0; i < at->inputs; ++i) {
      add_weights(at->outputs, input[i], at->weights + i * at->outputs, output);
    }
    for (i = 0; i < at->outputs && l + 1 < TWINMAP_LAYERS; ++i) {
      output[i] /= 1.0 + exponential(-output[i]);
    }
    input = output;
    output = other;
    other = swap;
  }
  return input;
}

/* D^-1 (1 + A)^-T, column by column: t = m + it times a standard normal vector. */
static void calc_root(const double *head, double *root)
{
  const double *triangle = head + 2 * P; /* of A, row by row */
  int i, j, k;
  for (i = 0; i < P; ++i) {
    for (j = 0; j < P; ++j) {
      double sum = i == j ? 1.0 : 0.0;
      for (k = i; k < j; ++k) {
        sum = multiply_add(-triangle[j * (j - 1) / 2 + k], root[k * P + i], sum);
      }
      root[j * P + i] = sum;
    }
  }
  for (i = 0; i < P; ++i) {
    const double stddev = exponential(-head[P + i]);
    for (j = i; j < P; ++j) {
      root[j * P + i] *= stddev;
    }
  }
}

/* The share of an answer's deviation from the bounds' middle that is kept: all, unless it is wider than they are. */
static double calc_shrinkage(double sd, double half_width)
{
  return sd > half_width ? half_width / sd : 1.0;
}

static void infer_by_map(twinmap_state *state, const double *known, twinmap_result *result)
{
  const double *head;
  double unit[P]; /* of a target, in the parameter's unit, calibrated and shrunk */
  int i, j, k;
  make_inputs(state, known);
#if TWINMAP_PRODUCTS
  calc_products(state->inputs, state->products);
#endif
  head = calc_head(state);
  calc_root(head, state->root);
  for (i = 0; i < P; ++i) {
    double y = target_offset[i] + dot(K, regression_linear + i * K, state->inputs);
#if TWINMAP_PRODUCTS
    y += dot(TWINMAP_PRODUCTS, regression_products + i * TWINMAP_PRODUCTS, state->products);
#endif
    y = multiply_add(target_scale[i], head[i], y);
    unit[i] = stddev_scale[i] * parameter_half_width[i] * target_scale[i];
    for (k = i; k >= 0; --k) {
      double covariance = 0.0;
      for (j = i; j < P; ++j) {
        covariance = multiply_add(state->root[j * P + i], state->root[j * P + k], covariance);
      }
      if (k == i) {
        const double sd = unit[i] * sqrt(covariance);
        const double kept = calc_shrinkage(sd, parameter_half_width[i]);
        result->mean[i] = multiply_add(kept * parameter_half_width[i], y, parameter_center[i]);
        result->sd[i] = kept * sd;
        unit[i] *= kept;
      }
      result->covariance[i * P + k] = result->covariance[k * P + i] = unit[i] * unit[k] * covariance;
    }
  }
}
