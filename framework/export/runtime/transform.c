/* The inputs of the processes: features through one affine map, then the known inputs over their bounds. */
@TABLES@

#if TWINMAP_COMPRESSED
#define TWINMAP_LESS_CENTER(i) - transform_center[i]
#else
#define TWINMAP_LESS_CENTER(i)
#endif

static void transform_features(twinmap_state *state, const double *known)
{
  double *inputs = state->inputs;
  int i;
#if TWINMAP_DIAGONAL
  for (i = 0; i < TWINMAP_INPUTS; ++i) {
    inputs[i] = transform_offset[i] + transform_matrix[i] * (state->features[i] TWINMAP_LESS_CENTER(i));
  }
#else
  /* in blocks of features, the sums of each added at once */
  enum { BLOCK = TWINMAP_FEATURES < 128 ? TWINMAP_FEATURES : (TWINMAP_INPUTS < 4000 ? 16 : 4) };
  double *sum = state->gradient; /* free until the processes are evaluated */
  const transform_t *column = transform_matrix;
  int first, j;
  for (i = 0; i < TWINMAP_INPUTS; ++i) {
    inputs[i] = transform_offset[i];
  }
  for (first = 0; first < TWINMAP_FEATURES; first += BLOCK) {
    for (i = 0; i < TWINMAP_INPUTS; ++i) {
      sum[i] = 0.0;
    }
    for (j = first; j < first + BLOCK && j < TWINMAP_FEATURES; ++j, column += TWINMAP_INPUTS) {
      for (i = 0; i < TWINMAP_INPUTS; ++i) {
        sum[i] = multiply_add(state->features[j] TWINMAP_LESS_CENTER(j), column[i], sum[i]);
      }
    }
    for (i = 0; i < TWINMAP_INPUTS; ++i) {
      inputs[i] += sum[i];
    }
  }
#endif
#if TWINMAP_KNOWN
  for (i = 0; i < TWINMAP_KNOWN; ++i) {
    inputs[TWINMAP_INPUTS + i] = (known[i] - known_center[i]) / known_half_width[i];
  }
#else
  (void)known;
#endif
}
