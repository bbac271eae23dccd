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
