#include "framework/models/mechanism/lanes/recorded_excitation.hpp"

#include <algorithm>

#include "framework/simulation/excitation/cubic_spline.hpp"
#include "framework/simulation/excitation/excitation_terms.hpp"

namespace twinmap {
namespace {

using equations::NamedValues;
using program::Symbol;
using Piece = RecordedExcitation::Piece;

constexpr double kTwoPi = 6.283185307179586;

std::vector<Piece> calcSplinePieces(const TableSpec& table) {
  const CubicSpline spline(table.times, table.values);
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < spline.getSegments().size(); ++i) {
    const CubicSpline::Segment& segment = spline.getSegments()[i];
    pieces.push_back({table.times[i],
                      table.times[i + 1],
                      {segment.value, segment.slope, segment.curvature, segment.third}});
  }
  return pieces;
}

std::vector<Piece> calcLinearPieces(const TableSpec& table) {
  const bool hold = table.interpolation == TableInterpolation::kHold;
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i + 1 < table.times.size(); ++i) {
    const double length = table.times[i + 1] - table.times[i];
    if (length > 0.0) {  // a time given twice is a jump
      const double slope = hold ? 0.0 : (table.values[i + 1] - table.values[i]) / length;
      pieces.push_back({table.times[i], table.times[i + 1], {table.values[i], slope, 0.0, 0.0}});
    }
  }
  return pieces;
}

int getDegree(TableInterpolation interpolation) {
  switch (interpolation) {
    case TableInterpolation::kHold:
      return 0;
    case TableInterpolation::kLinear:
      return 1;
    default:
      return 3;
  }
}

/// Appends the terms of one signal after the other; as appendTerms does for numbers.
class ExcitationRecorder {
 public:
  ExcitationRecorder(program::Recorder& recorder, const NamedValues<Symbol>& names)
      : recorder_(recorder), names_(names) {}

  void add(const SignalSpec& spec) {
    signal_ = Symbol(0.0);
    const auto addAll = [this](const auto& specs) {
      for (const auto& term : specs) {
        addTerm(term);
      }
    };
    addAll(spec.pulses);
    addAll(spec.sines);
    addAll(spec.chirps);
    addAll(spec.multisines);
    addAll(spec.tables);
    excitation_.signals.push_back(signal_);
  }

  RecordedExcitation finish() { return std::move(excitation_); }

 private:
  void addTerm(const PulseSpec& pulse) { switchOn(pulse.start, pulse.end, names_.calc(pulse.amplitude)); }

  void addTerm(const SineSpec& sine) {
    const Symbol elapsed = recorder_.time() - names_.calc(sine.start);
    const Symbol angle = kTwoPi * names_.calc(sine.frequency) * elapsed + names_.calc(sine.phase);
    switchOn(sine.start, sine.end, names_.calc(sine.amplitude) * sin(angle));
  }

  void addTerm(const ChirpSpec& chirp) {
    const Symbol start = names_.calc(chirp.start), duration = names_.calc(chirp.end) - start;
    const Symbol first = names_.calc(chirp.start_frequency), last = names_.calc(chirp.end_frequency);
    const Symbol elapsed = recorder_.time() - start;
    Symbol cycles = elapsed * (first + 0.5 * (last - first) / duration * elapsed);
    if (chirp.sweep == SweepKind::kLogarithmic) {
      const Symbol rate = log(last / first) / duration, half = 0.5 * rate * elapsed;
      const Symbol growth = 2.0 * sinh(half) * exp(half);  // exp(rate * elapsed) - 1, without cancellation
      cycles = select(notEqual(first, last), first * growth / rate, cycles);
    }
    switchOn(chirp.start, chirp.end, names_.calc(chirp.amplitude) * sin(kTwoPi * cycles));
  }

  void addTerm(const MultisineSpec& multisine) {
    const std::vector<Symbol> frequencies = names_.calcEach(multisine.frequencies);
    std::vector<Symbol> phases = names_.calcEach(multisine.phases);
    if (phases.empty()) {
      const std::vector<double> schroeder = calcSchroederPhases(static_cast<int>(frequencies.size()));
      phases.assign(schroeder.begin(), schroeder.end());
    }
    const std::vector<Symbol> amplitudes = names_.calcEach(multisine.amplitudes);
    const Symbol elapsed = recorder_.time() - names_.calc(multisine.start);
    Symbol sum = 0.0;
    for (std::size_t k = 0; k < frequencies.size(); ++k) {
      const Symbol tone = sin(kTwoPi * frequencies[k] * elapsed + phases[k]);
      sum += amplitudes.empty() ? tone : amplitudes[k] * tone;
    }
    switchOn(multisine.start, multisine.end,
             amplitudes.empty() ? names_.calc(multisine.amplitude) * sum : sum);
  }

