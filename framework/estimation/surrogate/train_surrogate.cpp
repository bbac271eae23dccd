#include "framework/estimation/surrogate/train_surrogate.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "framework/base/log/notice.hpp"
#include "framework/base/text/nearest_name.hpp"
#include "framework/estimation/surrogate/cross_validation.hpp"
#include "framework/estimation/surrogate/fit_forward.hpp"
#include "framework/estimation/surrogate/predicted_limit.hpp"
#include "framework/experiment/inverse_map_spec.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// No more than an exact process is worth: the time grows with their number cubed.
SurrogateSamples takeFirst(const SurrogateSamples& samples) {
  const Index n = samples.points.cols(), most = NetworkMapSpec::kMaxOfSurrogate;
  if (n <= most) {
    return samples;
  }
  SurrogateSamples first{samples.infos,
                         samples.points.leftCols(most),
                         samples.clean_features.leftCols(most),
                         samples.noise_covariance,
                         MatrixXd(samples.measured.rows(), 0),
                         samples.slopes};
  if (!first.slopes.empty()) {
    first.slopes.resize(most);
  }
  const Index draws = samples.measured.cols() / n;
  first.measured.resize(samples.measured.rows(), most * draws);
  for (Index draw = 0; draw < draws; ++draw) {
    first.measured.middleCols(draw * most, most) = samples.measured.middleCols(draw * n, most);
  }
  return first;
}

std::vector<std::string> listWarnings(const ModelSpec& model, const SurrogateValidation& validation) {
  constexpr double kCalibrated = 0.9;
  std::vector<std::string> warnings, told;
  for (Index k = 0; k < validation.coverage95.size(); ++k) {
    if (validation.coverage95(k) < kCalibrated) {
      told.push_back(fmt::format("{} ({:.0f} % contained, sd enlarged by {:.2f})",
                                 model.parameters[static_cast<std::size_t>(k)].name.text,
                                 100.0 * validation.coverage95(k), validation.stddev_scale(k)));
    }
  }
  if (!told.empty()) {
    warnings.push_back(describeNotice(Notice::kSurrogateRescaled, listNames(told)));
  }
  if (validation.status == SurrogateStatus::kEstimatorLimited) {
    warnings.push_back(describeNotice(Notice::kSurrogateUncalibrated));
  }
  return warnings;
}

}  // namespace

std::string findSurrogateObstacle(const ModelSpec& model, Index simulations,
                                  const NoiseCovariance& noise_covariance) {
  if (simulations < countLeastSimulations(static_cast<Index>(collectSampled(model).size()))) {
    return "a surrogate needs at least 20 training samples, and two a parameter more";
  }
  return noise_covariance.diagonal().minCoeff() > 0.0 ? "" : "the noise of a feature is 0";
}

SurrogateTraining trainSurrogate(const ModelSpec& model, const SurrogateSamples& given,
                                 const TrainingControl& control) {
  const SurrogateSamples samples = takeFirst(given);
  const std::string obstacle = findSurrogateObstacle(model, samples.points.cols(), samples.noise_covariance);
  if (!obstacle.empty()) {
    throw std::invalid_argument(obstacle);
  }
  const std::vector<ParameterSpec> sampled = collectSampled(model);
  SurrogateTraining training;
  Surrogate& surrogate = training.surrogate;
  surrogate.center = calcBoxCenter(sampled);
  surrogate.half_width = 0.5 * calcWidths(sampled);
  surrogate.parameters = static_cast<Index>(model.parameters.size());
  surrogate.unknown = surrogate.parameters + static_cast<Index>(model.nuisance.size());
  surrogate.prior = makeBoxPrior(model);
  const MatrixXd normalized =
      surrogate.half_width.cwiseInverse().asDiagonal() * (samples.points.colwise() - surrogate.center);
  ForwardSamples forward{samples.infos, normalized, samples.clean_features, samples.noise_covariance};
  for (const MatrixXd& per_width : samples.slopes) {
    forward.slopes.push_back(0.5 * per_width);  // per half width
  }
  ForwardFit fit = fitForward(forward, {}, control, listFolds(forward.points.cols()));
  surrogate.forward = std::make_shared<const ForwardSurrogate>(std::move(fit.surrogate));
  HeldOut held_out = crossValidate(surrogate, samples, forward, std::move(fit.folds), control);
  surrogate.validation = validate(held_out);
  surrogate.validation.limit_scale =
      calcLimitScale(*surrogate.forward, forward, surrogate.prior).head(surrogate.parameters);
  training.gain = calcSimulationGain(surrogate, samples, forward, fit.choices, held_out, control);
  training.held_out = std::move(held_out.predictions);
  training.held_out_truth = std::move(held_out.truth);
  training.held_out_draws = static_cast<int>(training.held_out.mean.cols() / samples.points.cols());
  training.held_out.stddev = surrogate.validation.stddev_scale.asDiagonal() * training.held_out.stddev;
  for (Index i = 0; i < training.held_out.mean.cols(); ++i) {
    surrogate.shrinkToPrior(training.held_out.mean.col(i), training.held_out.stddev.col(i));
  }
  training.warnings = listWarnings(model, surrogate.validation);
  return training;
}

using Eigen::VectorXd;

namespace {

VectorXd calcMeanErrors(const MatrixXd& mean, const MatrixXd& truth) {
  return (mean - truth).cwiseAbs().rowwise().mean();
}

}  // namespace

SimulationGain calcSimulationGain(const Surrogate& whole, const SurrogateSamples& samples,
                                  const ForwardSamples& forward, const ForwardChoices& choices,
                                  const HeldOut& held_out, const TrainingControl& control) {
  const Index n = samples.points.cols(), half = n / 2, known = samples.points.rows() - whole.unknown;
  if (half < countLeastSimulations(samples.points.rows())) {
    return {};
  }
  const Surrogate fitted = fitSimilar(whole, selectSimulations(forward, listIndices(half)), choices, control);
  const std::vector<Index> others = listIndices(n - half, half);
  const MatrixXd inputs = samples.points(Eigen::all, others).bottomRows(known);
  const Estimates found = fitted.invert(samples.measured(Eigen::all, others), inputs, control.threads);
  gp::throwIfStopped(control.stop);
  const MatrixXd truth = held_out.truth(Eigen::all, others);
  const VectorXd of_half = calcMeanErrors(found.mean, truth);
  const VectorXd of_folds = calcMeanErrors(held_out.predictions.mean(Eigen::all, others), truth);
  const double doublings =
      std::log2((1.0 - 1.0 / kFolds) * static_cast<double>(n) / static_cast<double>(half));
  return {half, n, of_folds.cwiseQuotient(of_half).array().pow(1.0 / doublings)};
}

}  // namespace twinmap
