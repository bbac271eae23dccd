#include "framework/analysis/jackknife.hpp"

#include <cassert>
#include <vector>

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

std::vector<Eigen::Index> findWeighted(const Eigen::VectorXd& weights) {
  std::vector<Eigen::Index> weighted;
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    if (weights[i] > 0.0) {
      weighted.push_back(i);
    }
  }
  return weighted;
}

}  // namespace

JackknifeFigures calcWithJackknife(const Eigen::MatrixXd& terms, const FigureFunction& figures, int draws,
                                   const Eigen::VectorXd& given) {
  Eigen::MatrixXd samples = averageDraws(terms, draws);
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(samples.cols());
  if (given.size() > 0) {
    const std::vector<Eigen::Index> weighted = findWeighted(given);
    samples = samples(Eigen::all, weighted).eval();
    weights = given(weighted);
  }
  const auto n = static_cast<double>(samples.cols());
  const double total = weights.sum();
  const Eigen::VectorXd mean = given.size() > 0 ? Eigen::VectorXd(samples * weights / total)
                                                : Eigen::VectorXd(samples.rowwise().mean());
  JackknifeFigures estimates;
  estimates.value = figures(mean, n * draws);
  Eigen::MatrixXd without(estimates.value.size(), samples.cols());
  for (Eigen::Index i = 0; i < samples.cols(); ++i) {
    without.col(i) =
        figures(mean + weights[i] * (mean - samples.col(i)) / (total - weights[i]), (n - 1.0) * draws);
  }
  without.colwise() -= without.rowwise().mean().eval();
  estimates.standard_error = ((n - 1.0) / n * without.rowwise().squaredNorm()).cwiseSqrt();
  return estimates;
}

}  // namespace twinmap
