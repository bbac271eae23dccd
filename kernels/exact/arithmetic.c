/* Arithmetic. Sums run in one order, with the fused multiply-add where the machine has one: the weights of
   smooth processes cancel to a millionth of their size, and what is left of the rounding depends on both.
   Compilers for x86-64 use the instruction only where they are told to, so here they are, for all processors
   since 2013; for older ones define TWINMAP_ANY_PROCESSOR, and answers differ by some 1e-7 sd. */
#ifdef __clang__
#pragma STDC FP_CONTRACT OFF
#endif
#if defined(__GNUC__) && defined(__x86_64__) && !defined(__FMA__) && !defined(TWINMAP_ANY_PROCESSOR)
#define TWINMAP_FUSED 1
#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx2,fma"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,fma")
#pragma GCC optimize("O3")
#endif
#endif

#if defined(FP_FAST_FMA) || defined(__FMA__) || defined(__aarch64__) || defined(TWINMAP_FUSED)
#define multiply_add(a, b, c) fma((a), (b), (c))
#else
#define multiply_add(a, b, c) ((a) * (b) + (c))
#endif

enum { LANES = 8, CHUNK = 32 };

typedef union {
  double number;
  uint64_t bits;
} number_bits;

/* e^x after Cephes, without a branch, so that loops over it become vector instructions; 0 below -708.
   Within 2 units in the last place. */
static inline double exponential(double x)
{
  const double round = 6755399441055744.0; /* 1.5 * 2^52: what is added to it is rounded to a whole number */
  const double inside = x < -708.0 ? -708.0 : (x > 709.0 ? 709.0 : x);
  const double wanted = multiply_add(1.4426950408889634073599, inside, 0.5);
  const double nearest = (wanted + round) - round;
  const double n = nearest > wanted ? nearest - 1.0 : nearest;
  const double z = (inside - n * 0.693145751953125) - n * 1.42860682030941723212e-6;
  const double square = z * z;
  double p = 1.26177193074810590878e-4, q = 3.00198505138664455042e-6, e;
  number_bits scale;
  p = multiply_add(p, square, 3.02994407707441961300e-2);
  p = multiply_add(p, square, 9.99999999999999999910e-1) * z;
  q = multiply_add(q, square, 2.52448340349684104192e-3);
  q = multiply_add(q, square, 2.27265548208155028766e-1);
  q = multiply_add(q, square, 2.00000000000000000009);
  e = multiply_add(2.0, p / (q - p), 1.0);
  scale.number = n + round;
  scale.bits = (scale.bits + 1023u) << 52;
  return x < -708.0 ? 0.0 : e * scale.number;
}

static double add_lanes(const double *lane)
{
  const double a = lane[0] + lane[4], b = lane[1] + lane[5], c = lane[2] + lane[6], d = lane[3] + lane[7];
  return (a + b) + (c + d);
}

/* sum of a[i] b[i]. */
static double dot(int count, const double *a, const double *b)
{
  const int whole = count / LANES, pairs = whole / 2;
  double first[LANES] = {0.0}, second[LANES] = {0.0}, sum;
  int k, l;
  for (k = 0; k < pairs; ++k, a += 2 * LANES, b += 2 * LANES) {
    for (l = 0; l < LANES; ++l) {
      first[l] = multiply_add(a[l], b[l], first[l]);
    }
    for (l = 0; l < LANES; ++l) {
      second[l] = multiply_add(a[LANES + l], b[LANES + l], second[l]);
    }
  }
  for (l = 0; l < LANES; ++l) {
    first[l] += second[l];
  }
  if (whole > 2 * pairs) {
    for (l = 0; l < LANES; ++l) {
      first[l] = multiply_add(a[l], b[l], first[l]);
    }
    a += LANES;
    b += LANES;
  }
  sum = add_lanes(first);
  for (l = 0; l < count - whole * LANES; ++l) {
    sum = multiply_add(a[l], b[l], sum);
  }
  return sum;
}

#if TWINMAP_SCORES || TWINMAP_COMPRESSED
/* y += factor x. */
static void add_multiple(int count, double factor, const double *x, double *y)
{
  int i;
  for (i = 0; i < count; ++i) {
    y[i] = multiply_add(factor, x[i], y[i]);
  }
}
#endif

#if TWINMAP_SCORES || (TWINMAP_PROCESSES && !TWINMAP_COMPRESSED)
/* x = L^-1 x for a lower triangular L in tiles of CHUNK x CHUNK, row of tiles by row of tiles, each column by
   column; those on the diagonal hold their inverse. x: whole tiles. */
static void solve_tiles(int blocks, const wide_t *tile, double *x)
{
  double right[CHUNK], solved[CHUNK];
  int r, c, j, i;
  for (r = 0; r < blocks; ++r) {
    for (i = 0; i < CHUNK; ++i) {
      right[i] = x[r * CHUNK + i];
    }
    for (c = 0; c < r; ++c) {
      for (j = 0; j < CHUNK; ++j, tile += CHUNK) {
        const double known = x[c * CHUNK + j];
        for (i = 0; i < CHUNK; ++i) {
          right[i] = multiply_add(-tile[i], known, right[i]);
        }
      }
    }
    for (i = 0; i < CHUNK; ++i) {
      solved[i] = 0.0;
    }
    for (j = 0; j < CHUNK; ++j, tile += CHUNK) {
      const double known = right[j];
      for (i = 0; i < CHUNK; ++i) {
        solved[i] = multiply_add(-tile[i], known, solved[i]);
      }
    }
    for (i = 0; i < CHUNK; ++i) {
      x[r * CHUNK + i] = -solved[i];
    }
  }
}

#endif

#if TWINMAP_SCORES || TWINMAP_PROCESSES
/* x = L^-1 x for a small lower triangular L, row by row. */
static void solve_rows(int size, const double *lower, double *x)
{
  int i, j;
  for (i = 0; i < size; ++i) {
    for (j = 0; j < i; ++j) {
      x[i] = multiply_add(-lower[i * size + j], x[j], x[i]);
    }
    x[i] /= lower[i * size + i];
  }
}
#endif
