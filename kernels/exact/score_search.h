/* A search for the u unknowns that explain r scores, which windows of processes predict from m variables, the
   unknowns first; variables are normalised: -1 and 1 are their bounds. Tables of r x u numbers lie variable by
   variable, what is u x u is symmetric. */
enum { MOST_MINIMA = 4 };

typedef struct score_search score_search;

/* Of consecutive scores. */
typedef struct {
  int first, functions;
  int leading; /* of them, from the first on, those that the first search looks at */
} score_window;

/* What does not change from one measurement to the next. */
typedef struct {
  int scores, unknown, variables, windows, points; /* r, u, m; n: training simulations */
  const score_window *window;
  const wide_t *rough_weights;   /* r: 1 / standard deviation of noise and mean error */
  const wide_t *leading_weights; /* the same of those that the first search looks at, else 0 */
  const wide_t *correlation;     /* of the scores' errors: lower triangle, column by column */
  const wide_t *prior_mean, *prior_relative; /* u, u x u: 0 and 1 where it is uniform within the bounds */
  const wide_t *training_points; /* m x n, point by point */
  const real_t *training_scores; /* r x n, point by point */
  /* The first `count` values of a window and their derivatives with respect to the unknowns, at search->at. */
  void (*evaluate)(const score_search *search, int window, int count);
  /* Their standard deviations, at the point evaluated last. */
  void (*calc_stddev)(const score_search *search, int window);
} score_problem;

/* A minimum, and the normal likelihood around it. */
typedef struct {
  double objective;
  int widened;
  double *point, *innovation;              /* u; r: what it leaves of the scores, whitened */
  double *information, *noise_information; /* u x u; the latter without the processes' errors */
  double *shift, *mean, *covariance;       /* u, u, u x u */
} score_minimum;

struct score_search {
  const score_problem *problem;
  void *owner;
  double *at, *scores, *values, *stddev; /* m, r, r, r */
  double *residual, *jacobian, *scaled_jacobian; /* r, r x u, r x u */
  double *widening;                      /* of each window's standard deviations */
  double *lower, log_determinant;        /* of C, factorised */
  double *descent, *step, *trial, *offset, *pull, *before; /* u */
  double *normal, *small;                /* u x u */
  double *start;                         /* MOST_MINIMA points of u */
  int evaluated, minimum_count;
  score_minimum minima[MOST_MINIMA];     /* the best first */
  double share[MOST_MINIMA];             /* of the evidence */
  double *mean, *covariance, *noise_stddev; /* of the mixed minima: u, u x u, u */
  double *box_buffer;                    /* u (u + 3) */
};