  void addTerm(const TableSpec& table) {
    const bool cubic = table.interpolation == TableInterpolation::kCubic;
    const int degree = getDegree(table.interpolation), first = excitation_.input_count;
    excitation_.tables.push_back({first, degree, cubic ? calcSplinePieces(table) : calcLinearPieces(table)});
    excitation_.input_count += degree + 2;
    const Symbol elapsed = recorder_.time() - recorder_.phaseInput(first);
    Symbol value = recorder_.phaseInput(first + 1 + degree);
    for (int k = degree; k > 0; --k) {
      value = recorder_.phaseInput(first + k) + elapsed * value;
    }
    signal_ += value;
  }

  /// Adds `value` for start <= t < end; what it is outside may be anything.
  void switchOn(const Expression& start, const Expression& end, Symbol value) {
    const int flag = excitation_.input_count++;
    const int begin_event = addEvent(start);
    const int end_event = end.text.empty() ? -1 : addEvent(end);
    excitation_.terms.push_back({flag, begin_event, end_event});
    signal_ += select(recorder_.phaseInput(flag), value, 0.0);
  }

  int addEvent(const Expression& time) {
    excitation_.events.push_back(names_.calc(time));
    return static_cast<int>(excitation_.events.size()) - 1;
  }

  program::Recorder& recorder_;
  const NamedValues<Symbol>& names_;
  RecordedExcitation excitation_;
  Symbol signal_;
};

void fillTable(const RecordedExcitation::Table& table, double begin, double* inputs) {
  double* const own = inputs + table.first_input;
  std::fill_n(own, table.degree + 2, 0.0);
  const auto after = std::upper_bound(table.pieces.begin(), table.pieces.end(), begin,
                                      [](double t, const Piece& piece) { return t < piece.begin; });
  if (after != table.pieces.begin() && begin < (after - 1)->end) {
    own[0] = (after - 1)->begin;
    std::copy_n((after - 1)->values.begin(), table.degree + 1, own + 1);
  }
}

}  // namespace

RecordedExcitation recordExcitation(const std::vector<SignalSpec>& signals, program::Recorder& recorder,
                                    const NamedValues<Symbol>& names) {
  ExcitationRecorder excitation(recorder, names);
  for (const SignalSpec& signal : signals) {
    excitation.add(signal);
  }
  return excitation.finish();
}

std::vector<Boundary> calcBoundaries(const RecordedExcitation& excitation, const std::vector<double>& events,
                                     double duration) {
  std::vector<Boundary> boundaries;
  const auto add = [&](double time, int event) {
    if (time > 0.0 && time < duration) {
      boundaries.push_back({time, event});
    }
  };
  for (std::size_t i = 0; i < events.size(); ++i) {
    add(events[i], static_cast<int>(i));
  }
  for (const RecordedExcitation::Table& table : excitation.tables) {
    for (const Piece& piece : table.pieces) {
      add(piece.begin, -1);
      add(piece.end, -1);
    }
  }
  boundaries.push_back({0.0, -1});
  boundaries.push_back({duration, -1});
  std::stable_sort(boundaries.begin(), boundaries.end(),
                   [](const Boundary& a, const Boundary& b) { return a.time < b.time; });
  const auto same = [](const Boundary& a, const Boundary& b) { return a.time == b.time; };
  boundaries.erase(std::unique(boundaries.begin(), boundaries.end(), same), boundaries.end());
  return boundaries;
}

void fillPhaseInputs(const RecordedExcitation& excitation, const std::vector<double>& events, double begin,
                     double* inputs) {
  for (const RecordedExcitation::Term& term : excitation.terms) {
    const bool on = events[term.begin] <= begin && (term.end < 0 || begin < events[term.end]);
    inputs[term.flag] = on ? 1.0 : 0.0;
  }
  for (const RecordedExcitation::Table& table : excitation.tables) {
    fillTable(table, begin, inputs);
  }
}

}  // namespace twinmap
