#include "framework/experiment/check/check_noise.hpp"

#include <algorithm>

#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/noise_correlation.hpp"
#include "kernels/linalg/autocorrelation.hpp"

namespace twinmap {
namespace {

void checkModesNoise(const ExperimentSpec& experiment) {
  const bool needed = countModes(experiment.features) > 0;
  if (needed != experiment.noise.modes.has_value()) {
    throw ExperimentError(
        {experiment.name.where.file, 0, 0, "noise.modes"}, "",
        needed ? "is needed for features of modes: {frequency: Hz, damping_ratio: }, 0 for none"
               : "is given, but no feature is made of modes");
  }
}

void checkCorrelation(const NoiseCorrelationSpec& correlation, const std::vector<FeatureSpec>& features) {
  const auto reject = [&](const std::string& rule) {
    throw ExperimentError(correlation.name.where, correlation.name.text, rule);
  };
  if (!isStationary(correlation.autoregression)) {
    reject("has an autoregression that is not stationary: a root lies on or outside the unit circle");
  }
  const std::vector<double> times = collectTimesOf(correlation.name.text, features);
  if (times.size() < 2) {
    return;
  }
  if (!correlation.sample_time) {
    reject("needs sample_time (s, of a lag), because its feature times are not equidistant");
  }
  constexpr double kMaxLags =
      20000.0;  // finding out whether values are an autocorrelation costs their square
  if (times.back() - times.front() > kMaxLags * *correlation.sample_time) {
    reject("has feature times that are more than 20000 times sample_time apart");
  }
  const std::vector<long> lags = findLags(times, *correlation.sample_time);
  if (lags.empty()) {
    reject("has feature times that are not multiples of sample_time apart");
  }
  if (!correlation.values.empty() && !isPositiveDefinite(calcAutocorrelation(correlation, lags.back()))) {
    reject("has values that are no autocorrelation: their covariance matrix is not positive definite");
  }
}

/// Residuals of samples show their noise; a peak's or a spectrum's noise follows from a stated one.
void checkUnknown(const OutputNoiseSpec& spec, const std::vector<FeatureSpec>& features) {
  for (const FeatureSpec& feature : features) {
    const std::vector<Name> outputs = getOutputs(feature);
    const bool uses = std::any_of(outputs.begin(), outputs.end(),
                                  [&](const Name& output) { return output.text == spec.name.text; });
    if (uses && !std::holds_alternative<SamplesFeatureSpec>(feature)) {
      throw ExperimentError(spec.stddev.where, "unknown",
                            "can be inferred where all features of '" + spec.name.text +
                                "' are samples; give a number, or samples alone");
    }
  }
}

}  // namespace

std::string findReductionFault(const ExperimentSpec& experiment) {
  const NoiseSpec& noise = experiment.noise;
  bool any = false, all = true;
  for (const FeatureSpec& feature : experiment.features) {
    const auto* samples = std::get_if<SamplesFeatureSpec>(&feature);
    const bool reduced = samples != nullptr && samples->isReduced();
    any = any || reduced;
    all = all && reduced;
  }
  if (any && !all) {
    return "are reduced in part; give 'reduce: automatic' to all of them, which must be samples";
  }
  if (any && !noise.correlation.empty()) {
    return "are reduced, but noise.correlation is given; leave 'reduce' or 'correlation' out";
  }
  for (const Name& output : any ? collectOutputs(experiment.features) : std::vector<Name>{}) {
    for (const OutputNoiseSpec& spec : noise.stddev) {
      if (spec.name.text == output.text && noise.scale * spec.stddev <= 0.0) {
        return "are reduced, which needs noise on each: noise.stddev of '" + output.text + "' is 0";
      }
    }
  }
  return "";
}

void requireStatedNoise(const ExperimentSpec& experiment) {
  for (const OutputNoiseSpec& spec : experiment.noise.stddev) {
    if (spec.stddev.unknown) {
      throw ExperimentError(spec.stddev.where, "unknown",
                            "is for `twinmap infer FILE.yaml MEASUREMENT`, which infers it; give a number "
                            "(`twinmap noise` finds it in a recording at rest)");
    }
  }
}

void checkNoise(const ExperimentSpec& experiment) {
  const NoiseSpec& noise = experiment.noise;
  const ModelSpec& model = experiment.model;
  const std::vector<std::string> outputs = collectNames(model.outputs);
  for (const OutputNoiseSpec& stddev : noise.stddev) {
    requireKnown(stddev.name, outputs, "an output");
    if (stddev.stddev.unknown) {
      checkUnknown(stddev, experiment.features);
    }
  }
  checkModesNoise(experiment);
  for (const NoiseCorrelationSpec& correlation : noise.correlation) {
    requireKnown(correlation.name, outputs, "an output");
    checkCorrelation(correlation, experiment.features);
  }
  if (const std::string fault = findReductionFault(experiment); !fault.empty()) {
    throw ExperimentError({experiment.name.where.file, 0, 0, "features"}, "", fault);
  }
  if (collectOutputs(experiment.features).empty()) {
    return;
  }
  const std::vector<std::string> given = collectNames(noise.stddev);
  for (const OutputSpec& output : model.outputs) {
    if (std::find(given.begin(), given.end(), output.name.text) == given.end()) {
      throw ExperimentError(output.name.where, output.name.text,
                            "has no noise in noise.stddev; give its standard deviation, 0 for none");
    }
  }
}

}  // namespace twinmap
