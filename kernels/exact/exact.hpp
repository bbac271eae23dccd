#pragma once

/// Arithmetic whose bits are stated. Weights of smooth processes cancel to a millionth of their size, so that
/// what they predict carries rounding errors of 1e-10, and whoever sums in another order finds other answers.
/// Here each number is made of the same operations in the same order on every processor with a fused
/// multiply-add and in every build: the sources are C99 (the .c beside this file), which exported maps
/// contain as they are (framework/export), and are compiled here without contraction. Matrices lie column by
/// column.
namespace twinmap::exact {

using wide_t = double;
using real_t = double;
#include "kernels/exact/score_search.h"
#include "kernels/exact/smooth_process.h"

/// sum of a_i b_i.
double dot(int count, const double* a, const double* b);

/// y += factor x.
void addMultiple(int count, double factor, const double* x, double* y);

/// x = L^-1 x for a lower triangle, packed column by column. Cost: size^2 flops.
void solveColumns(int size, const double* lower, double* x);

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

/// Mean and covariance of exp(-x'Q x / 2 + b'x) within the box [-1, 1]^u, by expectation propagation. buffer:
/// u (u + 3).
void calcBoxMoments(int u, const double* precision, const double* shift, double* buffer, double* mean,
                    double* covariance);

/// How many numbers the buffers of a search for u unknowns take, with r scores, m variables.
int countSearch(int r, int u, int m, int windows);
/// A search with its buffers in a room of so many numbers; `problem` must outlive it. The caller fills
/// in search.scores (r) and the known variables of search.at (m - u).
score_search layOutSearch(const score_problem& problem, void* owner, double* room);
/// Minima from the training simulations of most similar scores that are apart from each other.
void searchFromSimulations(score_search& search);
/// Minima from `point` (u, moved into the box), and, if that explains too little, from the same simulations.
void searchFrom(score_search& search, const double* point);
/// The minimum with the errors' covariance around it, and the normal likelihood there. may_widen: enlarges
/// errors where they are too small to explain the scores. Cost: r^3 / 3 flops, once or twice, and some steps.
void refineMinimum(score_search& search, int index, bool may_widen);
/// Of the minima refined, the one of least objective.
int findLeast(const score_search& search);
/// Mean and covariance of the unknowns from the minima refined, and noise_stddev at the one of most evidence,
/// which is returned. within (u x u), shift (u): what the prior says beside the bounds.
int mixMinima(score_search& search, const double* within, const double* shift);

}  // namespace twinmap::exact
