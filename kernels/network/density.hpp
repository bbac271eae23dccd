#pragma once

#include "kernels/network/network.hpp"

namespace twinmap::network {

/// Where the residuals of a sample are clamped: beyond so many standard deviations the loss grows linearly,
/// as Huber's, so that no single sample carries a step away.
constexpr double kLargestResidual = 6.0;

/// What a head (2 p + p (p - 1) / 2 rows: means m, logarithms o, then the rows of the strictly lower triangle
/// of A) says of targets t (p) is the normal distribution of
///   r = (1 + A)' D (t - m),   D = diag(exp o),
/// standard normal: L = D (1 + A) is the Cholesky factor of the precision L L'. Its rows are in units of
/// their own diagonal, so that A stays of order 1 however precise a target becomes.
///
/// The row of A_ji, j > i.
inline Index getTriangleRow(Index targets, Index j, Index i) {
  return 2 * targets + j * (j - 1) / 2 + i;
}

/// A head of several components c has as many rows first, of logarithms w of their weights but for a common
/// summand, then the rows of each component: t has the density sum_c softmax(w)_c exp(-loss_c(t)).
///
/// The sum over the columns (n) of the negative logarithmic densities of t (p x n),
///   sum_i rho(r_i) - o_i + log(2 pi) / 2,   rho(r) = r^2 / 2, beyond kLargestResidual its tangent,
/// of one component, -log sum_c softmax(w)_c exp(-loss_c) of several,
/// and the derivatives with respect to the head's outputs (its rows x n). Cost: p^2 n flops a component.
double calcLoss(const Ref<const MatrixXd>& head, const Ref<const MatrixXd>& targets, Ref<MatrixXd> gradient);

/// The loss alone.
double calcLoss(const Ref<const MatrixXd>& head, const Ref<const MatrixXd>& targets);

/// Mean (p) and covariance (p x p) of t for the rows of one component. Cost: p^3 / 3 flops; no allocation
/// where `inverse` (p x p, a buffer) and the results have their sizes.
void calcMoments(const Ref<const VectorXd>& head, Ref<VectorXd> mean, Ref<MatrixXd> covariance,
                 Ref<MatrixXd> inverse);

/// The precision D (1 + A) (1 + A)' D (p x p) of t for the rows of one component.
MatrixXd calcPrecision(const Ref<const VectorXd>& head, Index targets);

/// Weights of the components, positive with the sum 1, from their logarithms but for a common summand.
void calcWeights(const Ref<const VectorXd>& logarithms, Ref<VectorXd> weights);

/// The first p rows of derivatives with respect to a head, summed over its components: what a shift of all
/// means does. p x n.
MatrixXd sumMeanRows(const Ref<const MatrixXd>& gradient, Index targets);

}  // namespace twinmap::network
