#include "framework/spec/noise_correlation.hpp"

#include <algorithm>
#include <cmath>

#include "framework/spec/autocorrelation.hpp"
#include "framework/spec/check/check_experiment.hpp"

namespace twinmap {
namespace {

constexpr double kMostLags = 20000.0;  // finding out whether values are an autocorrelation costs their square

/// The times (s) at which the features need an output: sorted, each once.
class OutputTimes {
 public:
  explicit OutputTimes(const std::string& output) : output_(output) {}

  void operator()(const SamplesFeatureSpec& kind) { add(kind.outputs, kind); }
  void operator()(const ExtremaFeatureSpec& kind) { add({kind.output}, kind.window); }
  void operator()(const ModesFeatureSpec&) {}
  template <class Kind>
  void operator()(const Kind& kind) {
    add(kind.outputs, kind.window);
  }

  std::vector<double> get() {
    std::sort(times_.begin(), times_.end());
    times_.erase(std::unique(times_.begin(), times_.end()), times_.end());
    return times_;
  }

 private:
  template <class Samples>
  void add(const std::vector<Name>& outputs, const Samples& samples) {
    for (const Name& name : outputs) {
      for (int i = 0; name.text == output_ && i < samples.count; ++i) {
        times_.push_back(calcSampleTime(samples, i));
      }
    }
  }

  const std::string& output_;
  std::vector<double> times_;
};

std::vector<double> collectTimesOf(const std::string& output, const std::vector<FeatureSpec>& features) {
  OutputTimes times(output);
  for (const FeatureSpec& feature : features) {
    visitKind(feature, [&](const auto& kind) { times(kind); });
  }
  return times.get();
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
  if (times.back() - times.front() > kMostLags * *correlation.sample_time) {
    reject("has feature times that are more than 20000 times sample_time apart");
  }
  const std::vector<long> grid = findGrid(times, *correlation.sample_time);
  if (grid.empty()) {
    reject("has feature times that are not multiples of sample_time apart");
  }
  if (!correlation.values.empty() && !isPositiveDefinite(calcAutocorrelation(correlation, grid.back()))) {
    reject("has values that are no autocorrelation: their covariance matrix is not positive definite");
  }
}

}  // namespace

std::vector<long> findGrid(const std::vector<double>& times, double sample_time) {
  constexpr double kTolerance = 1e-6;  // of sample_time
  std::vector<long> grid;
  for (const double time : times) {
    const double steps = (time - times.front()) / sample_time;
    grid.push_back(std::lround(steps));
    if (std::abs(steps - static_cast<double>(grid.back())) > kTolerance * std::max(1.0, steps)) {
      return {};
    }
  }
  return grid;
}

void resolveNoiseCorrelation(ExperimentSpec& experiment) {
  for (NoiseCorrelationSpec& correlation : experiment.noise.correlation) {
    const std::vector<double> times = collectTimesOf(correlation.name.text, experiment.features);
    if (correlation.sample_time || times.size() < 2) {
      continue;
    }
    const double spacing = (times.back() - times.front()) / (static_cast<double>(times.size()) - 1.0);
    if (!findGrid(times, spacing).empty()) {
      correlation.sample_time = std::round(spacing * 1e12) / 1e12;  // whole picoseconds, as sample times
    }
  }
}

void checkNoiseCorrelation(const ExperimentSpec& experiment) {
  for (const NoiseCorrelationSpec& correlation : experiment.noise.correlation) {
    requireKnown(correlation.name, collectNames(experiment.model.outputs), "an output");
    checkCorrelation(correlation, experiment.features);
  }
}

}  // namespace twinmap
