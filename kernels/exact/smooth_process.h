/* A process of smooth functions, known at n points z of p variables. Tables of n x p numbers lie variable by
   variable. */
enum { SMOOTH_EXPONENTIAL, SMOOTH_MATERN_52 };

typedef struct {
  int covariance, points, variables;
  int slope_points, slope_variables; /* m, u: the first, of which slopes are known too */
  double nugget;
  const wide_t *scaled_points; /* z / l */
} smooth_process;

/* What it has at a point x: with D = (x - z) / l and s = |D|^2 the covariances k(s), g = -2 k' and h = -2 g'. */
typedef struct {
  double *differences;      /* n x p */
  double *squares, *kernel; /* s, k */
  double *slopes, *curvatures;
  double *projected;        /* m: of the function evaluated last */
  double *buffer;           /* n, in whole tiles */
} smooth_point;

/* What a process's own variance takes, where no slopes are known. */
typedef struct {
  int padded, terms;         /* n in whole tiles; of the trend */
  const wide_t *tiles;       /* factor of the points' covariance */
  const wide_t *solved_terms; /* the trend's terms, whitened, n each */
  const wide_t *term_factor; /* of their information, row by row */
} own_variance;
