#include "framework/experiment/check/check_features.hpp"

#include <algorithm>
#include <cmath>

#include "framework/base/text/number_text.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "framework/experiment/model/parameter_box.hpp"

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

void checkFeature(const SamplesFeatureSpec& samples, const ModelSpec& model) {
  checkOutputs(samples.outputs, model);
  checkTimes(samples, model, findFeature(samples.outputs.front(), "outputs"));
}

void checkFeature(const StatisticsFeatureSpec& statistics, const ModelSpec& model) {
  checkOutputs(statistics.outputs, model);
  const SourceLocation where = findFeature(statistics.outputs.front(), "outputs");
  checkTimes(statistics.window, model, where);
  for (auto quantity = statistics.quantities.begin(); quantity != statistics.quantities.end(); ++quantity) {
    if (std::find(statistics.quantities.begin(), quantity, *quantity) != quantity) {
      throw ExperimentError(where, "", "names one of its quantities twice");
    }
  }
}

void checkFeature(const ExtremaFeatureSpec& extrema, const ModelSpec& model) {
  checkOutputs({extrema.output}, model);
  checkTimes(extrema.window, model, findFeature(extrema.output, "output"));
}

/// Frequencies between the lines would leak into one another and into the mean.
void checkLines(const std::vector<Frequency>& frequencies, const WindowSpec& window) {
  constexpr double kTolerance = 1e-6;  // of the distance between lines
  const double resolution = 1.0 / (window.interval * window.count);
  std::vector<int> lines;
  for (const Frequency& frequency : frequencies) {
    const int line = calcLine(window, frequency);
    if (std::abs(frequency.hertz / resolution - line) > kTolerance || line < 1 || 2 * line >= window.count) {
      throw ExperimentError(frequency.where, toText(frequency.hertz),
                            "must be a line of the window: a multiple of 1 / (count * interval) = " +
                                toText(resolution) + " Hz below " + toText(0.5 / window.interval) + " Hz");
    }
    if (std::find(lines.begin(), lines.end(), line) != lines.end()) {
      throw ExperimentError(frequency.where, toText(frequency.hertz), "is listed twice");
    }
    lines.push_back(line);
  }
}

void checkFeature(const SpectrumFeatureSpec& spectrum, const ModelSpec& model) {
  checkOutputs(spectrum.outputs, model);
  checkTimes(spectrum.window, model, findFeature(spectrum.outputs.front(), "outputs"));
  checkLines(spectrum.frequencies, spectrum.window);
}

void appendPointers(std::vector<const Expression*>& all, const std::vector<Expression>& expressions) {
  for (const Expression& expression : expressions) {
    all.push_back(&expression);
  }
}

std::vector<const Expression*> collectExpressions(const SignalSpec& signal) {
  std::vector<const Expression*> all;
  for (const PulseSpec& pulse : signal.pulses) {
    all.insert(all.end(), {&pulse.amplitude, &pulse.start, &pulse.end});
  }
  for (const SineSpec& sine : signal.sines) {
    all.insert(all.end(), {&sine.amplitude, &sine.frequency, &sine.phase, &sine.start, &sine.end});
  }
  for (const ChirpSpec& chirp : signal.chirps) {
    all.insert(all.end(),
               {&chirp.amplitude, &chirp.start_frequency, &chirp.end_frequency, &chirp.start, &chirp.end});
  }
  for (const MultisineSpec& multisine : signal.multisines) {
    all.insert(all.end(), {&multisine.amplitude, &multisine.start, &multisine.end});
    appendPointers(all, multisine.amplitudes);
    appendPointers(all, multisine.frequencies);
    appendPointers(all, multisine.phases);
  }
  return all;
}

/// A parameter that an expression uses, be it through constants, or "".
std::string findParameter(const Expression& expression, const ModelSpec& model) {
  if (expression.text.empty()) {
    return "";
  }
  const std::vector<std::string> parameters = collectNames(collectSampled(model));
  for (const std::string& name : getUsedNames(expression)) {
    if (std::find(parameters.begin(), parameters.end(), name) != parameters.end()) {
      return name;
    }
    for (const ConstantSpec& constant : model.constants) {
      const std::string within = constant.name.text == name ? findParameter(constant.value, model) : "";
      if (!within.empty()) {
        return within;
      }
    }
  }
  return "";
}

void checkKnown(const SignalSpec& signal, const ModelSpec& model) {
  for (const Expression* expression : collectExpressions(signal)) {
    const std::string parameter = findParameter(*expression, model);
    if (!parameter.empty()) {
      throw ExperimentError(expression->where, expression->text,
                            "depends on the sampled parameter '" + parameter +
                                "', but the excitation of a frequency_response must be known");
    }
  }
}

void checkFeature(const FrequencyResponseFeatureSpec& response, const ModelSpec& model) {
  requireKnown(response.excitation, collectNames(model.excitation), "an excitation signal");
  checkOutputs(response.outputs, model);
  checkTimes(response.window, model, findFeature(response.outputs.front(), "outputs"));
  checkLines(response.frequencies, response.window);
  for (const SignalSpec& signal : model.excitation) {
    if (signal.name.text == response.excitation.text) {
      checkKnown(signal, model);
    }
  }
}

void checkFeature(const ModesFeatureSpec&, const ModelSpec&) {}

/// A mistyped duration would cost hours of simulation that no feature needs.
void checkSampledDuration(const std::vector<FeatureSpec>& features, const ModelSpec& model) {
  constexpr double kMax = 100.0, kShort = 1.0;
  double last = kShort;
  for (const FeatureSpec& feature : features) {
    const WindowSpec window = getWindow(feature);
    last = std::max(last, calcSampleTime(window, window.count - 1));
  }
  if (model.simulation.duration > kMax * last) {
    throw ExperimentError({model.parameters.front().name.where.file, 0, 0, "simulation.duration"},
                          toText(model.simulation.duration),
                          "must be at most 100 times the " + toText(last) + " s that the features need");
  }
}

}  // namespace

void requireFewSamples(const std::vector<FeatureSpec>& features, const SourceLocation& where) {
  constexpr double kMax = 1e7;
  double samples = 0.0;
  for (const FeatureSpec& feature : features) {
    samples += getWindow(feature).count;
  }
  if (samples > kMax) {
    throw ExperimentError({where.file, 0, 0, "features"}, "",
                          "need more than 10000000 samples of an output, all together");
  }
}

void checkFeatures(const std::vector<FeatureSpec>& features, const ModelSpec& model) {
  for (const FeatureSpec& feature : features) {
    std::visit([&model](const auto& kind) { checkFeature(kind, model); }, feature);
  }
  checkSampledDuration(features, model);
}

}  // namespace twinmap
