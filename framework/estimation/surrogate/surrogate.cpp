#include "framework/estimation/surrogate/surrogate.hpp"

#include <stdexcept>

#include "framework/estimation/run_tasks.hpp"
#include "framework/estimation/surrogate/score_inversion.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const char* toString(SurrogateStatus status) {
  return status == SurrogateStatus::kOk ? "ok" : "estimator_limited";
}

std::vector<Index> SurrogateValidation::listEnlarged() const {
  constexpr double kTolerated = 1.2;
  std::vector<Index> found;
  for (Index k = 0; k < stddev_scale.size(); ++k) {
    if (stddev_scale[k] > kTolerated) {
      found.push_back(k);
    }
  }
  return found;
}

void Surrogate::convertMoments(const gp::Moments& normalised, VectorXd& mean, VectorXd& stddev) const {
  const auto widths = half_width.head(parameters).array();
  mean = center.head(parameters).array() + widths * normalised.mean.head(parameters).array();
  stddev = validation.stddev_scale.array() * widths *
           normalised.covariance.diagonal().head(parameters).array().sqrt();
}

void Surrogate::shrinkToPrior(Eigen::Ref<VectorXd> mean, Eigen::Ref<VectorXd> stddev) const {
  const VectorXd before = prior.stddev.head(parameters).cwiseProduct(half_width.head(parameters));
  shrinkToBounds(calcPriorCenter(), before, mean, stddev);
}

VectorXd Surrogate::calcPriorCenter() const {
  const auto within = prior.mean.head(parameters).cwiseMax(-1.0).cwiseMin(1.0);
  return center.head(parameters) + half_width.head(parameters).cwiseProduct(within);
}

VectorXd Surrogate::calcLimit(const VectorXd& noise_stddev) const {
  return validation.limit_scale.array() * half_width.head(parameters).array() *
         noise_stddev.head(parameters).array();
}

Estimates Surrogate::invert(const MatrixXd& features, const MatrixXd& inputs, int threads) const {
  const Index n = features.cols(), known = center.size() - unknown;
  if (features.rows() != forward->center.size() || inputs.rows() != known ||
      (known > 0 && inputs.cols() != n)) {
    throw std::invalid_argument("a surrogate needs all features, and all known inputs");
  }
  const MatrixXd scores = forward->calcScores(features);
  Estimates estimates{MatrixXd(parameters, n), MatrixXd(parameters, n)};
  estimates.limit_stddev.resize(parameters, n);
  runChunks(threads, n, [&](Index first, Index end) {
    ScoreInversion inversion(*forward, prior);
    VectorXd mean, stddev;
    for (Index i = first; i < end; ++i) {
      const VectorXd at =
          known > 0 ? VectorXd((inputs.col(i) - center.tail(known)).cwiseQuotient(half_width.tail(known)))
                    : VectorXd();
      convertMoments(inversion.infer(scores.col(i), at), mean, stddev);
      estimates.mean.col(i) = mean;
      estimates.stddev.col(i) = stddev;
      estimates.limit_stddev.col(i) = calcLimit(inversion.getNoiseStddev());
    }
  });
  return estimates;
}

Estimates Surrogate::predict(const MatrixXd& features, const MatrixXd& inputs, int threads) const {
  Estimates estimates = invert(features, inputs, threads);
  for (Index i = 0; i < estimates.mean.cols(); ++i) {
    shrinkToPrior(estimates.mean.col(i), estimates.stddev.col(i));
  }
  return estimates;
}

}  // namespace twinmap
