#include "framework/inference/posterior_estimate.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/text/number_text.hpp"
#include "framework/estimation/derived/value_distribution.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/estimation/posterior/noise/noise_candidates.hpp"
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

/// Of the first p parameters.
Estimate makeDetermined(const FloorDraws& floor, const std::vector<ParameterSpec>& unknown, Index p) {
  Estimate estimate;
  if (floor.isGiven()) {
    estimate.mean = estimate.stddev = VectorXd::Constant(p, std::numeric_limits<double>::quiet_NaN());
    estimate.method = EstimationMethod::kPosterior;
    estimate.draws = makeDraws(floor.points, floor.weights, unknown);
  }
  for (Index i = 0; i < estimate.mean.size(); ++i) {
    if (const VectorXd values = floor.points.row(i); floor.determine(values)) {
      const ValueDistribution known(values, floor.weights);
      estimate.mean[i] = known.getMean();
      estimate.stddev[i] = known.getStddev();
    }
  }
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
                           SimulatorFit& fit) {
  const VectorXd& residual = posterior.standardized.residual;
  TestedResidual tested{residual, infos, posterior.standardized.degrees};
  const bool has_weights = posterior.residual_weights.size() == residual.size();
  if (!residual.hasNaN() && !(has_weights && posterior.residual_weights.minCoeff() < kOutlierWeight)) {
    return tested;
  }
  std::vector<Index> inliers;
  tested.infos.clear();
  for (Index i = 0; i < residual.size(); ++i) {
    const FeatureInfo& info = infos[static_cast<std::size_t>(i)];
    if (std::isnan(residual[i])) {
      continue;  // beyond what its sensor shows, as it should be
    }
    if (has_weights && posterior.residual_weights[i] < kOutlierWeight) {
      fit.outliers.push_back(
          fmt::format("{} ({} sd)", info.name, toShortText(std::abs(residual[i]), kStddevDigits)));
      fit.outlier_features.push_back(i);
      tested.degrees -= 1.0;
    } else {
      inliers.push_back(i);
      tested.infos.push_back(info);
    }
  }
  tested.residual = residual(inliers);
  tested.degrees = std::max(tested.degrees, 1.0);
  return tested;
}

SimulatorFit makeFit(const SimulatorPosterior& posterior, const std::vector<ParameterSpec>& unknown,
                     const std::vector<FeatureInfo>& infos) {
  SimulatorFit fit;
  fit.searches = posterior.starts;
  fit.found_best = posterior.found_best;
  fit.simulations = posterior.simulations;
  fit.best = posterior.best;
  fit.chi_square = posterior.chi_square;
  fit.degrees = posterior.degrees;
  fit.explained = posterior.isExplained();
  for (const Index i : posterior.beyond) {
    fit.beyond.push_back(unknown[static_cast<std::size_t>(i)].name.text);
  }
  if (posterior.standardized.residual.size() > 0) {
    const TestedResidual tested = takeInliers(posterior, infos, fit);
    fit.residual = tested.residual;
    fit.chi_square = tested.residual.squaredNorm();
    fit.degrees = tested.degrees;
    fit.explained = fit.chi_square < calcChiSquareLimit(fit.degrees);
    fit.test = testResidual(tested.residual, tested.degrees, tested.infos);
    if (fit.test.largest >= 0) {
      fit.largest_feature = tested.infos[static_cast<std::size_t>(fit.test.largest)].name;
    }
    for (const FoundNoise& found : posterior.standardized.noise) {
      fit.noise.push_back({{}, {}, 0.0, 0.0, found});
    }
  }
  return fit;
}

}  // namespace

bool NoiseReport::differs() const {
  return isStated() && found.size_was_inferred && std::abs(calcSizeDeviation(found)) > kRareDeviations;
}

bool SimulatorFit::isAsStated() const {
  return outliers.empty() && noise.empty();
}

bool SimulatorFit::isGross() const {
  return twinmap::isGross(chi_square, degrees);
}

double SimulatorFit::getNoiseFactor() const {
  double factor = 1.0, largest = 0.0;
  for (const NoiseReport& report : noise) {
    if (const double deviation = std::abs(calcSizeDeviation(report.found));
        report.differs() && deviation > largest) {
      largest = deviation;
      factor = report.found.factor;
    }
  }
  return factor;
}

bool SimulatorFit::isColoured() const {
  return std::any_of(noise.begin(), noise.end(),
                     [](const NoiseReport& report) { return report.found.autoregression.size() > 0; });
}

bool SimulatorFit::hasOffset() const {
  return std::any_of(noise.begin(), noise.end(),
                     [](const NoiseReport& report) { return report.found.has_offset; });
}

const char* PosteriorEstimate::getStatus() const {
  return !isReliable() ? "unreliable" : doubt.empty() ? "ok" : "posterior_uncalibrated";
}

const char* toString(PosteriorSource source) {
  return source == PosteriorSource::kSimulator ? "simulator" : "surrogate";
}

PosteriorEstimate makePosteriorEstimate(const SurrogatePosterior& posterior,
                                        const std::vector<ParameterSpec>& unknown, const std::string& doubt) {
  PosteriorEstimate made;
  made.doubt = doubt;
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
  made.fit = makeFit(posterior, unknown, infos);
  made.places = posterior.places;
  made.floor = posterior.floor;
  made.determined = makeDetermined(made.floor, unknown, p);
  made.nuisance.assign(unknown.begin() + p, unknown.end());
  if (made.isReliable()) {
    made.estimate = makeEstimate(makeDraws(posterior.draws, posterior.weights, unknown),
                                 posterior.mean.head(p), posterior.covariance.topLeftCorner(p, p));
    made.estimate.mixture = makeMixture(posterior.modes, p);
    made.estimate.prior_stddev = posterior.prior_stddev.head(p);
    made.shape = posterior.findShape(p);
    made.profiles = posterior.profiles;
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
