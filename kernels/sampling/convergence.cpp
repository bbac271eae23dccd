#include "kernels/sampling/convergence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace twinmap::markov {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Halves of chains as columns; of an odd number the middle draw is left out.
MatrixXd splitChains(const std::vector<VectorXd>& chains) {
  const Index half = chains.front().size() / 2;
  MatrixXd halves(half, 2 * static_cast<Index>(chains.size()));
  for (std::size_t i = 0; i < chains.size(); ++i) {
    halves.col(2 * static_cast<Index>(i)) = chains[i].head(half);
    halves.col(2 * static_cast<Index>(i) + 1) = chains[i].tail(half);
  }
  return halves;
}

/// The mean over the chains of their autocovariances at a lag, with 1/n.
double calcAutocovariance(const MatrixXd& centered, Index lag) {
  const Index n = centered.rows();
  return centered.topRows(n - lag).cwiseProduct(centered.bottomRows(n - lag)).sum() /
         static_cast<double>(n * centered.cols());
}

}  // namespace

Convergence calcConvergence(const std::vector<VectorXd>& chains) {
  const MatrixXd halves = splitChains(chains);
  const auto n = static_cast<double>(halves.rows()), m = static_cast<double>(halves.cols());
  const Eigen::RowVectorXd means = halves.colwise().mean();
  const MatrixXd centered = halves.rowwise() - means;
  const double within = centered.squaredNorm() / (m * (n - 1.0));
  const double between = (means.array() - means.mean()).square().sum() / (m - 1.0);
  const double pooled = within * (n - 1.0) / n + between;
  const auto calcCorrelation = [&](Index lag) {
    return 1.0 - (within - calcAutocovariance(centered, lag) * n / (n - 1.0)) / pooled;
  };
  // sums of neighbouring autocorrelations are positive and decrease; beyond where they do not is noise
  double time = -1.0, before = std::numeric_limits<double>::infinity();
  for (Index lag = 0; lag + 1 < halves.rows(); lag += 2) {
    const double pair = (lag == 0 ? 1.0 : calcCorrelation(lag)) + calcCorrelation(lag + 1);
    if (pair <= 0.0) {
      break;
    }
    before = std::min(before, pair);
    time += 2.0 * before;
  }
  const double most = m * n * std::log10(m * n);  // of chains that swing to and fro
  return {std::sqrt(pooled / within), std::min(m * n / std::max(time, 1e-10), most)};
}

}  // namespace twinmap::markov
