#include "framework/estimation/surrogate/cross_validation.hpp"

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <cmath>

#include "framework/estimation/estimate.hpp"
#include "framework/estimation/folds.hpp"
#include "framework/estimation/interval_factor.hpp"
#include "framework/estimation/surrogate/predicted_limit.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Sum over the columns of the log densities of normal errors, over their standard deviations.
double calcLogDensity(const MatrixXd& standardised, const MatrixXd& correlation) {
  const MatrixXd lower = linalg::calcCholesky(correlation).lower;
  const auto n = static_cast<double>(standardised.cols()), p = static_cast<double>(standardised.rows());
  return -0.5 * (linalg::solveLower(lower, standardised).squaredNorm() +
                 n * p * std::log(boost::math::constants::two_pi<double>())) -
         n * lower.diagonal().array().log().sum();
}

/// With each sample's own correlation where the predictions have them.
double calcMeanLogDensity(const MatrixXd& standardised, const VectorXd& stddev_scale,
                          const Estimates& predictions, const MatrixXd& correlation) {
  double sum = -(stddev_scale.asDiagonal() * predictions.stddev).array().log().sum();
  for (Index i = 0; i < static_cast<Index>(predictions.correlations.size()); ++i) {
    sum += calcLogDensity(standardised.col(i), predictions.correlations[static_cast<std::size_t>(i)]);
  }
  if (predictions.correlations.empty()) {
    sum += calcLogDensity(standardised, correlation);
  }
  return sum / static_cast<double>(standardised.cols());
}

double calcMeanLogDensity(std::vector<Mixture> mixtures, const VectorXd& stddev_scale,
                          const MatrixXd& truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < mixtures.size(); ++i) {
    mixtures[i].stddevs = stddev_scale.asDiagonal() * mixtures[i].stddevs;
    sum += MixtureDensity(mixtures[i]).calcLog(truth.col(static_cast<Index>(i)));
  }
  return sum / static_cast<double>(truth.cols());
}

/// A surrogate for the box of `whole`, fitted to some samples.
Surrogate makeSimilar(const Surrogate& whole, ForwardSurrogate forward, const ForwardSamples& samples) {
  Surrogate surrogate;
  surrogate.forward = std::make_shared<const ForwardSurrogate>(std::move(forward));
  surrogate.center = whole.center;
  surrogate.half_width = whole.half_width;
  surrogate.parameters = whole.parameters;
  surrogate.unknown = whole.unknown;
  surrogate.prior = whole.prior;
  surrogate.validation.stddev_scale = VectorXd::Ones(whole.parameters);
  surrogate.validation.limit_scale =
      calcLimitScale(*surrogate.forward, samples, whole.prior).head(whole.parameters);
  return surrogate;
}

}  // namespace

Index countLeastSimulations(Index variables) {
  constexpr Index kLeast = 20;  // five folds of which are a cross-validation
  return kLeast + 2 * variables;
}

ForwardSamples selectSimulations(const ForwardSamples& samples, const std::vector<Index>& kept) {
  ForwardSamples selected{samples.infos, samples.points(Eigen::all, kept),
                          samples.clean_features(Eigen::all, kept), samples.noise_covariance};
  for (const Index i : kept) {
    if (!samples.slopes.empty()) {
      selected.slopes.push_back(samples.slopes[static_cast<std::size_t>(i)]);
    }
  }
  return selected;
}

Surrogate fitSimilar(const Surrogate& whole, const ForwardSamples& samples, const ForwardChoices& choices,
                     const TrainingControl& control) {
  return makeSimilar(whole, fitForward(samples, choices, control).surrogate, samples);
}

std::vector<std::vector<Index>> listFolds(Index simulations) {
  std::vector<std::vector<Index>> folds;
  for (Index fold = 0; fold < kFolds; ++fold) {
    folds.push_back(listKept(simulations, kFolds, fold));
  }
  return folds;
}

HeldOut crossValidate(const Surrogate& whole, const SurrogateSamples& samples, const ForwardSamples& forward,
                      std::vector<ForwardSurrogate> folds, const TrainingControl& control) {
  const Index n = samples.points.cols(), p = whole.parameters;
  const Index draws = countDraws(n, std::min<Index>(samples.measured.cols(), kManyErrors));
  const Index known = samples.points.rows() - whole.unknown;
  HeldOut held_out;
  held_out.predictions = {MatrixXd(p, n * draws), MatrixXd(p, n * draws), {}};
  held_out.limit_stddev.resize(p, n * draws);
  for (Index fold = 0; fold < kFolds; ++fold) {
    const Surrogate fitted = makeSimilar(whole, std::move(folds[static_cast<std::size_t>(fold)]),
                                         selectSimulations(forward, listKept(n, kFolds, fold)));
    const std::vector<Index> left_out = listLeftOut(n, kFolds, fold);
    const MatrixXd inputs = samples.points(Eigen::all, left_out).bottomRows(known);
    for (Index draw = 0; draw < draws; ++draw) {
      std::vector<Index> columns;
      for (const Index simulation : left_out) {
        columns.push_back(simulation + draw * n);
      }
      const Estimates found = fitted.invert(samples.measured(Eigen::all, columns), inputs, control.threads);
      held_out.predictions.mean(Eigen::all, columns) = found.mean;
      held_out.predictions.stddev(Eigen::all, columns) = found.stddev;
      held_out.limit_stddev(Eigen::all, columns) = found.limit_stddev;
      gp::throwIfStopped(control.stop);
    }
  }
  held_out.truth = samples.points.topRows(p).replicate(1, draws);
  return held_out;
}

SurrogateValidation validate(const HeldOut& held_out) {
  constexpr double kEstimatorLimited = 0.8;
  const Estimates& found = held_out.predictions;
  const MatrixXd z = (found.mean - held_out.truth).cwiseQuotient(found.stddev);
  const Index p = z.rows();
  SurrogateValidation validation;
  validation.stddev_scale.resize(p);
  validation.coverage95.resize(p);
  for (Index k = 0; k < p; ++k) {
    const VectorXd absolute = calcDepths(held_out.predictions, held_out.truth, k);
    validation.stddev_scale(k) = calcStddevScale(absolute);
    validation.coverage95(k) =
        static_cast<double>((absolute.array() < kNormal95).count()) / static_cast<double>(absolute.size());
  }
  validation.limit_ratio =
      validation.stddev_scale.array() *
      (found.stddev.rowwise().squaredNorm().array() / held_out.limit_stddev.rowwise().squaredNorm().array())
          .sqrt();
  const MatrixXd scaled = validation.stddev_scale.cwiseInverse().asDiagonal() * z;
  validation.residual_correlation = calcResidualCorrelation(scaled);
  validation.log_density =
      found.mixtures.empty()
          ? calcMeanLogDensity(scaled, validation.stddev_scale, found, validation.residual_correlation)
          : calcMeanLogDensity(found.mixtures, validation.stddev_scale, held_out.truth);
  validation.status = validation.coverage95.minCoeff() < kEstimatorLimited
                          ? SurrogateStatus::kEstimatorLimited
                          : SurrogateStatus::kOk;
  return validation;
}

}  // namespace twinmap
