#include <fmt/core.h>

#include <algorithm>
#include <cctype>

#include "framework/base/text/number_text.hpp"
#include "framework/data/measurement/measured_signals.hpp"
#include "framework/diagnosis/candidates/augment.hpp"
#include "framework/diagnosis/candidates/replace_name.hpp"
#include "framework/diagnosis/candidates/term_candidates.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"

namespace twinmap {
namespace {

/// Puts `replacement` in the place of a signal, wherever forces, states and named expressions use it.
void replaceSignal(ModelSpec& model, const std::string& signal, const std::string& replacement) {
  const auto replace = [&](Expression& expression) {
    expression.text = replaceName(expression.text, signal, replacement);
  };
  for (ForceLaw<Expression>& law : model.system.elements.get<ForceLaw>()) {
    replace(law.force);
  }
  for (AppliedForce<Expression>& force : model.system.elements.get<AppliedForce>()) {
    std::for_each(force.force.begin(), force.force.end(), replace);
  }
  for (AppliedMoment<Expression>& moment : model.system.elements.get<AppliedMoment>()) {
    std::for_each(moment.moment.begin(), moment.moment.end(), replace);
  }
  for (StateSpec& state : model.system.states) {
    replace(state.derivative);
  }
  for (NamedExpression& named : model.system.expressions) {
    replace(named.value);
  }
}

/// What acts in a signal's place: a named expression of it, which is the signal itself until terms are added.
NamedExpression& updActing(ModelSpec& model, const std::string& signal) {
  std::vector<NamedExpression>& all = model.system.expressions;
  const std::string name = signal + "_acting";
  const auto known = std::find_if(all.begin(), all.end(), [&](const NamedExpression& one) {
    return one.name.text == name && one.name.where.line == 0;  // not one of the file
  });
  if (known != all.end()) {
    return *known;
  }
  const std::string own = makeParameterName(model, name);
  replaceSignal(model, signal, own);
  return *all.insert(all.begin(), NamedExpression{{own, {}}, {signal, {}}});
}

/// Terms of the signal itself, so that texts grow by each term alone.
void addToSignal(ModelSpec& model, const std::string& signal, const std::string& term) {
  updActing(model, signal).value.text += " + " + term;
}

void delay(Expression& time, const std::string& by) {
  if (!time.text.empty()) {
    time.text = "(" + time.text + ") + " + by;
  }
}

template <class Terms>
void delayEach(Terms& terms, const std::string& by) {
  for (auto& term : terms) {
    delay(term.start, by);
    delay(term.end, by);
  }
}

/// The slope of a table between its times.
TableSpec differentiate(const TableSpec& table) {
  TableSpec slope;
  slope.interpolation = TableInterpolation::kHold;
  slope.times = table.times;
  for (std::size_t i = 0; i + 1 < table.times.size(); ++i) {
    slope.values.push_back((table.values[i + 1] - table.values[i]) / (table.times[i + 1] - table.times[i]));
  }
  slope.values.push_back(0.0);
  return slope;
}

/// Terms move in time, as what was measured does by its clock. A table F of the experiment cannot, so that
/// F - c F' stands for it. This holds for delays below the time in which the signal bends.
void delaySignal(ModelSpec& model, std::size_t index, const std::string& by) {
  SignalSpec& signal = model.excitation[index];
  holdMeasuredEnds(signal, model.simulation.duration, kDelayMargin * model.simulation.duration);
  for (TableSpec& table : signal.tables) {
    if (table.measured) {
      const Expression* delay = table.findDelay();
      table.measured->delay.text = delay != nullptr ? "(" + delay->text + ") - " + by : "-" + by;
    }
  }
  delayEach(signal.pulses, by);
  delayEach(signal.sines, by);
  delayEach(signal.chirps, by);
  delayEach(signal.multisines, by);
  if (std::all_of(signal.tables.begin(), signal.tables.end(),
                  [](const TableSpec& table) { return table.measured.has_value(); })) {
    return;
  }
  SignalSpec slope;
  const std::string name = signal.name.text;
  slope.name = {name + "_slope", {}};
  slope.unit = signal.unit.empty() ? "" : signal.unit + "/s";
  for (const TableSpec& table : signal.tables) {
    if (!table.measured) {
      slope.tables.push_back(differentiate(table));
    }
  }
  addToSignal(model, name, fmt::format("-{}*{}", by, slope.name.text));
  model.excitation.push_back(std::move(slope));
}

bool canBeDelayed(const SignalSpec& signal) {
  for (const TableSpec& table : signal.tables) {
    if (table.interpolation == TableInterpolation::kHold && !table.measured) {
      return false;
    }
  }
  return true;
}

TermCandidate makeGain(const std::string& name) {
  TermCandidate gain;
  gain.term = "gain." + name;
  gain.meaning = fmt::format("signal {}, larger by the factor 1 + c", name);
  gain.size = kLargeShare;
  gain.add = [name](ModelSpec& changed, const std::string& coefficient, const std::vector<std::string>&) {
    addToSignal(changed, name, coefficient + "*" + name);
  };
  return gain;
}

TermCandidate makeDelay(std::size_t index, const std::string& name, double size) {
  TermCandidate late;
  late.term = "delay." + name;
  late.meaning = fmt::format("signal {} later by c, or all outputs earlier by c", name);
  late.unit = "s";
  late.size = size;
  late.add = [index](ModelSpec& changed, const std::string& coefficient, const std::vector<std::string>&) {
    delaySignal(changed, index, coefficient);
  };
  return late;
}

/// The value of a signal's tables at the start; other terms begin at 0.
double calcFirstValue(const SignalSpec& signal) {
  double value = 0.0;
  for (const TableSpec& table : signal.tables) {
    const auto after = std::upper_bound(table.times.begin(), table.times.end(), 0.0);
    if (after != table.times.begin() && after != table.times.end()) {
      value += table.values[static_cast<std::size_t>(after - table.times.begin()) - 1];
    }
  }
  return value;
}

/// A share c of the signal passes a filter of first order, as an amplifier's: all of it where c is 1.
void addLag(const SignalSpec& signal, double shortest, std::vector<TermCandidate>& candidates) {
  const std::string name = signal.name.text;
  TermCandidate lag;
  lag.term = "lag." + name;
  lag.meaning = fmt::format("signal {} through a filter, by the share c", name);
  lag.unit = "1";
  lag.has_states = true;
  lag.own_scales = {{"time constant of the filter", "s"}};
  lag.add = [name, first = toText(calcFirstValue(signal)), unit = signal.unit](
                ModelSpec& changed, const std::string& coefficient, const std::vector<std::string>& scales) {
    updActing(changed, name);  // before there is a state that the signal itself moves
    const std::string state = addState(changed, coefficient + "_lag", first, unit);
    changed.system.states.back().derivative.text = fmt::format("({} - {})/{}", name, state, scales.front());
    addToSignal(changed, name, fmt::format("{}*({} - {})", coefficient, state, name));
  };
  addScanned(lag, shortest, 4.0, 3, candidates);
}

/// What is around 0, or beyond a limit, is missing: all of it where c is 1.
void addLimitsOf(const SignalSpec& signal, const Extent& extent, std::vector<TermCandidate>& candidates) {
  const std::string name = signal.name.text;
  const auto make = [&](const char* kind, const char* meaning, const char* scale) {
    TermCandidate candidate;
    candidate.term = fmt::format("{}.{}", kind, name);
    candidate.meaning = fmt::format("signal {} {}, by the share c", name, meaning);
    candidate.unit = "1";
    candidate.own_scales = {{scale, signal.unit}};
    return candidate;
  };
  TermCandidate dead_zone = make("dead_zone", "without effect around 0", "where it begins to act");
  dead_zone.add = [name](ModelSpec& changed, const std::string& coefficient,
                         const std::vector<std::string>& scales) {
    addToSignal(changed, name,
                fmt::format("{}*({} - {})", coefficient, writeBeyond(name, scales.front()), name));
  };
  dead_zone.own_scales.front().reach = kReachOfLimits;
  addLimits(dead_zone, extent, 0.1, 0.3, 3.0, candidates);
  TermCandidate clipping = make("clipping", "limited on either side", "its limit");
  clipping.add = [name](ModelSpec& changed, const std::string& coefficient,
                        const std::vector<std::string>& scales) {
    addToSignal(changed, name, fmt::format("-{}*{}", coefficient, writeBeyond(name, scales.front())));
  };
  clipping.own_scales.front().reach = kReachOfLimits;
  addLimits(clipping, extent, 0.55, 0.88, 1.6, candidates);
}

/// Of rectangles alone, whatever is around 0 or beyond a limit is a gain.
bool canBeLimited(const SignalSpec& signal) {
  return !signal.tables.empty() || !signal.sines.empty() || !signal.chirps.empty() ||
         !signal.multisines.empty();
}

bool canBeHeld(const SignalSpec& signal) {
  const bool has_tables_alone = !signal.tables.empty() && signal.pulses.empty() && signal.sines.empty() &&
                                signal.chirps.empty() && signal.multisines.empty();
  return has_tables_alone && std::all_of(signal.tables.begin(), signal.tables.end(), [](const TableSpec& t) {
           return t.interpolation != TableInterpolation::kHold;
         });
}

TermCandidate makeHold(std::size_t index, const std::string& name) {
  TermCandidate hold;
  hold.term = "hold." + name;
  hold.meaning = fmt::format("signal {} constant between its samples, by the share c", name);
  hold.unit = "1";
  hold.add = [index, name](ModelSpec& changed, const std::string& coefficient,
                           const std::vector<std::string>&) {
    SignalSpec held = changed.excitation[index];
    held.name.text = name + "_held";
    for (TableSpec& table : held.tables) {
      table.interpolation = TableInterpolation::kHold;
    }
    addToSignal(changed, name, fmt::format("{}*({} - {})", coefficient, held.name.text, name));
    changed.excitation.push_back(std::move(held));
  };
  return hold;
}

}  // namespace

void scaleSignals(ModelSpec& model, double factor) {
  for (const SignalSpec& signal : model.excitation) {
    const std::string& name = signal.name.text;
    replaceSignal(model, name, fmt::format("({}*{})", toText(factor), name));
  }
}

std::vector<TermCandidate> listSignalCandidates(const ModelSpec& model, const ModelSizes& sizes) {
  const double duration = model.simulation.duration;
  std::vector<TermCandidate> candidates;
  for (std::size_t i = 0; i < model.excitation.size(); ++i) {
    const SignalSpec& signal = model.excitation[i];
    if (isFollowed(signal, model)) {
      continue;  // it acts through no expression, and may not stop where a recording ends
    }
    candidates.push_back(makeGain(signal.name.text));
    if (canBeDelayed(signal)) {
      candidates.push_back(makeDelay(i, signal.name.text, kLongDelay * duration));
    }
    addLag(signal, kShortestLag * duration, candidates);
    if (sizes.signals[i].largest > 0.0 && canBeLimited(signal)) {
      addLimitsOf(signal, sizes.signals[i], candidates);
    }
    if (canBeHeld(signal)) {
      candidates.push_back(makeHold(i, signal.name.text));
    }
  }
  return candidates;
}

}  // namespace twinmap
