#include <fmt/core.h>

#include <algorithm>
#include <cctype>

#include "framework/base/text/number_text.hpp"
#include "framework/diagnosis/term_candidates.hpp"
#include "framework/experiment/expression/output_units.hpp"

namespace twinmap {
namespace {

constexpr double kLargeGain = 0.1;

std::vector<TermCandidate> listOutputCandidates(const ModelSpec& model, const ModelSizes& sizes) {
  std::vector<TermCandidate> candidates;
  for (std::size_t i = 0; i < model.outputs.size(); ++i) {
    const std::string& name = model.outputs[i].name.text;
    TermCandidate offset;
    offset.term = "offset." + name;
    offset.meaning = fmt::format("offset c of output {}", name);
    offset.unit = findOutputUnit(model.outputs[i], model.system);
    offset.size = kLargeGain * sizes.outputs[i];
    offset.add = [i](ModelSpec& changed, const std::string& coefficient, const std::string&) {
      Expression& text = changed.outputs[i].offset;
      text.text = text.text.empty() ? coefficient : "(" + text.text + ") + " + coefficient;
    };
    TermCandidate gain;
    gain.term = "gain." + name;
    gain.meaning = fmt::format("gain of output {}, larger by the factor 1 + c", name);
    gain.size = kLargeGain;
    gain.add = [i](ModelSpec& changed, const std::string& coefficient, const std::string&) {
      Expression& text = changed.outputs[i].gain;
      text.text = (text.text.empty() ? "1" : "(" + text.text + ")*1") + ("*(1 + " + coefficient + ")");
    };
    if (offset.size > 0.0) {
      candidates.push_back(offset);
      candidates.push_back(gain);
    }
  }
  return candidates;
}

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
  slope.measured = table.measured;  // its clock; times and values are those above
  for (std::size_t i = 0; i + 1 < table.times.size(); ++i) {
    slope.values.push_back((table.values[i + 1] - table.values[i]) / (table.times[i + 1] - table.times[i]));
  }
  slope.values.push_back(0.0);
  return slope;
}

/// Terms move in time; a table F cannot, so that F - c F' stands for it, which holds for delays below the
/// time in which the signal bends.
void delaySignal(ModelSpec& model, std::size_t index, const std::string& by) {
  SignalSpec& signal = model.excitation[index];
  delayEach(signal.pulses, by);
  delayEach(signal.sines, by);
  delayEach(signal.chirps, by);
  delayEach(signal.multisines, by);
  if (signal.tables.empty()) {
    return;
  }
  SignalSpec slope;
  const std::string name = signal.name.text;
  slope.name = {name + "_slope", {}};
  slope.unit = signal.unit.empty() ? "" : signal.unit + "/s";
  for (const TableSpec& table : signal.tables) {
    slope.tables.push_back(differentiate(table));
  }
  replaceSignal(model, name, fmt::format("({} - {}*{})", name, by, slope.name.text));
  model.excitation.push_back(std::move(slope));
}

bool canBeDelayed(const SignalSpec& signal) {
  for (const TableSpec& table : signal.tables) {
    if (table.interpolation == TableInterpolation::kHold) {
      return false;
    }
  }
  return true;
}

std::vector<TermCandidate> listExcitationCandidates(const ModelSpec& model) {
  constexpr double kLongDelay = 0.005;  // of the duration
  std::vector<TermCandidate> candidates;
  for (std::size_t i = 0; i < model.excitation.size(); ++i) {
    const std::string& name = model.excitation[i].name.text;
    TermCandidate gain;
    gain.term = "gain." + name;
    gain.meaning = fmt::format("signal {}, larger by the factor 1 + c", name);
    gain.size = kLargeGain;
    gain.add = [name](ModelSpec& changed, const std::string& coefficient, const std::string&) {
      replaceSignal(changed, name, fmt::format("({0} + {1}*{0})", name, coefficient));
    };
    candidates.push_back(gain);
    if (canBeDelayed(model.excitation[i])) {
      TermCandidate late;
      late.term = "delay." + name;
      late.meaning = fmt::format("signal {} later by c, or all outputs earlier by c", name);
      late.unit = "s";
      late.size = kLongDelay * model.simulation.duration;
      late.add = [i](ModelSpec& changed, const std::string& coefficient, const std::string&) {
        delaySignal(changed, i, coefficient);
      };
      candidates.push_back(late);
    }
  }
  return candidates;
}

}  // namespace

void scaleSignals(ModelSpec& model, double factor) {
  for (const SignalSpec& signal : model.excitation) {
    const std::string& name = signal.name.text;
    replaceSignal(model, name, fmt::format("({}*{})", toText(factor), name));
  }
}

std::string replaceName(const std::string& text, const std::string& name, const std::string& replacement) {
  const auto is_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  std::string replaced;
  for (std::size_t at = 0; at < text.size();) {
    const bool begins = at == 0 || !(is_word(text[at - 1]) || text[at - 1] == '.');
    const std::size_t end = at + name.size();
    if (begins && text.compare(at, name.size(), name) == 0 && (end >= text.size() || !is_word(text[end]))) {
      replaced += replacement;
      at = end;
    } else {
      replaced += text[at++];
    }
  }
  return replaced;
}

std::vector<TermCandidate> listSignalCandidates(const ModelSpec& model, const ModelSizes& sizes) {
  std::vector<TermCandidate> candidates = listOutputCandidates(model, sizes);
  const std::vector<TermCandidate> excitation = listExcitationCandidates(model);
  candidates.insert(candidates.end(), excitation.begin(), excitation.end());
  return candidates;
}

std::vector<TermCandidate> listCandidates(const ModelSpec& model, const ModelSizes& sizes) {
  std::vector<TermCandidate> candidates = listForceCandidates(sizes);
  for (const std::vector<TermCandidate>& more :
       {listBodyCandidates(model, sizes), listSignalCandidates(model, sizes)}) {
    candidates.insert(candidates.end(), more.begin(), more.end());
  }
  return candidates;
}

}  // namespace twinmap
