#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/diagnosis/candidates/term_candidates.hpp"

namespace twinmap {
namespace {

/// A force -c z whose state z, between -1 and 1, follows dz/dt = `rate`: "{v}" is the speed, "{z}" the state,
/// "{s}" the displacement before it slips, "{r}" a second scale.
struct StickingTerm {
  const char* kind;
  const char* meaning;
  const char* rate;
  bool has_second_scale = false;
};

constexpr StickingTerm kStickingTerms[] = {
    // Dahl 1968
    {"presliding", "friction that is a spring before it slips (Dahl)", "({v} - abs({v})*{z})/{s}"},
    // LuGre, with a level at rest half as large again
    {"lugre", "friction that sticks, and falls as it slides (LuGre)",
     "({v} - abs({v})*{z}/(1 + 0.5*exp(-({v}/{r})^2)))/{s}", true},
    // Bouc-Wen with beta = gamma = 1/2, exponent 1
    {"hysteresis", "a spring that yields (Bouc-Wen)", "({v} - 0.5*(abs({v})*{z} + {v}*abs({z})))/{s}"},
};

/// The rate of a sticking term on a coordinate.
std::string fillRate(const char* rate, const std::string& coordinate, const std::string& state,
                     const std::vector<std::string>& scales) {
  std::string text = rate;
  const auto fill = [&text](const std::string& place, const std::string& by) {
    for (std::size_t at = text.find(place); at != std::string::npos; at = text.find(place, at + by.size())) {
      text.replace(at, place.size(), by);
    }
  };
  fill("{v}", coordinate + "_dot");
  fill("{z}", state);
  fill("{s}", scales[0]);
  fill("{r}", scales.size() > 1 ? scales[1] : "");
  return text;
}

void addSticking(const StickingTerm& term, const CoordinateSizes& coordinate,
                 std::vector<TermCandidate>& candidates) {
  constexpr double kFirst = 0.02, kFactor = 5.0;  // of the largest displacement
  constexpr int kCount = 3;
  constexpr double kStribeckSpeed = 0.1;  // of the largest speed
  const std::string name = coordinate.name;
  TermCandidate candidate;
  candidate.term = fmt::format("{}.{}", term.kind, name);
  candidate.meaning = fmt::format("{}: force up to c on {}", term.meaning, name);
  candidate.unit = coordinate.is_angle ? "N m" : "N";
  candidate.size = coordinate.force;
  candidate.dissipates = true;
  candidate.has_states = true;
  candidate.own_scales = {{"displacement before it slips", getLength(coordinate)}};
  candidate.own_scales.front().has_limit = true;
  if (term.has_second_scale) {
    candidate.own_scales.push_back({"speed over which it falls by a third", getLength(coordinate) + "/s",
                                    kStribeckSpeed * coordinate.speed});
  }
  candidate.add = [rate = term.rate, name](ModelSpec& model, const std::string& coefficient,
                                           const std::vector<std::string>& scales) {
    const std::string state = addState(model, coefficient + "_z", "0", "1");
    model.system.states.back().derivative.text = fillRate(rate, name, state, scales);
    addForceLaw(model, name, "-" + coefficient + "*" + state);
  };
  addScanned(candidate, kFirst * coordinate.reach, kFactor, kCount, candidates);
}

/// A mass on a spring and a damper that the coordinate carries; for an angle a flywheel.
void addHiddenMode(const ModelSpec& model, const CoordinateSizes& coordinate, double inertia,
                   std::vector<TermCandidate>& candidates) {
  // about the frequency at which the coordinate moves, in steps of a third: a mode is about as wide there
  // as it answers, and the fit finds the rest
  constexpr double kFirst = 0.4, kFactor = 1.35, kRatio = 0.05;
  constexpr int kCount = 12;
  const std::string q = coordinate.name, v = q + "_dot";
  const std::string q0 = findInitial(model.initial.coordinates, q), v0 = findInitial(model.initial.speeds, q);
  const std::string length = getLength(coordinate);
  TermCandidate candidate;
  candidate.term = "hidden_mode." + q;
  candidate.meaning = fmt::format("a {} c that {} carries on a spring",
                                  coordinate.is_angle ? "moment of inertia" : "mass", q);
  candidate.unit = coordinate.is_angle ? "kg m2" : "kg";
  candidate.size = kLargeShare * inertia;
  candidate.has_states = true;
  candidate.own_scales = {{"its frequency", "Hz", 0.0, 1.5}, {"its damping ratio", "1", kRatio, 10.0}};
  candidate.add = [q, v, q0, v0, length](ModelSpec& changed, const std::string& coefficient,
                                         const std::vector<std::string>& scales) {
    const std::string at = addState(changed, coefficient + "_q", q0, length);
    const std::size_t first = changed.system.states.size() - 1;
    const std::string omega = fmt::format("(2*pi*{})", scales[0]);
    const std::string speed = addState(changed, coefficient + "_v", v0, length + "/s");
    const std::string pull =
        fmt::format("{0}*({0}*({1} - {2}) + 2*{3}*({4} - {5}))", omega, at, q, scales[1], speed, v);
    changed.system.states[first].derivative.text = speed;
    changed.system.states[first + 1].derivative.text = "-(" + pull + ")";
    addForceLaw(changed, q, coefficient + "*" + pull);
  };
  const double typical = coordinate.speed / (2.0 * M_PI * coordinate.reach);  // Hz
  addScanned(candidate, kFirst * typical, kFactor, kCount, candidates);
}

}  // namespace

std::vector<TermCandidate> listMemoryCandidates(const ModelSpec& model, const ModelSizes& sizes) {
  std::vector<TermCandidate> candidates;
  for (const CoordinateSizes& coordinate : sizes.coordinates) {
    for (const StickingTerm& term : kStickingTerms) {
      addSticking(term, coordinate, candidates);
    }
    addHiddenMode(model, coordinate, coordinate.is_angle ? sizes.moment : sizes.mass, candidates);
  }
  return candidates;
}

}  // namespace twinmap
