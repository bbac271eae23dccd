#include "kernels/exact/exact.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>

#define restrict __restrict__
#define TWINMAP_SCORES 1
#define TWINMAP_PROCESSES 0
#define TWINMAP_COMPRESSED 0
#define TWINMAP_TRUST 1

namespace twinmap::exact {
namespace c {
namespace {

// Each uses those before it.
// clang-format off
#include "kernels/exact/arithmetic.c"
#include "kernels/exact/triangles.c"
#include "kernels/exact/smooth_process.c"
#include "kernels/exact/least_squares.c"
#include "kernels/exact/score_search.c"
#include "kernels/exact/score_minima.c"
#include "kernels/exact/box_moments.c"
#include "kernels/exact/score_mixture.c"
// clang-format on

}  // namespace
}  // namespace c

double dot(int count, const double* a, const double* b) {
  return c::dot(count, a, b);
}
void addMultiple(int count, double factor, const double* x, double* y) {
  c::add_multiple(count, factor, x, y);
}
void solveColumns(int size, const double* lower, double* x) {
  c::solve_columns(size, lower, x);
}
void calcPointCovariance(const smooth_process& process, const double* x, const smooth_point& at) {
  c::calc_point_covariance(&process, x, &at);
}
double calcFunction(const smooth_process& process, const double* weights, const smooth_point& at) {
  return c::calc_function(&process, weights, &at);
}
void calcFunctionSlopes(const smooth_process& process, const double* weights, const smooth_point& at,
                        int variables, double* rising, double* derivatives) {
  c::calc_function_slopes(&process, weights, &at, variables, rising, derivatives);
}
double calcLocalVariance(const smooth_process& process, const smooth_point& at, int without) {
  return c::calc_local_variance(&process, &at, without);
}
double calcOwnVariance(const smooth_process& process, const own_variance& own, const double* trend,
                       const smooth_point& at, double* rest) {
  return c::calc_own_variance(&process, &own, trend, &at, rest);
}
double finishOwnVariance(const smooth_process& process, const own_variance& own, const double* trend,
                         const double* solved, double* rest) {
  return c::finish_own_variance(&process, &own, trend, solved, rest);
}
double calcLocalFactor(const smooth_process& process, const double* ratios, const smooth_point& at) {
  return c::calc_local_factor(&process, ratios, &at);
}
void calcBoxMoments(int u, const double* precision, const double* shift, double* buffer, double* mean,
                    double* covariance) {
  c::calc_box_moments(u, precision, shift, buffer, mean, covariance);
}
int countSearch(int r, int u, int m, int windows) {
  return m + windows + r * (r + 1) / 2 + r * (2 * u + 4 + MOST_MINIMA) + u * (11 + 4 * MOST_MINIMA) +
         u * u * (4 + 3 * MOST_MINIMA);
}
score_search layOutSearch(const score_problem& problem, void* owner, double* room) {
  return c::lay_out_search(&problem, owner, room);
}
void searchFromSimulations(score_search& search) {
  c::search_roughly(&search, c::find_starts(&search, 0));
}
void searchFrom(score_search& search, const double* point) {
  c::search_from(&search, point);
}
void refineMinimum(score_search& search, int index, bool may_widen) {
  c::refine_minimum(&search, index, may_widen ? 1 : 0);
}
int findLeast(const score_search& search) {
  return c::find_least(&search);
}
int mixMinima(score_search& search, const double* within, const double* shift) {
  return c::mix_minima(&search, within, shift);
}

}  // namespace twinmap::exact
