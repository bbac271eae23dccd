#include "framework/spec/check/check_experiment.hpp"

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
    if (feature.modes && feature.modes->frequencies && !(noise.scale * noise.modes->frequency > 0.0)) {
      throw ExperimentError(where, step, "needs noise above 0 in noise.modes.frequency");
    }
    if (feature.modes && feature.modes->damping_ratios && !(noise.scale * noise.modes->damping_ratio > 0.0)) {
      throw ExperimentError(where, step, "needs noise above 0 in noise.modes.damping_ratio");
    }
  }
}

void checkWhiten(const WhitenSpec& whiten, const Progress& progress, const SourceLocation& where) {
  if (progress.mixed && whiten.by == WhitenBy::kStddev) {
    throw ExperimentError(where, "whiten",
                          "must be 'whiten: {by: covariance}' behind a step that mixes features, which "
                          "correlates their noise; or come before it");
  }
}

void checkPrincipalComponents(const PrincipalComponentsSpec& spec, const Progress& progress,
                              const SourceLocation& where) {
  const bool automatic = !spec.components.number && !spec.explained_variance;
  if (automatic && !progress.whitened) {
    throw ExperimentError(
        where, "principal_components",
        "needs components or explained_variance, unless it directly follows whiten (by covariance, "
        "where the noise is correlated)");
  }
}

void checkSelect(const SelectSpec& select, const ExperimentSpec& experiment, const Progress& progress,
                 const SourceLocation& where) {
  if (!select.features.empty() && progress.mixed) {
    throw ExperimentError(select.features.front().where, select.features.front().text,
                          "is no feature behind a step that mixes them");
  }
  if (select.fisher_information) {
    requireNoise(experiment, where, "select by fisher_information");
  }
}

void checkStep(const TransformStepSpec& step, const ExperimentSpec& experiment, const Progress& progress) {
  if (step.whiten) {
    requireNoise(experiment, step.where, "whiten");
    requireModesNoise(experiment, step.where, "whiten");
    checkWhiten(*step.whiten, progress, step.where);
  }
  if (step.select) {
    checkSelect(*step.select, experiment, progress, step.where);
  }
  if (step.principal_components) {
    checkPrincipalComponents(*step.principal_components, progress, step.where);
  }
}

/// Whether inputs behind the step are no longer the features, one by one.
bool mixes(const TransformStepSpec& step) {
  return step.principal_components || step.partial_least_squares ||
         (step.whiten && step.whiten->by == WhitenBy::kCovariance);
}

void checkLengthScales(const TransformStepSpec& step, LengthScales length_scales) {
  if (length_scales == LengthScales::kPerOutput && (mixes(step) || step.select)) {
    throw ExperimentError(step.where, "",
                          "goes not with inverse_map.gp.length_scales: per_output, because behind it inputs "
                          "are not all the features; use per_feature or shared");
  }
}

}  // namespace

void checkTransform(const ExperimentSpec& experiment) {
  Progress progress;
  for (const TransformStepSpec& step : experiment.transform) {
    checkStep(step, experiment, progress);
    checkLengthScales(step, experiment.inverse_map.gp.length_scales);
    progress.whitened =
        step.whiten && (step.whiten->by == WhitenBy::kCovariance || experiment.noise.correlation.empty());
    progress.mixed = progress.mixed || mixes(step);
  }
}

}  // namespace twinmap
