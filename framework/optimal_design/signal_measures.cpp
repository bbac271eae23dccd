#include "framework/optimal_design/signal_measures.hpp"

#include <algorithm>
#include <cmath>

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/simulation/excitation/excitation.hpp"
#include "framework/simulation/model_numbers.hpp"

namespace twinmap::experiment_design {
namespace {

constexpr int kSamples = 2000;  // of the simulation
constexpr int kMin = 8;         // intervals of a phase

/// Adds up the measures while time goes on; `rms` holds the integral of the square until the end.
class Accumulator {
 public:
  Accumulator(std::size_t signals, double shortest)
      : measures_(signals), last_(signals), shortest_(shortest) {}

  void jump(const std::vector<double>& values) {
    for (std::size_t s = 0; s < values.size(); ++s) {
      raiseRate(s, (values[s] - last_[s]) / shortest_);
      raise(s, values[s]);
    }
    last_ = values;
  }

  void advance(const std::vector<double>& values, double interval, double simpson_weight) {
    for (std::size_t s = 0; s < values.size(); ++s) {
      raiseRate(s, (values[s] - last_[s]) / interval);
      raise(s, values[s]);
      addSquare(s, values[s], interval * simpson_weight);
    }
    last_ = values;
  }

  void begin(const std::vector<double>& values, double interval) {
    for (std::size_t s = 0; s < values.size(); ++s) {
      addSquare(s, values[s], interval / 3.0);
    }
  }

  std::vector<SignalMeasure> finish(double duration) {
    for (SignalMeasure& measure : measures_) {
      measure.rms = std::sqrt(measure.rms / duration);
    }
    return measures_;
  }

 private:
  void raise(std::size_t s, double value) {
    measures_[s].max_abs = std::max(measures_[s].max_abs, std::abs(value));
  }
  void raiseRate(std::size_t s, double rate) {
    measures_[s].max_rate = std::max(measures_[s].max_rate, std::abs(rate));
  }
  void addSquare(std::size_t s, double value, double weight) { measures_[s].rms += weight * value * value; }

  std::vector<SignalMeasure> measures_;
  std::vector<double> last_;
  double shortest_;
};

/// One phase, from `begin` to `end`, in an even number of intervals.
void addPhase(const Excitation& excitation, double begin, double end, double share, Accumulator& sum) {
  const int intervals = std::max(kMin, 2 * static_cast<int>(std::ceil(0.5 * share * kSamples)));
  const double interval = (end - begin) / intervals;
  std::vector<double> values(excitation.getSignalCount());
  excitation.calcValues(begin, values);
  sum.jump(values);
  sum.begin(values, interval);
  for (int i = 1; i <= intervals; ++i) {
    excitation.calcValues(begin + i * interval, values);
    sum.advance(values, interval, i == intervals ? 1.0 / 3.0 : (i % 2 == 1 ? 4.0 / 3.0 : 2.0 / 3.0));
  }
}

}  // namespace

std::vector<SignalMeasure> calcSignalMeasures(const ModelSpec& model) {
  ModelNumbers numbers(model);
  numbers.update(calcBoxCenter(collectSampled(model)));
  Excitation excitation(model.excitation);
  excitation.update(numbers);
  const double duration = model.simulation.duration;
  std::vector<double> times = excitation.calcEventTimes(duration);
  times.insert(times.begin(), 0.0);
  times.push_back(duration);
  Accumulator sum(model.excitation.size(), duration / kSamples);
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    excitation.beginPhase(times[i]);
    addPhase(excitation, times[i], times[i + 1], (times[i + 1] - times[i]) / duration, sum);
  }
  return sum.finish(duration);
}

}  // namespace twinmap::experiment_design
