#include <fmt/core.h>

#include <algorithm>

#include "framework/diagnosis/candidates/term_candidates.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"

namespace twinmap {
namespace {

using Element = Friction<Expression>;

/// Friction of the model as expressions: the speed v at which it slides, Fc, and Fc + (Fs - Fc) exp(-(|v| /
/// speed)^exponent).
struct WrittenFriction {
  std::string slip, coulomb, level;
};

WrittenFriction write(const Element& own) {
  std::string slip = own.coordinate.text + "_dot";
  slip += own.against ? fmt::format(" - {}_dot", own.against->text) : "";
  slip += own.surface_speed ? fmt::format(" - ({})", own.surface_speed->text) : "";
  WrittenFriction written{"(" + slip + ")", "(" + own.coulomb.text + ")", ""};
  written.level = own.stribeck ? fmt::format("({0} + (({1}) - {0})*exp(-(abs({2})/({3}))^({4})))",
                                             written.coulomb, own.stribeck->level.text, written.slip,
                                             own.stribeck->speed.text, own.stribeck->exponent.text)
                               : written.coulomb;
  return written;
}

/// Leaves the share 1 - c of the model's own element; what it holds in its bristle falls with its levels.
void leaveRest(const std::string& share, Element& own) {
  const auto scale = [&](Expression& number) {
    number.text = fmt::format("(1 - {})*({})", share, number.text);
  };
  scale(own.coulomb);
  if (own.stribeck) {
    scale(own.stribeck->level);
  }
  if (own.bristle) {
    scale(own.bristle->stiffness);
    if (!own.bristle->damping.text.empty()) {
      scale(own.bristle->damping);
    }
  }
}

void addBetween(const Element& own, const std::string& force, ModelSpec& model) {
  addForceLaw(model, own.coordinate.text, "-" + force);
  if (own.against) {
    addForceLaw(model, own.against->text, force);
  }
}

/// Another law in the place of an element's.
struct Relative {
  const char *kind, *meaning, *scale;
  bool sticks;           ///< whether it has a state, and its scale is a displacement, not a speed
  double first, factor;  ///< of the largest displacement or speed
};

constexpr int kScales = 4;

constexpr Relative kRelatives[] = {
    {"regularised_law", "friction that sets in over a speed, and creeps,", "speed at which it sets in", false,
     0.002, 5.0},
    {"bristle_law", "friction on bristles (LuGre)", "displacement before it slips", true, 0.002, 5.0},
};

AddTerm makeAdd(const Relative& relative, std::size_t element) {
  return [sticks = relative.sticks, element](ModelSpec& model, const std::string& share,
                                             const std::vector<std::string>& scales) {
    const Element own = model.system.elements.get<Friction>()[element];
    const WrittenFriction written = write(own);
    leaveRest(share, model.system.elements.get<Friction>()[element]);
    if (!sticks) {
      addBetween(own, fmt::format("{}*{}*tanh({}/{})", share, written.level, written.slip, scales.front()),
                 model);
      return;
    }
    const std::string state = addState(model, share + "_z", "0", "1");
    model.system.states.back().derivative.text =
        fmt::format("({0} - abs({0})*{1}*{2}/{3})/{4}", written.slip, state, written.coulomb, written.level,
                    scales.front());
    addBetween(own, fmt::format("{}*{}*{}", share, written.coulomb, state), model);
  };
}

void addRelative(const Relative& relative, std::size_t element, const Element& own,
                 const CoordinateSizes& sizes, std::vector<TermCandidate>& candidates) {
  const std::string place = fmt::format("friction[{}]", element);
  const std::string length = getLength(sizes);
  TermCandidate candidate;
  candidate.term = fmt::format("{}.{}", relative.kind, own.coordinate.text);
  candidate.meaning =
      fmt::format("{} in the place of {} on {}", relative.meaning, place, own.coordinate.text);
  candidate.unit = "1";
  candidate.size = 1.0;
  candidate.is_share = true;
  candidate.has_states = relative.sticks;
  candidate.own_scales = {{relative.scale, relative.sticks ? length : length + "/s"}};
  candidate.own_scales.front().has_limit = true;
  candidate.add = makeAdd(relative, element);
  addScanned(candidate, relative.first * (relative.sticks ? sizes.reach : sizes.speed), relative.factor,
             kScales, candidates);
}

/// Whether an element is what a share of another law has left.
bool isRest(const Element& own) {
  return own.coulomb.text.rfind("(1 - ", 0) == 0;
}

}  // namespace

std::vector<TermCandidate> listLawCandidates(const ModelSpec& model, const ModelSizes& sizes) {
  std::vector<TermCandidate> candidates;
  const auto& elements = model.system.elements.get<Friction>();
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const auto coordinate =
        std::find_if(sizes.coordinates.begin(), sizes.coordinates.end(),
                     [&](const CoordinateSizes& one) { return one.name == elements[i].coordinate.text; });
    if (coordinate == sizes.coordinates.end() || isRest(elements[i])) {
      continue;
    }
    for (const Relative& relative : kRelatives) {
      addRelative(relative, i, elements[i], *coordinate, candidates);
    }
  }
  return candidates;
}

}  // namespace twinmap
