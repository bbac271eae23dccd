#pragma once

/// Arithmetic whose bits are stated. Weights of smooth processes cancel to a millionth of their size, so that
/// what they predict carries rounding errors of 1e-10, and whoever sums in another order finds other answers.
/// Here each number is made of the same operations in the same order on every processor with a fused
/// multiply-add and in every build: the sources are C99 (the .c beside this file), which exported maps
/// contain as they are (framework/export), and are compiled here without contraction. Matrices lie column by
/// column.
namespace twinmap::exact {

using wide_t = double;
#include "kernels/exact/smooth_process.h"

/// sum of a_i b_i.
double dot(int count, const double* a, const double* b);

/// y += factor x.
void addMultiple(int count, double factor, const double* x, double* y);

/// Factorises C = L L', packed (lower triangle column by column), in place. Cost: size^3 / 3 flops.
void factorise(int size, double* lower);
/// 2 log det L of such a factor.
double calcLogDeterminant(int size, const double* lower);
/// x = L^-1 x for such a factor. Cost: size^2 flops.
void solveColumns(int size, const double* lower, double* x);

/// log det of a small symmetric matrix that is positive definite (u x u). lower: room for as many.
double calcSmallLogDeterminant(int size, const double* matrix, double* lower);

/// D, s, k and its derivatives for a point x over the length scales (p).
void calcPointCovariance(const smooth_process& process, const double* x, const smooth_point& at);
/// A function without its trend at that point, from its weights (n + u m).
double calcFunction(const smooth_process& process, const double* weights, const smooth_point& at);
/// Derivatives of the function evaluated last with respect to the first variables, times their length scales.
/// rising: room for as many.
void calcFunctionSlopes(const smooth_process& process, const double* weights, const smooth_point& at,
                        int variables, double* rising, double* derivatives);
/// The variance, for one of 1, of a value given those at the nearest 20 points alone, but one (-1: none).
/// Cost: 200 exponentials, 20^3 / 3 flops.
double calcLocalVariance(const smooth_process& process, const smooth_point& at, int without);
/// The process's own variance, for one of 1. trend: its terms at the point; rest: room for as many.
double calcOwnVariance(const smooth_process& process, const own_variance& own, const double* trend,
                       const smooth_point& at, double* rest);
/// The same from L^-1 k (n), however that was solved.
double finishOwnVariance(const smooth_process& process, const own_variance& own, const double* trend,
                         const double* solved, double* rest);
/// By how much the errors near a point are beyond their variance; ratios: of each of the n points, left out.
double calcLocalFactor(const smooth_process& process, const double* ratios, const smooth_point& at);

/// J'J (u x u) for J of r x u.
void calcInformation(int r, int u, const double* jacobian, double* information);
/// What a normal prior draws x (u) with, over 3: its information over 3 (relative, u x u) times the offset of
/// x from its mean; 1 is the relative information of the box.
void calcPull(int u, const double* relative, const double* mean, const double* x, double* offset,
              double* pull);
/// The damped step of least squares, in place of J'residual, under a prior of that information and pull;
/// false where its information is not positive definite. small: u x u.
bool solveStep(int u, const double* information, const double* relative, const double* pull, double damping,
               double* small, double* step);
/// Whether chi-square is four standard deviations above its mean: one in 10000 by chance.
bool isMisfit(double chi_square, int count);
/// By how much the errors of scores (stddev) are to be enlarged to explain their residuals; 0: they do so.
double calcWidening(int count, const double* stddev, const double* scores, const double* values);

/// Mean and covariance of exp(-x'Q x / 2 + b'x) within the box [-1, 1]^u, by expectation propagation. buffer:
/// u (u + 3).
void calcBoxMoments(int u, const double* precision, const double* shift, double* buffer, double* mean,
                    double* covariance);

}  // namespace twinmap::exact
