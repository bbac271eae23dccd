#include "framework/spec/check_features.hpp"

#include <algorithm>

#include "framework/spec/check_experiment.hpp"
#include "framework/spec/number_text.hpp"

namespace twinmap {
namespace {

/// The place of the feature that names `output` under `key`.
SourceLocation findFeature(const Name& output, const std::string& key) {
  SourceLocation where = output.where;
  where.key_path = where.key_path.substr(0, where.key_path.rfind("." + key));
  return where;
}

void checkOutputs(const std::vector<Name>& outputs, const ModelSpec& model) {
  const std::vector<std::string> known = collectNames(model.outputs);
  for (auto output = outputs.begin(); output != outputs.end(); ++output) {
    requireKnown(*output, known, "an output");
    const auto same = [&](const Name& other) { return other.text == output->text; };
    if (std::any_of(outputs.begin(), output, same)) {
      throw ExperimentError(output->where, output->text, "is listed twice");
    }
  }
}

template <class Samples>
void checkTimes(const Samples& samples, const ModelSpec& model, const SourceLocation& where) {
  const double last = calcSampleTime(samples, samples.count - 1);
  if (last > model.simulation.duration) {
    throw ExperimentError(where, "",
                          "samples up to t = " + toText(last) + " s, but simulation.duration is " +
                              toText(model.simulation.duration) + " s");
  }
}

void check(const SamplesFeatureSpec& samples, const ModelSpec& model) {
  checkOutputs(samples.outputs, model);
  checkTimes(samples, model, findFeature(samples.outputs.front(), "outputs"));
}

void check(const StatisticsFeatureSpec& statistics, const ModelSpec& model) {
  checkOutputs(statistics.outputs, model);
  const SourceLocation where = findFeature(statistics.outputs.front(), "outputs");
  checkTimes(statistics.window, model, where);
  for (auto quantity = statistics.quantities.begin(); quantity != statistics.quantities.end(); ++quantity) {
    if (std::find(statistics.quantities.begin(), quantity, *quantity) != quantity) {
      throw ExperimentError(where, "", "names one of its quantities twice");
    }
  }
}

void check(const ExtremaFeatureSpec& extrema, const ModelSpec& model) {
  checkOutputs({extrema.output}, model);
  checkTimes(extrema.window, model, findFeature(extrema.output, "output"));
}

void append(std::vector<Name>& names, const std::vector<Name>& others) {
  names.insert(names.end(), others.begin(), others.end());
}

}  // namespace

std::vector<Name> collectOutputs(const std::vector<FeatureSpec>& features) {
  std::vector<Name> outputs;
  for (const FeatureSpec& feature : features) {
    if (feature.samples) {
      append(outputs, feature.samples->outputs);
    }
    if (feature.statistics) {
      append(outputs, feature.statistics->outputs);
    }
    if (feature.extrema) {
      outputs.push_back(feature.extrema->output);
    }
  }
  return outputs;
}

void checkFeatures(const std::vector<FeatureSpec>& features, const ModelSpec& model) {
  for (const FeatureSpec& feature : features) {
    if (feature.samples) {
      check(*feature.samples, model);
    }
    if (feature.statistics) {
      check(*feature.statistics, model);
    }
    if (feature.extrema) {
      check(*feature.extrema, model);
    }
  }
}

}  // namespace twinmap
