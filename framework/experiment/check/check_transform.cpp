#include "framework/experiment/check/check_experiment.hpp"

namespace twinmap {
namespace {

/// What the steps so far made of the features.
struct Progress {
  bool mixed = false;     ///< inputs combine features, and their noise is correlated
  bool whitened = false;  ///< the last step gave them unit noise
};

void requireNoise(const ExperimentSpec& experiment, const SourceLocation& where, const std::string& step) {
  for (const Name& output : collectOutputs(experiment.features)) {
    for (const OutputNoiseSpec& noise : experiment.noise.stddev) {
      if (noise.name.text == output.text && !(experiment.noise.scale * noise.stddev > 0.0)) {
        throw ExperimentError(where, step, "needs noise above 0 on output '" + output.text + "'");
      }
    }
  }
}

void requireModesNoise(const ExperimentSpec& experiment, const SourceLocation& where,
                       const std::string& step) {
  const NoiseSpec& noise = experiment.noise;
  for (const FeatureSpec& feature : experiment.features) {
    const auto* modes = std::get_if<ModesFeatureSpec>(&feature);
    if (modes != nullptr && modes->frequencies && !(noise.scale * noise.modes->frequency > 0.0)) {
      throw ExperimentError(where, step, "needs noise above 0 in noise.modes.frequency");
    }
    if (modes != nullptr && modes->damping_ratios && !(noise.scale * noise.modes->damping_ratio > 0.0)) {
      throw ExperimentError(where, step, "needs noise above 0 in noise.modes.damping_ratio");
    }
  }
}

/// What a step is checked against.
struct Context {
  const ExperimentSpec& experiment;
  const Progress& progress;
  const SourceLocation& where;
};

void checkStep(const ZScoreSpec&, const Context&) {}

void checkStep(const WhitenSpec& whiten, const Context& context) {
  requireNoise(context.experiment, context.where, "whiten");
  requireModesNoise(context.experiment, context.where, "whiten");
  if (context.progress.mixed && whiten.by == WhitenBy::kStddev) {
    throw ExperimentError(context.where, "whiten",
                          "must be 'whiten: {by: covariance}' behind a step that mixes features, which "
                          "correlates their noise; or come before it");
  }
}

void checkStep(const PrincipalComponentsSpec& spec, const Context& context) {
  const bool automatic = !spec.components.number && !spec.explained_variance;
  if (automatic && !context.progress.whitened) {
    throw ExperimentError(
        context.where, "principal_components",
        "needs components or explained_variance, unless it directly follows whiten (by covariance, "
        "where the noise is correlated)");
  }
}

void checkStep(const PartialLeastSquaresSpec&, const Context&) {}

void checkStep(const SelectSpec& select, const Context& context) {
  const auto* names = std::get_if<FeatureNames>(&select);
  if (names != nullptr && context.progress.mixed) {
    throw ExperimentError(names->front().where, names->front().text,
                          "is not a feature behind a step that mixes them");
  }
  if (std::holds_alternative<FisherInformationSpec>(select)) {
    requireNoise(context.experiment, context.where, "select by fisher_information");
  }
}

bool whitensByCovariance(const TransformStepSpec& step) {
  const auto* whiten = std::get_if<WhitenSpec>(&step.kind);
  return whiten != nullptr && whiten->by == WhitenBy::kCovariance;
}

/// Whether inputs behind the step are no longer the features, one by one.
bool mixes(const TransformStepSpec& step) {
  return std::holds_alternative<PrincipalComponentsSpec>(step.kind) ||
         std::holds_alternative<PartialLeastSquaresSpec>(step.kind) || whitensByCovariance(step);
}

/// Whether inputs behind the step have independent noise of unit variance.
bool whitens(const TransformStepSpec& step, const NoiseSpec& noise) {
  return std::holds_alternative<WhitenSpec>(step.kind) &&
         (whitensByCovariance(step) || noise.correlation.empty());
}

void checkLengthScales(const TransformStepSpec& step, LengthScales length_scales) {
  if (length_scales == LengthScales::kPerOutput &&
      (mixes(step) || std::holds_alternative<SelectSpec>(step.kind))) {
    throw ExperimentError(
        step.where, "",
        "cannot be combined with inverse_map.gp.length_scales: per_output, because behind it inputs "
        "are not all the features; use per_feature or shared");
  }
}

}  // namespace

void checkTransform(const ExperimentSpec& experiment) {
  Progress progress;
  for (const TransformStepSpec& step : experiment.transform) {
    const Context context{experiment, progress, step.where};
    std::visit([&context](const auto& kind) { checkStep(kind, context); }, step.kind);
    if (const GpMapSpec* gp = experiment.inverse_map.findGp()) {
      checkLengthScales(step, gp->length_scales);
    }
    progress.whitened = whitens(step, experiment.noise);
    progress.mixed = progress.mixed || mixes(step);
  }
}

}  // namespace twinmap
