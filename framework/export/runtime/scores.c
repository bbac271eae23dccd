/* Scores of features, and the box of the simulations. */
@TABLES@

static void calc_scores(const double *features, double *scores)
{
  int j, i;
  for (i = 0; i < TWINMAP_SCORES; ++i) {
    scores[i] = 0.0;
  }
  for (j = 0; j < TWINMAP_FEATURES; ++j) {
    add_multiple(TWINMAP_SCORES, features[j] - feature_center[j], projection + j * TWINMAP_SCORES, scores);
  }
}

/* The known variables of a point at which the processes are evaluated. */
static void set_known(const double *known, double *point)
{
#if TWINMAP_KNOWN
  int i;
  for (i = 0; i < TWINMAP_KNOWN; ++i) {
    const int v = TWINMAP_UNKNOWN + i;
    point[v] = (known[i] - box_center[v]) / box_half_width[v];
  }
#else
  (void)known;
  (void)point;
#endif
}
