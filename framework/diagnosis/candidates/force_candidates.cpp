#include <fmt/core.h>

#include <cmath>

#include "framework/diagnosis/candidates/term_candidates.hpp"

namespace twinmap {
namespace {

/// A force law on a coordinate: "{c}" is the coefficient, "{q}" the coordinate, "{v}" its speed, "{s}" the
/// own scale. The coefficient's unit is N or N m over (m or rad)^length s^time.
struct ForceTerm {
  const char* kind;
  const char* noun;
  const char* law;
  int length, time;
  bool dissipates = false;
};

/// Terms without a scale of their own.
constexpr ForceTerm kForceTerms[] = {
    {"damping", "linear damping", "-{c}*{v}", 1, -1, true},
    {"drag", "drag, which grows with the square of speed", "-{c}*abs({v})*{v}", 2, -2, true},
    {"cubic_damping", "damping that grows with the cube of speed", "-{c}*{v}^3", 3, -3, true},
    {"position_damping", "damping that grows with the square of position", "-{c}*{q}^2*{v}", 3, -1, true},
    {"spring", "linear spring", "-{c}*{q}", 1, 0},
    {"asymmetric_spring", "spring of unequal sides", "-{c}*{q}^2", 2, 0},
    {"quadratic_spring", "spring that grows with the square of position", "-{c}*abs({q})*{q}", 2, 0},
    {"cubic_spring", "cubic spring", "-{c}*{q}^3", 3, 0},
    {"quintic_spring", "fifth-order spring", "-{c}*{q}^5", 5, 0},
    {"constant_force", "constant force", "{c}", 0, 0},
};

/// Terms whose scale is scanned, in fractions of the largest speed or position.
struct ScannedTerm {
  ForceTerm term;
  const char* scale_meaning;
  bool scale_is_speed;
  double first, factor;
  int count;
  bool has_limit = false;
};

constexpr ScannedTerm kScannedTerms[] = {
    {{"coulomb", "dry friction", "-{c}*tanh({v}/{s})", 0, 0, true},
     "speed at which friction sets in",
     true,
     0.01,
     4.0,
     3,
     true},
    {{"stribeck", "friction at low speed alone", "-{c}*tanh(10*{v}/{s})*exp(-({v}/{s})^2)", 0, 0, true},
     "speed at which it has fallen to a third",
     true,
     0.05,
     3.0,
     3},
    {{"stop", "spring beyond a play", "-{c}*(max({q} - {s}, 0) + min({q} + {s}, 0))", 1, 0},
     "play on either side",
     false,
     0.3,
     1.7,
     3},
};

std::string replaceAll(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// "N s2/m2", "N m s2/rad2"
std::string makeUnit(const ForceTerm& term, bool is_angle) {
  std::string unit = is_angle ? "N m" : "N";
  const auto power = [](const char* base, int exponent) {
    return exponent == 1 ? std::string(base) : base + std::to_string(exponent);
  };
  if (term.time < 0) {
    unit += " " + power("s", -term.time);
  }
  if (term.length > 0) {
    unit += "/" + power(is_angle ? "rad" : "m", term.length);
  }
  return unit;
}

std::string makeLaw(const ForceTerm& term, const std::string& coordinate, const std::string& coefficient,
                    const std::string& scale) {
  std::string law = replaceAll(term.law, "{q}", coordinate);
  law = replaceAll(law, "{v}", coordinate + "_dot");
  law = replaceAll(law, "{s}", scale);
  return replaceAll(law, "{c}", coefficient);
}

TermCandidate makeForceCandidate(const ForceTerm& term, const CoordinateSizes& coordinate) {
  const std::string name = coordinate.name;
  TermCandidate candidate;
  candidate.term = fmt::format("{}.{}", term.kind, name);
  candidate.meaning = fmt::format("{}: force {} on {}", term.noun, makeLaw(term, name, "c", "s"), name);
  candidate.dissipates = term.dissipates;
  candidate.unit = makeUnit(term, coordinate.is_angle);
  const int position = term.length + term.time;  // powers that are not of speed are of position
  candidate.size = coordinate.force / (std::pow(coordinate.speed, -term.time) *
                                       std::pow(coordinate.reach, static_cast<double>(position)));
  candidate.add = [term, name](ModelSpec& model, const std::string& coefficient,
                               const std::vector<std::string>& scales) {
    addForceLaw(model, name, makeLaw(term, name, coefficient, scales.empty() ? "" : scales.front()));
  };
  return candidate;
}

void addScannedForce(const ScannedTerm& scanned, const CoordinateSizes& coordinate,
                     std::vector<TermCandidate>& candidates) {
  TermCandidate candidate = makeForceCandidate(scanned.term, coordinate);
  const std::string length = getLength(coordinate);
  candidate.own_scales = {{scanned.scale_meaning, scanned.scale_is_speed ? length + "/s" : length}};
  candidate.own_scales.front().has_limit = scanned.has_limit;
  addScanned(candidate, scanned.first * (scanned.scale_is_speed ? coordinate.speed : coordinate.reach),
             scanned.factor, scanned.count, candidates);
}

/// A spring or damper between two coordinates: the force of one on the other and back.
TermCandidate makeCoupling(const CoordinateSizes& a, const CoordinateSizes& b, bool damper) {
  const std::string suffix = damper ? "_dot" : "";
  TermCandidate candidate;
  candidate.term = fmt::format("coupling_{}.{}.{}", damper ? "damping" : "spring", a.name, b.name);
  candidate.meaning =
      fmt::format("{} between coordinates: force -c*{} on {}, -c*{} on {}", damper ? "damping" : "spring",
                  b.name + suffix, a.name, a.name + suffix, b.name);
  candidate.unit = makeUnit({"", "", "", 1, damper ? -1 : 0}, a.is_angle);
  candidate.size = std::sqrt(a.force * b.force / (damper ? a.speed * b.speed : a.reach * b.reach));
  candidate.add = [first = a.name, second = b.name, suffix](ModelSpec& model, const std::string& coefficient,
                                                            const std::vector<std::string>&) {
    addForceLaw(model, first, "-" + coefficient + "*" + second + suffix);
    addForceLaw(model, second, "-" + coefficient + "*" + first + suffix);
  };
  return candidate;
}

}  // namespace

std::vector<TermCandidate> listForceCandidates(const ModelSizes& sizes) {
  std::vector<TermCandidate> candidates;
  for (const CoordinateSizes& coordinate : sizes.coordinates) {
    for (const ForceTerm& term : kForceTerms) {
      candidates.push_back(makeForceCandidate(term, coordinate));
    }
    for (const ScannedTerm& scanned : kScannedTerms) {
      addScannedForce(scanned, coordinate, candidates);
    }
  }
  for (std::size_t a = 0; a < sizes.coordinates.size(); ++a) {
    for (std::size_t b = a + 1; b < sizes.coordinates.size(); ++b) {
      const CoordinateSizes &first = sizes.coordinates[a], &second = sizes.coordinates[b];
      if (first.is_angle == second.is_angle) {
        candidates.push_back(makeCoupling(first, second, false));
        candidates.push_back(makeCoupling(first, second, true));
      }
    }
  }
  return candidates;
}

}  // namespace twinmap
