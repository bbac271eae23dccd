#pragma once

#include <array>
#include <string>
#include <vector>

#include "framework/experiment/model/excitation_spec.hpp"
#include "framework/simulation/simulation_failure.hpp"
#include "kernels/lanes/program/real.hpp"

/// The terms of excitation signals at a time since their start, over a scalar S: double, or program::Symbol;
/// and their rates.
namespace twinmap {

inline constexpr double kRadiansPerCycle = 6.283185307179586;

template <class S>
struct PulseShape {
  S value;

  S calc(const S&) const { return value; }
  S calcRate(const S&) const { return 0.0; }
  S calcSecondRate(const S&) const { return 0.0; }
};

/// amplitude * sum of weight * sin(omega * elapsed + phase)
template <class S>
struct ToneShape {
  struct Tone {
    S omega, phase;  ///< rad/s, rad
    S weight = 1.0;
  };
  S amplitude;
  std::vector<Tone> tones;

  S calc(const S& elapsed) const {
    using namespace program::real;
    S sum = 0.0;
    for (const Tone& tone : tones) {
      sum += tone.weight * sin(tone.omega * elapsed + tone.phase);
    }
    return amplitude * sum;
  }
  S calcRate(const S& elapsed) const {
    using namespace program::real;
    S sum = 0.0;
    for (const Tone& tone : tones) {
      sum += tone.weight * tone.omega * cos(tone.omega * elapsed + tone.phase);
    }
    return amplitude * sum;
  }
  S calcSecondRate(const S& elapsed) const {
    using namespace program::real;
    S sum = 0.0;
    for (const Tone& tone : tones) {
      sum -= tone.weight * tone.omega * tone.omega * sin(tone.omega * elapsed + tone.phase);
    }
    return amplitude * sum;
  }
};

/// amplitude * sin(2 pi cycles) after s = elapsed; linear: f0 s + (f1 - f0) s^2 / (2 duration), logarithmic:
/// f0 (exp(rate s) - 1) / rate with rate = log(f1 / f0) / duration.
template <class S>
struct ChirpShape {
  S amplitude, first, last;  ///< frequencies, Hz
  S duration;                ///< s
  SweepKind sweep;

  S calc(const S& elapsed) const {
    using namespace program::real;
    return amplitude * sin(kRadiansPerCycle * calcCycles(elapsed));
  }
  S calcRate(const S& elapsed) const {
    using namespace program::real;
    return amplitude * kRadiansPerCycle * calcFrequency(elapsed) *
           cos(kRadiansPerCycle * calcCycles(elapsed));
  }
  S calcSecondRate(const S& elapsed) const {
    using namespace program::real;
    const S frequency = calcFrequency(elapsed), omega = kRadiansPerCycle * frequency;
    const S growth = sweep == SweepKind::kLogarithmic ? S(frequency * log(last / first) / duration)
                                                      : S((last - first) / duration);
    const S angle = kRadiansPerCycle * calcCycles(elapsed);
    return amplitude * (kRadiansPerCycle * growth * cos(angle) - omega * omega * sin(angle));
  }
  S calcFrequency(const S& elapsed) const {
    using namespace program::real;
    const S rising = first + (last - first) / duration * elapsed;
    return sweep == SweepKind::kLogarithmic ? S(first * exp(log(last / first) / duration * elapsed)) : rising;
  }
  S calcCycles(const S& elapsed) const {
    using namespace program::real;
    S cycles = elapsed * (first + 0.5 * (last - first) / duration * elapsed);
    if (sweep == SweepKind::kLogarithmic) {
      const S rate = log(last / first) / duration, half = 0.5 * rate * elapsed;
      const S growth = 2.0 * sinh(half) * exp(half);  // exp(rate * elapsed) - 1, without cancellation
      cycles = select(notEqual(first, last), first * growth / rate, cycles);
    }
    return cycles;
  }
};

/// Schroeder's phases -pi k (k - 1) / N, k = 1..N, in rad: a low crest factor for equal amplitudes.
std::vector<double> calcSchroederPhases(int count);

/// Evaluates the numbers of one signal's terms. `Numbers` has calc(expression, quantity) and calcPositive(),
/// which may throw SimulationFailure.
template <class S, class Numbers>
class ShapeMaker {
 public:
  ShapeMaker(const SignalSpec& spec, Numbers& numbers)
      : owner_("excitation '" + spec.name.text + "'"), unit_(spec.unit), numbers_(numbers) {}

  S calcTime(const Expression& expression, const char* name) { return calc(expression, name, "s"); }
  const std::string& getOwner() const { return owner_; }

  PulseShape<S> make(const PulseSpec& pulse) { return {calcAmplitude(pulse.amplitude)}; }

  ToneShape<S> make(const SineSpec& sine) {
    const S omega = calcOmega(sine.frequency), phase = calc(sine.phase, "phase", "rad");
    return {calcAmplitude(sine.amplitude), {{omega, phase}}};
  }

  ChirpShape<S> make(const ChirpSpec& chirp) {
    const S duration = calcTime(chirp.end, "end") - calcTime(chirp.start, "start");
    const S first = calcFrequency(chirp.start_frequency), last = calcFrequency(chirp.end_frequency);
    return {calcAmplitude(chirp.amplitude), first, last, duration, chirp.sweep};
  }

  ToneShape<S> make(const MultisineSpec& multisine) {
    const std::size_t count = multisine.frequencies.size();
    const std::vector<double> schroeder = calcSchroederPhases(static_cast<int>(count));
    const bool same = multisine.amplitudes.empty();
    ToneShape<S> shape{same ? calcAmplitude(multisine.amplitude) : S(1.0), {}};
    for (std::size_t k = 0; k < count; ++k) {
      const S omega = calcOmega(multisine.frequencies[k]);
      const S phase = multisine.phases.empty() ? S(schroeder[k]) : calc(multisine.phases[k], "phase", "rad");
      shape.tones.push_back({omega, phase, same ? S(1.0) : calcAmplitude(multisine.amplitudes[k])});
    }
    return shape;
  }

 private:
  S calc(const Expression& expression, const char* name, const char* unit) {
    return numbers_.calc(expression, {owner_, name, unit});
  }
  S calcAmplitude(const Expression& expression) { return calc(expression, "amplitude", unit_.c_str()); }
  S calcFrequency(const Expression& expression) {
    return numbers_.calcPositive(expression, {owner_, "frequency", "Hz"});
  }
  S calcOmega(const Expression& frequency) { return kRadiansPerCycle * calcFrequency(frequency); }

  std::string owner_;
  const std::string& unit_;
  Numbers& numbers_;
};

/// Calls visit() with each term of a signal that is given by expressions: all but its tables.
template <class Visit>
void visitTerms(const SignalSpec& spec, const Visit& visit) {
  const auto visitAll = [&visit](const auto& terms) {
    for (const auto& term : terms) {
      visit(term);
    }
  };
  visitAll(spec.pulses);
  visitAll(spec.sines);
  visitAll(spec.chirps);
  visitAll(spec.multisines);
}

/// A polynomial of a table: values[0] + s (values[1] + s (values[2] + s values[3])) with s = t - begin, for
/// begin <= t < end.
struct TablePiece {
  double begin, end;
  std::array<double, 4> values;
};

/// By increasing begin: of a linear or held table its intervals, of a cubic one those of its spline.
std::vector<TablePiece> calcTablePieces(const TableSpec& table);

}  // namespace twinmap
