#include "framework/spec/check_experiment.hpp"

#include <algorithm>
#include <cctype>

#include "framework/spec/check_features.hpp"
#include "framework/spec/nearest_name.hpp"

namespace twinmap {
namespace {

void checkName(const Name& name) {
  constexpr std::size_t kLongestName = 100;
  const auto is_allowed = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
  };
  const bool valid = std::all_of(name.text.begin(), name.text.end(), is_allowed) && name.text[0] != '.' &&
                     name.text.size() <= kLongestName;
  if (!valid) {
    throw ExperimentError(name.where, name.text,
                          "names the run's folder: use at most 100 letters, digits, '_', '-' and '.', not "
                          "beginning with '.'");
  }
}

void checkNoise(const NoiseSpec& noise, const ModelSpec& model) {
  const std::vector<std::string> outputs = collectNames(model.outputs);
  for (const OutputNoiseSpec& stddev : noise.stddev) {
    requireKnown(stddev.name, outputs, "an output");
  }
  const std::vector<std::string> given = collectNames(noise.stddev);
  for (const OutputSpec& output : model.outputs) {
    if (std::find(given.begin(), given.end(), output.name.text) == given.end()) {
      throw ExperimentError(output.name.where, output.name.text,
                            "has no noise in noise.stddev; give its standard deviation, 0 for none");
    }
  }
}

void requireNoise(const ExperimentSpec& experiment, const SourceLocation& where) {
  for (const Name& output : collectOutputs(experiment.features)) {
    for (const OutputNoiseSpec& noise : experiment.noise.stddev) {
      if (noise.name.text == output.text && !(experiment.noise.scale * noise.stddev > 0.0)) {
        throw ExperimentError(
            where, "whiten",
            "needs noise above 0 on output '" + output.text + "'; use z_score without noise");
      }
    }
  }
}

/// Whitening divides by the noise of every feature's output, and an automatic rank needs whitened features.
void checkTransform(const ExperimentSpec& experiment) {
  bool whitened = false, projected = false;
  for (const TransformStepSpec& step : experiment.transform) {
    if (step.whiten && projected) {
      throw ExperimentError(step.where, "whiten", "must come before principal_components");
    }
    if (step.whiten) {
      requireNoise(experiment, step.where);
    }
    const bool automatic = step.principal_components && !step.principal_components->components &&
                           !step.principal_components->explained_variance;
    if (automatic && !whitened) {
      throw ExperimentError(step.where, "principal_components",
                            "needs components or explained_variance, unless it directly follows whiten");
    }
    whitened = step.whiten.has_value();
    projected = projected || step.principal_components.has_value();
  }
  if (projected && experiment.inverse_map.gp.length_scales == LengthScales::kPerOutput) {
    throw ExperimentError({experiment.name.where.file, 0, 0, "inverse_map.gp.length_scales"}, "per_output",
                          "has no meaning after principal_components, which mix the outputs");
  }
}

void checkDesign(const DesignSpec& design, const SourceLocation& where) {
  constexpr int kFewest = 2;  // standard deviations need two
  if (design.train.samples < kFewest || design.test.samples < kFewest) {
    throw ExperimentError({where.file, 0, 0, "design"}, "", "needs at least 2 training and 2 test samples");
  }
}

}  // namespace

void requireKnown(const Name& name, const std::vector<std::string>& known, const std::string& what) {
  if (std::find(known.begin(), known.end(), name.text) == known.end()) {
    throw ExperimentError(name.where, name.text, "is not " + what + suggestName(name.text, known));
  }
}

void checkExperiment(const ExperimentSpec& experiment) {
  checkName(experiment.name);
  checkModel(experiment.model);
  checkFeatures(experiment.features, experiment.model);
  checkNoise(experiment.noise, experiment.model);
  checkTransform(experiment);
  checkDesign(experiment.design, experiment.name.where);
  for (const Name& axis : experiment.report.over) {
    requireKnown(axis, collectNames(experiment.model.parameters), "a parameter");
  }
}

}  // namespace twinmap
