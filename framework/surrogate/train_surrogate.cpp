#include "framework/surrogate/train_surrogate.hpp"

#include <stdexcept>

#include "framework/spec/parameter_box.hpp"
#include "framework/surrogate/cross_validation.hpp"
#include "framework/surrogate/fit_forward.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

std::string formatShare(double share) {
  const std::string text = std::to_string(share);
  return text.substr(0, text.find('.') + 3);
}

/// No more than an exact process is worth: the time grows with their number cubed.
SurrogateSamples takeFirst(const SurrogateSamples& samples) {
  constexpr Index kMost = 2000;
  const Index n = samples.points.cols();
  if (n <= kMost) {
    return samples;
  }
  SurrogateSamples first{samples.infos,
                         samples.points.leftCols(kMost),
                         samples.clean_features.leftCols(kMost),
                         samples.noise_covariance,
                         MatrixXd(samples.measured.rows(), 0),
                         samples.slopes};
  if (!first.slopes.empty()) {
    first.slopes.resize(kMost);
  }
  const Index draws = samples.measured.cols() / n;
  first.measured.resize(samples.measured.rows(), kMost * draws);
  for (Index draw = 0; draw < draws; ++draw) {
    first.measured.middleCols(draw * kMost, kMost) = samples.measured.middleCols(draw * n, kMost);
  }
  return first;
}

std::vector<std::string> listWarnings(const ModelSpec& model, const SurrogateValidation& validation) {
  constexpr double kHonest = 0.9;
  std::vector<std::string> warnings;
  for (Index k = 0; k < validation.coverage95.size(); ++k) {
    if (validation.coverage95(k) < kHonest) {
      warnings.push_back("parameter '" + model.parameters[static_cast<std::size_t>(k)].name.text +
                         "': only " + formatShare(validation.coverage95(k)) +
                         " of the surrogate's own 95 % intervals held in cross-validation; its standard "
                         "deviations are multiplied by " +
                         formatShare(validation.stddev_scale(k)));
    }
  }
  if (validation.status == SurrogateStatus::kMapLimited) {
    warnings.emplace_back(
        "map_limited: the surrogate does not know its own error; more training samples would help");
  }
  return warnings;
}

}  // namespace

SurrogateTraining trainSurrogate(const ModelSpec& model, const SurrogateSamples& given,
                                 const TrainingControl& control) {
  const SurrogateSamples samples = takeFirst(given);
  constexpr Index kFewest = 20;  // five folds of which are a cross-validation
  if (samples.points.cols() < kFewest + 2 * samples.points.rows()) {
    throw std::invalid_argument("a surrogate needs at least 20 training samples, and two a parameter more");
  }
  const std::vector<ParameterSpec> sampled = collectSampled(model);
  SurrogateTraining training;
  Surrogate& surrogate = training.surrogate;
  surrogate.center = calcBoxCenter(sampled);
  surrogate.half_width = 0.5 * calcWidths(sampled);
  surrogate.parameters = static_cast<Index>(model.parameters.size());
  surrogate.unknown = surrogate.parameters + static_cast<Index>(model.nuisance.size());
  const MatrixXd normalized =
      surrogate.half_width.cwiseInverse().asDiagonal() * (samples.points.colwise() - surrogate.center);
  ForwardSamples forward{samples.infos, normalized, samples.clean_features, samples.noise_covariance};
  for (const MatrixXd& per_width : samples.slopes) {
    forward.slopes.push_back(0.5 * per_width);  // per half width
  }
  ForwardFit fit = fitForward(forward, {}, control);
  surrogate.forward = std::move(fit.surrogate);
  HeldOut held_out = crossValidate(surrogate, samples, forward, fit.choices, control);
  surrogate.validation = validate(held_out);
  training.held_out = std::move(held_out.predictions);
  training.held_out_truth = std::move(held_out.truth);
  training.held_out_draws = static_cast<int>(training.held_out.mean.cols() / samples.points.cols());
  training.held_out.stddev = surrogate.validation.stddev_scale.asDiagonal() * training.held_out.stddev;
  training.warnings = listWarnings(model, surrogate.validation);
  return training;
}

}  // namespace twinmap
