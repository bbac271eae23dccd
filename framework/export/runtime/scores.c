/* Scores of features, and the box of the simulations. */
@TABLES@

static void calc_scores(twinmap_state *state)
{
  int j, i;
  for (i = 0; i < TWINMAP_SCORES; ++i) {
    state->scores[i] = 0.0;
  }
  for (j = 0; j < TWINMAP_FEATURES; ++j) {
    add_multiple(TWINMAP_SCORES, state->features[j] - feature_center[j], projection + j * TWINMAP_SCORES,
                 state->scores);
  }
}

/* The known variables of the point at which the processes are evaluated. */
static void set_known(twinmap_state *state, const double *known)
{
#if TWINMAP_KNOWN
  int i;
  for (i = 0; i < TWINMAP_KNOWN; ++i) {
    const int v = TWINMAP_UNKNOWN + i;
    state->at[v] = (known[i] - box_center[v]) / box_half_width[v];
  }
#else
  (void)state;
  (void)known;
#endif
}
