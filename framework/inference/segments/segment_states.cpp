#include "framework/inference/segments/segment_states.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "framework/estimation/levels.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/segments/segmented_misfit.hpp"
#include "framework/inference/start_readings.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Value and slope of a quantity where a few samples begin, few enough for what moves fast; NaN where too few
/// are there.
struct Line {
  double value = std::nan(""), slope = std::nan("");
};

Line fitLine(const VectorXd& samples, double interval) {
  double count = 0.0, time = 0.0, square = 0.0, sum = 0.0, product = 0.0;
  for (Index i = 0; i < samples.size(); ++i) {
    if (std::isfinite(samples[i])) {
      const double t = static_cast<double>(i) * interval;
      count += 1.0;
      time += t;
      square += t * t;
      sum += samples[i];
      product += t * samples[i];
    }
  }
  Line line;
  if (count > 1.0) {
    line.slope = (count * product - time * sum) / (count * square - time * time);
    line.value = (sum - line.slope * time) / count;
  }
  return line;
}

/// What is known of one state of all segments.
struct OneState {
  VectorXd values;     ///< S
  double scale = 0.0;  ///< 0: not known
  bool measured = false;
};

class Guesser {
 public:
  Guesser(const ModelSpec& model, double interval, const SegmentSamples& samples)
      : model_(model), interval_(interval), samples_(samples), numbers_(model) {
    numbers_.update(calcBoxCenter(collectSampled(model)));
  }

  OneState guess(const StartState& state) {
    const double given = state.initial.text.empty() ? 0.0 : calc(state.initial);
    OneState one{VectorXd::Constant(static_cast<Index>(samples_.size()), given), std::abs(given)};
    if (const std::optional<double> half_width = findHalfWidth(state.initial.text)) {
      one.scale = *half_width;
    } else if (!state.reach.text.empty()) {
      one.scale = std::abs(calc(state.reach)) / kStateScales;  // its prior ends where it does
    }
    takeMeasured(state, one);
    return one;
  }

 private:
  double calc(const Expression& expression) { return numbers_.calc(expression, {"initial", "value", ""}); }

  /// Of the parameter that the text names.
  std::optional<double> findHalfWidth(const std::string& text) const {
    for (const ParameterSpec& parameter : collectUnknown(model_)) {
      if (parameter.name.text == text) {
        return 0.5 * (parameter.bounds.upper - parameter.bounds.lower);
      }
    }
    return std::nullopt;
  }

  void takeMeasured(const StartState& state, OneState& one) {
    for (const StartReading& reading : listReadings(model_, state, numbers_)) {
      if (!one.measured) {
        takeFrom(reading, one);
      }
    }
  }

  void takeFrom(const StartReading& reading, OneState& one) {
    VectorXd values = one.values;
    std::vector<double> all;  // along the segments too: how far the state goes
    for (Index k = 0; k < values.size(); ++k) {
      const auto samples = samples_[static_cast<std::size_t>(k)].col(reading.output);
      for (Index first = 0; first < samples.size(); first += 2 * kPerUnknown) {
        const Line line =
            fitLine(samples.segment(first, std::min(2 * kPerUnknown, samples.size() - first)), interval_);
        const double value = reading.read(line.value, line.slope);
        if (std::isfinite(value)) {
          all.push_back(value);
          values[k] = first == 0 ? value : values[k];
          one.measured = true;
        }
      }
    }
    if (one.measured) {
      one.values = values;
      const auto known = Eigen::Map<const VectorXd>(all.data(), static_cast<Index>(all.size())).array();
      const double mean = known.mean(), spread = std::sqrt((known - mean).square().mean());
      one.scale = std::max({one.scale, spread, 1e-3 * std::abs(mean)});
    }
  }

  const ModelSpec& model_;
  const double interval_;
  const SegmentSamples& samples_;
  ModelNumbers numbers_;
};

}  // namespace

StateGuess guessStates(const ModelSpec& model, const std::vector<StartState>& states, double interval,
                       const SegmentSamples& samples) {
  Guesser guesser(model, interval, samples);
  const auto count = static_cast<Index>(states.size());
  StateGuess guess{MatrixXd(count, static_cast<Index>(samples.size())), VectorXd(count)};
  std::vector<OneState> found;
  for (const StartState& state : states) {
    found.push_back(guesser.guess(state));
  }
  for (Index i = 0; i < count; ++i) {
    const OneState& one = found[static_cast<std::size_t>(i)];
    double scale = one.scale;
    for (std::size_t j = 0; j < found.size() && one.scale == 0.0; ++j) {
      const bool alike = found[j].measured && states[j].kind == states[static_cast<std::size_t>(i)].kind;
      scale = alike ? std::max(scale, found[j].scale) : scale;
    }
    guess.states.row(i) = one.values;
    guess.scales[i] = scale > 0.0 ? scale : 1.0;
  }
  return guess;
}

}  // namespace twinmap
