/* Triangular factors. Every element is made of the same operations in the same order, however the loops are
   cut. */

/* Where column j of a packed lower triangle begins: with its diagonal. */
static int find_column(int size, int j)
{
  return j * size - j * (j - 1) / 2;
}

/* L of C = L L', packed column by column, in place. */
static void factorise(int size, double *lower)
{
  int j, k, i;
  for (j = 0; j < size; ++j) {
    const int count = size - j;
    double *column = lower + find_column(size, j), pivot;
    for (k = 0; k + 3 < j; k += 4) { /* four at a time: a quarter of the traffic */
      const double *a = lower + find_column(size, k) + (j - k), *b = lower + find_column(size, k + 1) + (j - k - 1);
      const double *c = lower + find_column(size, k + 2) + (j - k - 2), *d = lower + find_column(size, k + 3) + (j - k - 3);
      const double of_a = -a[0], of_b = -b[0], of_c = -c[0], of_d = -d[0];
      for (i = 0; i < count; ++i) {
        double sum = multiply_add(of_a, a[i], column[i]);
        sum = multiply_add(of_b, b[i], sum);
        sum = multiply_add(of_c, c[i], sum);
        column[i] = multiply_add(of_d, d[i], sum);
      }
    }
    for (; k < j; ++k) {
      const double *before = lower + find_column(size, k) + (j - k);
      add_multiple(count, -before[0], before, column);
    }
    pivot = sqrt(column[0]);
    column[0] = pivot;
    for (i = 1; i < count; ++i) {
      column[i] /= pivot;
    }
  }
}

/* x = L^-1 x. */
static void solve_columns(int size, const double *lower, double *x)
{
  int j;
  for (j = 0; j < size; ++j) {
    const double *column = lower + find_column(size, j);
    x[j] /= column[0];
    add_multiple(size - j - 1, -x[j], column + 1, x + j + 1);
  }
}

#if TWINMAP_SCORES
/* 2 log det L. */
static double calc_log_determinant(int size, const double *lower)
{
  double sum = 0.0;
  int j;
  for (j = 0; j < size; ++j) {
    sum += log(lower[find_column(size, j)]);
  }
  return 2.0 * sum;
}

/* L of a small matrix, row by row, perhaps in place; whether it is positive definite. */
static int factorise_small(int size, const double *matrix, double *lower)
{
  int i, j, k;
  for (j = 0; j < size; ++j) {
    for (i = j; i < size; ++i) {
      double sum = matrix[i * size + j];
      for (k = 0; k < j; ++k) {
        sum = multiply_add(-lower[i * size + k], lower[j * size + k], sum);
      }
      if (i == j) {
        if (!(sum > 0.0)) {
          return 0;
        }
        lower[j * size + j] = sqrt(sum);
      } else {
        lower[i * size + j] = sum / lower[j * size + j];
      }
    }
  }
  return 1;
}

/* x = (L L')^-1 x for a factor of factorise_small. */
static void solve_small(int size, const double *lower, double *x)
{
  int i, j;
  solve_rows(size, lower, x);
  for (i = size - 1; i >= 0; --i) {
    for (j = i + 1; j < size; ++j) {
      x[i] = multiply_add(-lower[j * size + i], x[j], x[i]);
    }
    x[i] /= lower[i * size + i];
  }
}

/* log det of a small matrix that is positive definite; small: room for its factor. */
static double calc_small_log_determinant(int size, const double *matrix, double *small)
{
  double sum = 0.0;
  int i;
  (void)factorise_small(size, matrix, small);
  for (i = 0; i < size; ++i) {
    sum += log(small[i * size + i]);
  }
  return 2.0 * sum;
}
#endif
