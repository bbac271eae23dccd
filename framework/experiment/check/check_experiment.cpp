#include "framework/experiment/check/check_experiment.hpp"

#include <algorithm>
#include <cctype>

#include "framework/base/text/nearest_name.hpp"
#include "framework/experiment/check/check_features.hpp"
#include "framework/experiment/check/check_measurement.hpp"
#include "framework/experiment/check/check_noise.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/parameter_figures.hpp"

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

/// What is simulated must have a duration.
void checkDuration(const ExperimentSpec& experiment) {
  if (!collectOutputs(experiment.features).empty() && !(experiment.model.simulation.duration > 0.0)) {
    throw ExperimentError({experiment.name.where.file, 0, 0, "simulation.duration"}, "",
                          "must be given, above 0: the simulated time (s), which features of outputs need");
  }
}

void checkDesign(const ExperimentSpec& experiment) {
  const DesignSpec& design = experiment.design;
  const SourceLocation& where = experiment.name.where;
  constexpr int kMin = 2;  // standard deviations need two
  const bool trains = !experiment.inverse_map.isNone();
  if ((trains && design.train.samples < kMin) || design.test.samples < kMin) {
    throw ExperimentError({where.file, 0, 0, "design"}, "", "needs at least 2 training and 2 test samples");
  }
}

void checkCriterion(const CriterionSpec& criterion, const ModelSpec& model) {
  const std::vector<std::string> parameters = collectNames(model.parameters);
  if (const Name* parameter = std::get_if<Name>(&criterion.kind)) {
    requireKnown(*parameter, parameters, "a parameter");
  }
  if (const ParameterWeights* weights = std::get_if<ParameterWeights>(&criterion.kind)) {
    for (const ParameterWeight& one : weights->values) {
      requireKnown(one.name, parameters, "a parameter");
    }
  }
}

void checkExcitationDesign(const ExcitationDesignSpec& design, const ModelSpec& model) {
  checkCriterion(design.criterion, model);
  for (const DesignLimitSpec& limit : design.limits) {
    limit.output ? requireKnown(*limit.output, collectNames(model.outputs), "an output")
                 : requireKnown(*limit.signal, collectNames(model.excitation), "a signal of the excitation");
  }
}

void checkSensorDesign(const SensorDesignSpec& design, const ExperimentSpec& experiment) {
  checkCriterion(design.criterion, experiment.model);
  std::vector<std::string> noisy;
  for (const OutputNoiseSpec& output : experiment.noise.stddev) {
    if (output.stddev > 0.0) {
      noisy.push_back(output.name.text);
    }
  }
  const std::vector<Name>& outputs = design.candidates.outputs;
  for (auto output = outputs.begin(); output != outputs.end(); ++output) {
    requireKnown(*output, collectNames(experiment.model.outputs), "an output");
    requireKnown(*output, noisy, "an output with noise.stddev above 0");
    const auto same = [&](const Name& other) { return other.text == output->text; };
    if (std::any_of(outputs.begin(), output, same)) {
      throw ExperimentError(output->where, output->text, "is listed twice");
    }
  }
}

void checkGates(const ExperimentSpec& experiment) {
  std::vector<std::string> known = collectNames(experiment.model.parameters);
  const std::vector<std::string> derived = collectNames(experiment.derived);
  known.insert(known.end(), derived.begin(), derived.end());
  for (const GateSpec& gate : experiment.gates) {
    requireKnown(gate.metric, listGateMetrics(), "a metric");
    if (gate.parameter) {
      requireKnown(*gate.parameter, known, "a parameter or a derived quantity");
    }
  }
}

/// Without a map there is nothing to compare with: all answers are exact posteriors.
void checkEvaluation(const ExperimentSpec& experiment) {
  const EvaluationSpec& evaluation = experiment.evaluation;
  const bool compares = evaluation.posterior || !evaluation.baselines.empty() || !evaluation.maps.empty();
  if (experiment.inverse_map.isNone() && compares) {
    throw ExperimentError({experiment.name.where.file, 0, 0, "evaluation"}, "",
                          "must ask for no posterior, baselines or maps with 'inverse_map: none': "
                          "every test sample is answered by its exact posterior");
  }
}

}  // namespace

void checkExperiment(const ExperimentSpec& experiment) {
  checkName(experiment.name);
  checkModel(experiment.model);
  checkBesideModel(experiment);
}

void checkBesideModel(const ExperimentSpec& experiment) {
  checkName(experiment.name);
  checkDuration(experiment);
  checkDerived(experiment);
  if (experiment.trials.empty()) {  // of one at a time
    checkCandidates(experiment);
  }
  checkFeatures(experiment.features, experiment.model);
  checkNoise(experiment);
  checkTransform(experiment);
  checkDesign(experiment);
  if (experiment.design.excitation) {
    checkExcitationDesign(*experiment.design.excitation, experiment.model);
  }
  if (experiment.design.sensors) {
    checkSensorDesign(*experiment.design.sensors, experiment);
  }
  checkEvaluation(experiment);
  checkGates(experiment);
  checkMeasurement(experiment.measurement, experiment.model);
  for (const Name& axis : experiment.report.over) {
    requireKnown(axis, collectNames(experiment.model.parameters), "a parameter");
  }
}

}  // namespace twinmap
