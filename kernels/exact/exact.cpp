#include "kernels/exact/exact.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>

#define restrict __restrict__
#define TWINMAP_SCORES 1
#define TWINMAP_PROCESSES 0
#define TWINMAP_COMPRESSED 0

namespace twinmap::exact {
namespace c {
namespace {

// Each uses those before it.
// clang-format off
#include "kernels/exact/arithmetic.c"
#include "kernels/exact/triangles.c"
#include "kernels/exact/smooth_process.c"
#include "kernels/exact/least_squares.c"
#include "kernels/exact/box_moments.c"
// clang-format on

}  // namespace
}  // namespace c

double dot(int count, const double* a, const double* b) {
  return c::dot(count, a, b);
}
void addMultiple(int count, double factor, const double* x, double* y) {
  c::add_multiple(count, factor, x, y);
}
void factorise(int size, double* lower) {
  c::factorise(size, lower);
}
double calcLogDeterminant(int size, const double* lower) {
  return c::calc_log_determinant(size, lower);
}
void solveColumns(int size, const double* lower, double* x) {
  c::solve_columns(size, lower, x);
}
double calcSmallLogDeterminant(int size, const double* matrix, double* lower) {
  return c::calc_small_log_determinant(size, matrix, lower);
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
void calcInformation(int r, int u, const double* jacobian, double* information) {
  c::calc_information(r, u, jacobian, information);
}
void calcPull(int u, const double* relative, const double* mean, const double* x, double* offset,
              double* pull) {
  c::calc_pull(u, relative, mean, x, offset, pull);
}
bool solveStep(int u, const double* information, const double* relative, const double* pull, double damping,
               double* small, double* step) {
  return c::solve_step(u, information, relative, pull, damping, small, step) != 0;
}
bool isMisfit(double chi_square, int count) {
  return c::is_misfit(chi_square, count) != 0;
}
double calcWidening(int count, const double* stddev, const double* scores, const double* values) {
  return c::calc_widening(count, stddev, scores, values);
}
void calcBoxMoments(int u, const double* precision, const double* shift, double* buffer, double* mean,
                    double* covariance) {
  c::calc_box_moments(u, precision, shift, buffer, mean, covariance);
}

}  // namespace twinmap::exact
