#include "framework/simulation/excitation/excitation_terms.hpp"

#include <cmath>
#include <limits>

namespace twinmap {
namespace {

constexpr double kPi = 3.141592653589793;

/// Evaluates the numbers of one signal's terms and appends the terms.
class TermWriter {
 public:
  TermWriter(const SignalSpec& spec, int signal, const TableSplines& splines, NumberEvaluator& numbers,
             std::vector<ExcitationTerm>& terms)
      : owner_("excitation '" + spec.name.text + "'"),
        unit_(spec.unit),
        signal_(signal),
        splines_(splines),
        numbers_(numbers),
        terms_(terms) {}

  void add(const PulseSpec& pulse) {
    append(pulse.start, pulse.end, LineShape{calcAmplitude(pulse.amplitude), 0.0});
  }

  void add(const SineSpec& sine) {
    const ToneShape::Tone tone{2.0 * kPi * calcFrequency(sine.frequency), calc(sine.phase, "phase", "rad"),
                               1.0};
    append(sine.start, sine.end, ToneShape{calcAmplitude(sine.amplitude), {tone}});
  }

  void add(const ChirpSpec& chirp) {
    const double duration = calc(chirp.end, "end", "s") - calc(chirp.start, "start", "s");
    const double first = calcFrequency(chirp.start_frequency);
    const double last = calcFrequency(chirp.end_frequency);
    const bool logarithmic = chirp.sweep == SweepKind::kLogarithmic && first != last;
    const double rate = logarithmic ? std::log(last / first) / duration : (last - first) / duration;
    append(chirp.start, chirp.end, ChirpShape{calcAmplitude(chirp.amplitude), first, rate, logarithmic});
  }

  void add(const MultisineSpec& multisine) {
    const int count = static_cast<int>(multisine.frequencies.size());
    const std::vector<double> phases = multisine.phases.empty()
                                           ? calcSchroederPhases(count)
                                           : numbers_.calcEach(multisine.phases, {owner_, "phase", "rad"});
    const bool same = multisine.amplitudes.empty();
    ToneShape shape{same ? calcAmplitude(multisine.amplitude) : 1.0, {}};
    for (int k = 0; k < count; ++k) {
      const double weight = same ? 1.0 : calcAmplitude(multisine.amplitudes[k]);
      shape.tones.push_back({2.0 * kPi * calcFrequency(multisine.frequencies[k]), phases[k], weight});
    }
    append(multisine.start, multisine.end, std::move(shape));
  }

  void add(const TableSpec& table) {
    if (table.interpolation == TableInterpolation::kCubic) {
      terms_.push_back({signal_, table.times.front(), table.times.back(), SplineShape{&splines_.at(&table)}});
      return;
    }
    for (std::size_t i = 0; i + 1 < table.times.size(); ++i) {
      const double length = table.times[i + 1] - table.times[i];
      const bool hold = table.interpolation == TableInterpolation::kHold;
      const double slope = hold ? 0.0 : (table.values[i + 1] - table.values[i]) / length;
      if (length > 0.0) {
        terms_.push_back({signal_, table.times[i], table.times[i + 1], LineShape{table.values[i], slope}});
      }
    }
  }

 private:
  double calc(const Expression& expression, const char* name, const char* unit) {
    return numbers_.calc(expression, {owner_, name, unit});
  }
  double calcAmplitude(const Expression& expression) { return calc(expression, "amplitude", unit_.c_str()); }
  double calcFrequency(const Expression& expression) {
    return numbers_.calcPositive(expression, {owner_, "frequency", "Hz"});
  }

  double calcEnd(const Expression& expression, double start) {
    if (expression.text.empty()) {
      return std::numeric_limits<double>::infinity();
    }
    const double end = calc(expression, "end", "s");
    if (end <= start) {
      throwUnusable({owner_, "end", "s"}, end, "must be after its start", expression.where);
    }
    return end;
  }

  template <typename Shape>
  void append(const Expression& start, const Expression& end, Shape shape) {
    const double begin = calc(start, "start", "s");
    terms_.push_back({signal_, begin, calcEnd(end, begin), std::move(shape)});
  }

  std::string owner_;
  const std::string& unit_;
  int signal_;
  const TableSplines& splines_;
  NumberEvaluator& numbers_;
  std::vector<ExcitationTerm>& terms_;
};

}  // namespace

void appendTerms(const SignalSpec& spec, int signal, const TableSplines& splines, NumberEvaluator& numbers,
                 std::vector<ExcitationTerm>& terms) {
  TermWriter writer(spec, signal, splines, numbers, terms);
  const auto addAll = [&writer](const auto& specs) {
    for (const auto& term : specs) {
      writer.add(term);
    }
  };
  addAll(spec.pulses);
  addAll(spec.sines);
  addAll(spec.chirps);
  addAll(spec.multisines);
  addAll(spec.tables);
}

std::vector<double> calcSchroederPhases(int count) {
  std::vector<double> phases;
  for (int k = 1; k <= count; ++k) {
    phases.push_back(-kPi * k * (k - 1) / count);
  }
  return phases;
}

}  // namespace twinmap
