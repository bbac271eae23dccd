#include "framework/surrogate/score_likelihood.hpp"

#include <limits>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

ScoreLikelihood::ScoreLikelihood(const ForwardSurrogate& surrogate)
    : surrogate_(surrogate),
      workspaces_(surrogate.windows.size()),
      widening_(surrogate.windows.size(), 1.0),
      point_(VectorXd::Zero(surrogate.points.rows())),
      values_(surrogate.getScoreCount()),
      stddev_(surrogate.getScoreCount()) {}

void ScoreLikelihood::setMeasurement(const Eigen::Ref<const VectorXd>& scores,
                                     const Eigen::Ref<const VectorXd>& known, std::vector<double> widening) {
  scores_ = scores;
  point_.tail(known.size()) = known;
  widening_ = std::move(widening);
}

double ScoreLikelihood::calcLog(const Eigen::Ref<const VectorXd>& unknown) {
  if (!(unknown.cwiseAbs().maxCoeff() <= 1.0)) {
    return -std::numeric_limits<double>::infinity();
  }
  point_.head(unknown.size()) = unknown;
  Index first = 0;
  for (std::size_t w = 0; w < workspaces_.size(); ++w) {
    const gp::SharedProcess& process = surrogate_.windows[w];
    const Index count = process.getFunctionCount();
    process.evaluate(point_, values_.segment(first, count), workspaces_[w]);
    process.calcStddev(stddev_.segment(first, count), workspaces_[w]);
    stddev_.segment(first, count) *= widening_[w];
    first += count;
  }
  const Eigen::MatrixXd lower = linalg::calcCholesky(surrogate_.calcScoreCovariance(stddev_)).lower;
  return -0.5 * linalg::solveLower(lower, scores_ - values_).squaredNorm() -
         lower.diagonal().array().log().sum();
}

}  // namespace twinmap
