#include "framework/data/measurement/recording/recorded_times.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "framework/data/measurement/recording.hpp"
#include "framework/data/measurement/time_series.hpp"
#include "kernels/linalg/autocorrelation.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

double calcMeanStep(const std::vector<double>& times) {
  return times.size() < 2 ? 1.0 : (times.back() - times.front()) / (static_cast<double>(times.size()) - 1.0);
}

/// How many times from number `first` on are equidistant, and at what interval.
SamplesFeatureSpec takeRun(const std::vector<double>& times, std::size_t first, double tolerance) {
  SamplesFeatureSpec run;
  run.start = times[first];
  run.count = 1;
  run.interval = first + 1 < times.size() ? times[first + 1] - times[first] : calcMeanStep(times);
  const auto deviates = [&](int i) {
    return std::abs(calcSampleTime(run, i) - times[first + static_cast<std::size_t>(i)]) > tolerance;
  };
  while (first + static_cast<std::size_t>(run.count) < times.size() && !deviates(run.count)) {
    ++run.count;
    // their mean: stamps are rounded, and drift away from an interval that is taken from two
    run.interval = (times[first + static_cast<std::size_t>(run.count) - 1] - times[first]) / (run.count - 1);
  }
  for (int i = 1; i < run.count; ++i) {
    if (deviates(i)) {
      run.count = i;
    }
  }
  return run;
}

/// The recorded times that may stand for those that features need of one output.
class TimeChoice {
 public:
  /// Both increasing; end: of the simulation.
  TimeChoice(const std::vector<double>& needed, const VectorXd& recorded, double rounding, double end)
      : needed_(needed) {
    std::copy_if(recorded.begin(), recorded.end(), std::back_inserter(recorded_),
                 [end](double t) { return t > 0.0 && t <= end; });
    step_ = recorded.size() > 1 ? calcMedianStep(recorded) : 0.0;
    tolerance_ = std::max(kSameTime * step_, rounding);
  }

  /// Empty where the needed times do as well.
  std::vector<double> choose() const {
    constexpr double kAbout = 1.2;   // times as many are taken whole
    constexpr double kWorth = 0.01;  // of the samples: single ones are no reason for other times
    std::vector<double> all = listWithin();
    const auto count = static_cast<double>(needed_.size());
    std::vector<double> chosen =
        static_cast<double>(all.size()) <= kAbout * count ? std::move(all) : listNearest();
    const double more = static_cast<double>(chosen.size()) - static_cast<double>(countExact());
    return more > kWorth * count ? chosen : std::vector<double>();
  }

 private:
  std::vector<double> listWithin() const {
    const double half = needed_.size() < 2 ? 0.5 * step_ : 0.5 * calcMeanStep(needed_);
    std::vector<double> within;
    for (const double t : recorded_) {
      if (t >= needed_.front() - half && t <= needed_.back() + half) {
        within.push_back(t);
      }
    }
    return within;
  }

  std::vector<double> listNearest() const {
    constexpr double kNear = 0.75;  // of a step, which jitters; beside one that is missing stands none
    std::vector<double> nearest;
    for (const double t : needed_) {
      const auto next = findNext(t);
      const bool is_before =
          next == recorded_.end() || (next != recorded_.begin() && t - *std::prev(next) <= *next - t);
      const auto found = is_before && next != recorded_.begin() ? std::prev(next) : next;
      if (found != recorded_.end() && std::abs(*found - t) <= kNear * step_) {
        nearest.push_back(*found);
      }
    }
    sortUnique(nearest);
    return nearest;
  }

  std::vector<double>::const_iterator findNext(double t) const {
    return std::lower_bound(recorded_.begin(), recorded_.end(), t - tolerance_);
  }

  std::ptrdiff_t countExact() const {
    return std::count_if(needed_.begin(), needed_.end(), [&](double t) {
      const auto next = findNext(t);
      return next != recorded_.end() && std::abs(*next - t) <= tolerance_;
    });
  }

  const std::vector<double>& needed_;
  std::vector<double> recorded_;  // those that can be simulated
  double step_ = 0.0, tolerance_ = 0.0;
};

/// Whether the noise that is stated of an output can be told at these times.
bool hasNoiseAt(const NoiseSpec& noise, const std::string& output, const std::vector<double>& times) {
  return std::all_of(
      noise.correlation.begin(), noise.correlation.end(), [&](const NoiseCorrelationSpec& spec) {
        return spec.name.text != output || !spec.sample_time || !findLags(times, *spec.sample_time).empty();
      });
}

}  // namespace

bool areSamples(const std::vector<FeatureSpec>& features) {
  return std::all_of(features.begin(), features.end(), [](const FeatureSpec& feature) {
    return std::holds_alternative<SamplesFeatureSpec>(feature);
  });
}

std::vector<FeatureSpec> makeSamplesAt(const std::string& output, const std::vector<double>& times) {
  constexpr double kClose = 1e-7;  // of a step, so that samples are found at the times that were asked for
  std::vector<FeatureSpec> blocks;
  for (std::size_t i = 0; i < times.size();) {
    SamplesFeatureSpec run = takeRun(times, i, kClose * calcMeanStep(times));
    run.outputs.push_back({output, {}});
    i += static_cast<std::size_t>(run.count);
    blocks.emplace_back(std::move(run));
  }
  return blocks;
}

std::optional<ExperimentSpec> followRecordedTimes(const ExperimentSpec& experiment,
                                                  const ResponseLayout& layout, const Table& table,
                                                  double start) {
  constexpr double kRounding = 4e-16;  // of times since 1970
  if (experiment.model.source || !areSamples(experiment.features)) {
    return std::nullopt;
  }
  RecordedColumns recording(table, experiment.measurement, start);
  std::vector<FeatureSpec> features;
  bool differs = false;
  for (std::size_t o = 0; o < layout.output_names.size(); ++o) {
    const std::string& name = layout.output_names[o];
    std::vector<double> times = collectTimesOf(name, experiment.features);
    if (times.empty()) {
      continue;
    }
    const ClockedRows& rows = recording.getRows(name);
    const Samples samples = readSamples(rows, experiment.measurement, layout, o);
    std::vector<double> chosen = TimeChoice(times, samples.times, kRounding * std::abs(rows.start),
                                            experiment.model.simulation.duration)
                                     .choose();
    if (!chosen.empty() && hasNoiseAt(experiment.noise, name, chosen)) {
      times = std::move(chosen);
      differs = true;
    }
    const std::vector<FeatureSpec> blocks = makeSamplesAt(name, times);
    features.insert(features.end(), blocks.begin(), blocks.end());
  }
  if (!differs) {
    return std::nullopt;
  }
  std::optional<ExperimentSpec> followed = experiment;
  followed->features = std::move(features);
  return followed;
}

}  // namespace twinmap
