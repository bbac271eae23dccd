#include <fmt/core.h>

#include <algorithm>

#include "framework/diagnosis/candidates/term_candidates.hpp"
#include "framework/experiment/model/output_units.hpp"

namespace twinmap {
namespace {

/// An output as an expression, and its rate; "" where it has none.
struct OutputText {
  std::string value, rate, second_rate;
  std::string initial{};  ///< its value at the start; "" where that is not known
  std::string unit{};
};

OutputText readOutput(const OutputSpec& output, const ModelSpec& model) {
  const std::string unit = findOutputUnit(output, model.system);
  if (output.coordinate) {
    const std::string& q = output.coordinate->text;
    return {q, q + "_dot", q + "_ddot", findInitial(model.initial.coordinates, q), unit};
  }
  if (output.speed) {
    const std::string& q = output.speed->text;
    return {q + "_dot", q + "_ddot", "", findInitial(model.initial.speeds, q), unit};
  }
  return {output.expression.text.empty() ? "" : "(" + output.expression.text + ")", "", "", "", unit};
}

std::string makeRateUnit(const std::string& unit) {
  return unit.empty() ? "" : unit == "-" || unit == "1" ? "1/s" : "(" + unit + ")/s";
}

/// Adds `term` to what the output measures, before its gain.
void addToOutput(ModelSpec& model, std::size_t index, const std::string& term) {
  OutputSpec& output = model.outputs[index];
  const OutputText text = readOutput(output, model);
  output.coordinate.reset();
  output.speed.reset();
  output.unit = text.unit;
  output.expression = {text.value + " + " + term, {}};
}

void addGainAndOffset(std::size_t index, const std::string& name, const std::string& unit, double size,
                      std::vector<TermCandidate>& candidates) {
  TermCandidate offset;
  offset.term = "offset." + name;
  offset.meaning = fmt::format("offset c of output {}", name);
  offset.unit = unit;
  offset.size = kLargeShare * size;
  offset.add = [index](ModelSpec& changed, const std::string& coefficient, const std::vector<std::string>&) {
    Expression& text = changed.outputs[index].offset;
    text.text = text.text.empty() ? coefficient : "(" + text.text + ") + " + coefficient;
  };
  TermCandidate gain;
  gain.term = "gain." + name;
  gain.meaning = fmt::format("gain of output {}, larger by the factor 1 + c", name);
  gain.size = kLargeShare;
  gain.add = [index](ModelSpec& changed, const std::string& coefficient, const std::vector<std::string>&) {
    Expression& text = changed.outputs[index].gain;
    text.text = (text.text.empty() ? "1" : "(" + text.text + ")*1") + ("*(1 + " + coefficient + ")");
  };
  candidates.push_back(offset);
  candidates.push_back(gain);
}

TermCandidate makeAdded(std::size_t index, const std::string& term, const std::string& meaning,
                        const std::string& unit, double size, const std::string& multiplied) {
  TermCandidate candidate;
  candidate.term = term;
  candidate.meaning = meaning;
  candidate.unit = unit;
  candidate.size = size;
  candidate.add = [index, multiplied](ModelSpec& changed, const std::string& coefficient,
                                      const std::vector<std::string>&) {
    addToOutput(changed, index, coefficient + "*(" + multiplied + ")");
  };
  return candidate;
}

/// By second order, which holds for delays below the time in which the output bends.
TermCandidate makeDelay(std::size_t index, const std::string& name, const OutputText& text, double size) {
  TermCandidate late =
      makeAdded(index, "delay." + name, fmt::format("output {} later by c", name), "s", size, "");
  late.add = [index, text](ModelSpec& changed, const std::string& coefficient,
                           const std::vector<std::string>&) {
    const std::string second =
        text.second_rate.empty() ? "" : fmt::format(" + 0.5*{0}^2*{1}", coefficient, text.second_rate);
    addToOutput(changed, index, fmt::format("(-{}*{}{})", coefficient, text.rate, second));
  };
  return late;
}

/// A share c of the output passes a filter of first order; all of it where c is 1.
void addLag(std::size_t index, const std::string& name, const OutputText& text, double shortest,
            std::vector<TermCandidate>& candidates) {
  TermCandidate lag = makeAdded(
      index, "lag." + name, fmt::format("output {} through a filter, by the share c", name), "1", 1.0, "");
  lag.has_states = true;
  lag.own_scales = {{"time constant of the filter", "s"}};
  lag.add = [index, text](ModelSpec& changed, const std::string& coefficient,
                          const std::vector<std::string>& scales) {
    const std::string state = addState(changed, coefficient + "_lag", text.initial, text.unit);
    changed.system.states.back().derivative.text =
        fmt::format("({} - {})/{}", text.value, state, scales.front());
    addToOutput(changed, index, fmt::format("{}*({} - {})", coefficient, state, text.value));
  };
  addScanned(lag, shortest, 4.0, 3, candidates);
}

/// A sensor that shows nothing beyond a limit, where c is 1.
void addClipping(std::size_t index, const std::string& name, const OutputText& text, const Extent& extent,
                 std::vector<TermCandidate>& candidates) {
  TermCandidate clipping =
      makeAdded(index, "clipping." + name,
                fmt::format("output {} limited on either side, by the share c", name), "1", 1.0, "");
  clipping.own_scales = {{"its limit", text.unit, 0.0, kReachOfLimits}};
  clipping.add = [index, text](ModelSpec& changed, const std::string& coefficient,
                               const std::vector<std::string>& scales) {
    addToOutput(changed, index, fmt::format("-{}*{}", coefficient, writeBeyond(text.value, scales.front())));
  };
  addLimits(clipping, extent, 0.55, 0.88, 1.6, candidates);
}

/// All outputs recorded by a clock that is fast by the share c: a later sample is a still later state.
void addClock(const std::vector<OutputText>& texts, std::vector<TermCandidate>& candidates) {
  const bool have_rates =
      std::all_of(texts.begin(), texts.end(), [](const OutputText& text) { return !text.rate.empty(); });
  if (!have_rates) {
    return;
  }
  TermCandidate clock;
  clock.term = "clock.outputs";
  clock.meaning = "the recorder of the outputs sees time pass faster by the factor 1 + c";
  clock.unit = "1";
  clock.size = kLargeDrift;
  clock.add = [texts](ModelSpec& changed, const std::string& coefficient, const std::vector<std::string>&) {
    for (std::size_t i = 0; i < texts.size(); ++i) {
      addToOutput(changed, i, coefficient + "*t*" + texts[i].rate);
    }
  };
  candidates.push_back(std::move(clock));
}

void addCrossTalk(const ModelSpec& model, const std::vector<OutputText>& texts,
                  std::vector<TermCandidate>& candidates) {
  for (std::size_t to = 0; to < texts.size(); ++to) {
    for (std::size_t from = 0; from < texts.size(); ++from) {
      if (from != to && !texts[to].value.empty() && !texts[from].value.empty() &&
          texts[to].unit == texts[from].unit) {
        const std::string &into = model.outputs[to].name.text, &of = model.outputs[from].name.text;
        candidates.push_back(makeAdded(to, fmt::format("cross_talk.{}.{}", into, of),
                                       fmt::format("cross-talk: c times output {} in output {}", of, into),
                                       "1", kLargeShare, texts[from].value));
      }
    }
  }
}

/// Drift, clipping, delay and lag of an output that is a coordinate, a speed or an expression.
void addOwnErrors(std::size_t index, const ModelSpec& model, const OutputText& text, const Extent& extent,
                  std::vector<TermCandidate>& candidates) {
  const std::string& name = model.outputs[index].name.text;
  const double duration = model.simulation.duration;
  candidates.push_back(makeAdded(index, "drift." + name, fmt::format("drift of output {}, c t", name),
                                 makeRateUnit(text.unit), kLargeShare * extent.largest / duration, "t"));
  addClipping(index, name, text, extent, candidates);
  // of one output alone, a delay is that of all signals
  if (!text.rate.empty() && (model.outputs.size() > 1 || model.excitation.empty())) {
    candidates.push_back(makeDelay(index, name, text, kLongDelay * duration));
  }
  if (!text.initial.empty()) {
    addLag(index, name, text, kShortestLag * duration, candidates);
  }
}

}  // namespace

std::vector<TermCandidate> listOutputCandidates(const ModelSpec& model, const ModelSizes& sizes) {
  std::vector<TermCandidate> candidates;
  std::vector<OutputText> texts;
  for (std::size_t i = 0; i < model.outputs.size(); ++i) {
    texts.push_back(readOutput(model.outputs[i], model));
    if (sizes.outputs[i].largest > 0.0) {
      addGainAndOffset(i, model.outputs[i].name.text, texts[i].unit, sizes.outputs[i].largest, candidates);
      if (!texts[i].value.empty()) {
        addOwnErrors(i, model, texts[i], sizes.outputs[i], candidates);
      }
    }
  }
  addClock(texts, candidates);
  addCrossTalk(model, texts, candidates);
  return candidates;
}

}  // namespace twinmap
