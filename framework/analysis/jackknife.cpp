#include "framework/analysis/jackknife.hpp"

#include <cassert>

namespace twinmap {
namespace {

/// The mean over the draws of each sample.
Eigen::MatrixXd averageDraws(const Eigen::MatrixXd& terms, int draws) {
  assert(draws >= 1 && terms.cols() % draws == 0);
  const Eigen::Index samples = terms.cols() / draws;
  Eigen::MatrixXd mean = terms.leftCols(samples);
  for (int i = 1; i < draws; ++i) {
    mean += terms.middleCols(i * samples, samples);
  }
  return mean / draws;
}

}  // namespace

JackknifeFigures calcWithJackknife(const Eigen::MatrixXd& terms, const FigureFunction& figures, int draws) {
  const Eigen::MatrixXd samples = averageDraws(terms, draws);
  const auto n = static_cast<double>(samples.cols());
  const Eigen::VectorXd mean = samples.rowwise().mean();
  JackknifeFigures estimates;
  estimates.value = figures(mean, n * draws);
  Eigen::MatrixXd without(estimates.value.size(), samples.cols());
  for (Eigen::Index i = 0; i < samples.cols(); ++i) {
    without.col(i) = figures(mean + (mean - samples.col(i)) / (n - 1.0), (n - 1.0) * draws);
  }
  without.colwise() -= without.rowwise().mean().eval();
  estimates.standard_error = ((n - 1.0) / n * without.rowwise().squaredNorm()).cwiseSqrt();
  return estimates;
}

}  // namespace twinmap
