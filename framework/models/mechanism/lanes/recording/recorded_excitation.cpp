#include "framework/models/mechanism/lanes/recording/recorded_excitation.hpp"

#include <algorithm>

#include "framework/simulation/excitation/excitation_terms.hpp"

namespace twinmap {
namespace {

using program::Symbol;

/// What ShapeMaker evaluates; whether a value can be used is not known before it is computed.
struct RecordedNumbers {
  const NamedValues<Symbol>& names;

  Symbol calc(const Expression& expression, const Quantity&) const { return names.calc(expression); }
  Symbol calcPositive(const Expression& expression, const Quantity&) const { return names.calc(expression); }
};

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

/// Appends the terms of one signal after the other.
class ExcitationRecorder {
 public:
  ExcitationRecorder(program::Recorder& recorder, const NamedValues<Symbol>& names, bool has_origin)
      : recorder_(recorder), numbers_{names} {
    excitation_.clock = recorder_.time();
    if (has_origin) {
      excitation_.origin_input = excitation_.input_count++;
      excitation_.clock = excitation_.clock + recorder_.phaseInput(excitation_.origin_input);
    }
  }

  void add(const SignalSpec& spec) {
    signal_ = Symbol(0.0);
    Shapes shapes(spec, numbers_);
    visitTerms(spec, [&](const auto& term) { switchOn(term.start, term.end, calcTerm(term, shapes)); });
    for (const TableSpec& table : spec.tables) {
      addTable(table);
    }
    excitation_.signals.push_back(signal_);
  }

  RecordedExcitation finish() { return std::move(excitation_); }

 private:
  using Shapes = ShapeMaker<Symbol, const RecordedNumbers>;

  Symbol calcTerm(const PulseSpec& pulse, Shapes& shapes) const { return shapes.make(pulse).value; }
  template <class Term>
  Symbol calcTerm(const Term& term, Shapes& shapes) const {
    const Symbol elapsed = excitation_.clock - shapes.calcTime(term.start, "start");
    return shapes.make(term).calc(elapsed);
  }

  void addTable(const TableSpec& table) {
    const int degree = getDegree(table.interpolation), first = excitation_.input_count;
    excitation_.tables.push_back({first, degree, calcTablePieces(table)});
    excitation_.input_count += degree + 2;
    Symbol clock = excitation_.clock;
    if (const Expression* delay = table.findDelay()) {
      const Symbol late = numbers_.names.calc(*delay);
      clock = clock + late;
      excitation_.tables.back().zero = addEvent(-late);
    }
    const Symbol elapsed = clock - recorder_.phaseInput(first);
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

  int addEvent(const Expression& time) { return addEvent(numbers_.names.calc(time)); }
  int addEvent(const Symbol& time) {
    excitation_.events.push_back(time);
    return static_cast<int>(excitation_.events.size()) - 1;
  }

  program::Recorder& recorder_;
  const RecordedNumbers numbers_;
  RecordedExcitation excitation_;
  Symbol signal_;
};

/// Times are compared as calcBoundaries() computes them, so that a phase begins within its own piece.
void fillTable(const RecordedExcitation::Table& table, double zero, double begin, double* inputs) {
  double* const own = inputs + table.first_input;
  std::fill_n(own, table.degree + 2, 0.0);
  const auto after =
      std::upper_bound(table.pieces.begin(), table.pieces.end(), begin,
                       [&](double t, const TablePiece& piece) { return t < zero + piece.begin; });
  if (after != table.pieces.begin() && begin < zero + (after - 1)->end) {
    own[0] = (after - 1)->begin;
    std::copy_n((after - 1)->values.begin(), table.degree + 1, own + 1);
  }
}

}  // namespace

RecordedExcitation recordExcitation(const std::vector<SignalSpec>& signals, program::Recorder& recorder,
                                    const NamedValues<Symbol>& names, bool has_origin) {
  ExcitationRecorder excitation(recorder, names, has_origin);
  for (const SignalSpec& signal : signals) {
    excitation.add(signal);
  }
  return excitation.finish();
}

std::vector<Boundary> calcBoundaries(const RecordedExcitation& excitation, const std::vector<double>& events,
                                     double first, double last) {
  std::vector<Boundary> boundaries;
  const auto add = [&](double time, int event) {
    if (time > first && time < last) {
      boundaries.push_back({time, event});
    }
  };
  for (std::size_t i = 0; i < events.size(); ++i) {
    add(events[i], static_cast<int>(i));
  }
  for (const RecordedExcitation::Table& table : excitation.tables) {
    const double zero = table.getZero(events);
    const auto within =
        std::partition_point(table.pieces.begin(), table.pieces.end(),
                             [&](const TablePiece& piece) { return !(zero + piece.end > first); });
    for (auto piece = within; piece != table.pieces.end() && zero + piece->begin < last; ++piece) {
      add(zero + piece->begin, table.zero);
      add(zero + piece->end, table.zero);
    }
  }
  boundaries.push_back({first, -1});
  boundaries.push_back({last, -1});
  std::stable_sort(boundaries.begin(), boundaries.end(),
                   [](const Boundary& a, const Boundary& b) { return a.time < b.time; });
  const auto same = [](const Boundary& a, const Boundary& b) { return a.time == b.time; };
  boundaries.erase(std::unique(boundaries.begin(), boundaries.end(), same), boundaries.end());
  return boundaries;
}

void fillPhaseInputs(const RecordedExcitation& excitation, const std::vector<double>& events, double begin,
                     double* inputs, double origin) {
  if (excitation.origin_input >= 0) {
    inputs[excitation.origin_input] = origin;
  }
  for (const RecordedExcitation::Term& term : excitation.terms) {
    const bool on = events[term.begin] <= begin && (term.end < 0 || begin < events[term.end]);
    inputs[term.flag] = on ? 1.0 : 0.0;
  }
  for (const RecordedExcitation::Table& table : excitation.tables) {
    fillTable(table, table.getZero(events), begin, inputs);
  }
}

}  // namespace twinmap
