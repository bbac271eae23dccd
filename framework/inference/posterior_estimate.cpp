#include "framework/inference/posterior_estimate.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/estimation/refined/acceptance.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

BoundedDraws makeDraws(const MatrixXd& points, const VectorXd& weights,
                       const std::vector<ParameterSpec>& unknown) {
  const auto u = static_cast<Index>(unknown.size());
  BoundedDraws draws{points, weights, VectorXd(u), VectorXd(u)};
  for (Index i = 0; i < u; ++i) {
    const Bounds& bounds = unknown[static_cast<std::size_t>(i)].bounds;
    draws.lower[i] = bounds.lower;
    draws.upper[i] = bounds.upper;
  }
  return draws;
}

/// The modes as a mixture of normal distributions; none where there is one.
Mixture makeMixture(const std::vector<PosteriorMode>& modes, Index p) {
  if (modes.size() < 2) {
    return {};
  }
  const auto count = static_cast<Index>(modes.size());
  Mixture mixture{VectorXd(count), MatrixXd(p, count), MatrixXd(p, count), {}};
  for (Index k = 0; k < count; ++k) {
    const PosteriorMode& mode = modes[static_cast<std::size_t>(k)];
    mixture.weights[k] = mode.weight;
    mixture.means.col(k) = mode.mean.head(p);
    mixture.stddevs.col(k) = mode.stddev.head(p);
    mixture.correlations.push_back(calcCorrelation(mode.covariance.topLeftCorner(p, p)));
  }
  mixture.weights /= mixture.weights.sum();
  return mixture;
}

/// Mean and covariance are those of the draws.
Estimate makeEstimate(BoundedDraws draws, const VectorXd& mean, const MatrixXd& covariance) {
  Estimate estimate{mean, covariance.diagonal().cwiseSqrt()};
  estimate.correlation = calcCorrelation(covariance);
  estimate.method = EstimationMethod::kPosterior;
  estimate.draws = std::move(draws);
  return estimate;
}

/// Below this weight a residual is an outlier: noise of 3 standard deviations has more than .99.
constexpr double kOutlierWeight = 0.5;

/// Residuals as they are tested.
struct TestedResidual {
  VectorXd residual;
  std::vector<FeatureInfo> infos;
  double degrees;
};

/// Without the outliers, which are named.
TestedResidual takeInliers(const SimulatorPosterior& posterior, const std::vector<FeatureInfo>& infos,
                           std::vector<std::string>& outliers) {
  TestedResidual tested{{}, {}, posterior.degrees};
  std::vector<Index> inliers;
  for (Index i = 0; i < posterior.residual.size(); ++i) {
    const FeatureInfo& info = infos[static_cast<std::size_t>(i)];
    if (posterior.residual_weights[i] < kOutlierWeight) {
      outliers.push_back(fmt::format("{} ({:.3g} sd)", info.name, std::abs(posterior.residual[i])));
      tested.degrees -= 1.0;
    } else {
      inliers.push_back(i);
      tested.infos.push_back(info);
    }
  }
  tested.residual = posterior.residual(inliers);
  tested.degrees = std::max(tested.degrees, 1.0);
  return tested;
}

/// As many standard deviations of the noise that was found, with as many degrees of freedom as it has.
TestedResidual scaleToNoise(const SimulatorPosterior& posterior, const std::vector<FeatureInfo>& infos,
                            double& noise_factor) {
  noise_factor = std::sqrt(posterior.residual.squaredNorm() / posterior.degrees);
  return {posterior.residual / noise_factor, infos, posterior.degrees};
}

SimulatorFit makeFit(const SimulatorPosterior& posterior, const std::vector<FeatureInfo>& infos) {
  SimulatorFit fit;
  fit.searches = posterior.starts;
  fit.found_best = posterior.found_best;
  fit.simulations = posterior.simulations;
  if (posterior.degrees > 0.0) {
    fit.chi_square = posterior.chi_square;
    fit.degrees = posterior.degrees;
    fit.explained = posterior.isExplained();
    fit.residual = posterior.residual;
    const TestedResidual tested = posterior.loss == LossKind::kOutliers
                                      ? takeInliers(posterior, infos, fit.outliers)
                                  : posterior.loss == LossKind::kUnknownNoise
                                      ? scaleToNoise(posterior, infos, fit.noise_factor)
                                      : TestedResidual{posterior.residual, infos, posterior.degrees};
    if (posterior.loss != LossKind::kPlain) {
      fit.residual = tested.residual;
      fit.chi_square = tested.residual.squaredNorm();
      fit.degrees = tested.degrees;
      fit.explained = fit.chi_square < calcChiSquareLimit(fit.degrees);
    }
    fit.test = testResidual(tested.residual, tested.degrees, tested.infos);
  }
  return fit;
}

}  // namespace

const char* toString(PosteriorSource source) {
  return source == PosteriorSource::kSimulator ? "simulator" : "surrogate";
}

PosteriorEstimate makePosteriorEstimate(const SurrogatePosterior& posterior,
                                        const std::vector<ParameterSpec>& unknown) {
  PosteriorEstimate made;
  made.effective_sample_size = posterior.effective_sample_size;
  made.pareto_shape = posterior.pareto_shape;
  made.evaluations = posterior.evaluations;
  made.message = posterior.message;
  if (made.isReliable()) {
    made.estimate = makeEstimate(makeDraws(posterior.weighted.points, posterior.weighted.weights, unknown),
                                 posterior.mean, posterior.covariance);
  }
  return made;
}

PosteriorEstimate makePosteriorEstimate(const SimulatorPosterior& posterior,
                                        const std::vector<ParameterSpec>& unknown, Index p,
                                        const std::vector<FeatureInfo>& infos) {
  PosteriorEstimate made;
  made.source = PosteriorSource::kSimulator;
  made.effective_sample_size = posterior.effective_sample_size;
  made.pareto_shape = posterior.pareto_shape;
  made.evaluations = static_cast<int>(posterior.weights.size());
  made.message = posterior.message;
  made.fit = makeFit(posterior, infos);
  if (made.isReliable()) {
    made.estimate = makeEstimate(makeDraws(posterior.draws, posterior.weights, unknown),
                                 posterior.mean.head(p), posterior.covariance.topLeftCorner(p, p));
    made.estimate.mixture = makeMixture(posterior.modes, p);
    made.estimate.prior_stddev = posterior.prior_stddev.head(p);
    made.shape = posterior.findShape(p);
  }
  return made;
}

MatrixXd calcQuantiles(const Estimate& estimate) {
  const VectorXd probabilities =  // not a Map: GCC 12 sees AVX-512 read beyond the five
      VectorXd::NullaryExpr(static_cast<Index>(kQuantileProbabilities.size()),
                            [](Index i) { return kQuantileProbabilities[static_cast<std::size_t>(i)]; });
  MatrixXd quantiles(estimate.mean.size(), probabilities.size());
  for (Index i = 0; i < quantiles.rows(); ++i) {
    quantiles.row(i) = estimate.draws.calcQuantiles(i, probabilities).transpose();
  }
  return quantiles;
}

void addStatus(PosteriorShape shape, std::vector<std::string>& statuses) {
  if (shape == PosteriorShape::kMultimodal) {
    statuses.emplace_back("multimodal");
  } else if (shape == PosteriorShape::kUninformative) {
    statuses.emplace_back("uninformative");
  }
}

}  // namespace twinmap
