#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <string>

#include "framework/base/text/number_text.hpp"
#include "framework/diagnosis/candidates/replace_name.hpp"
#include "framework/diagnosis/candidates/term_candidates.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"

namespace twinmap {
namespace {

bool isSignal(const ModelSpec& model, const std::string& name) {
  return std::any_of(model.excitation.begin(), model.excitation.end(),
                     [&](const SignalSpec& signal) { return signal.name.text == name; });
}

/// A coordinate or its speed.
bool isOfMotion(const ModelSpec& model, const std::string& name) {
  return std::any_of(model.system.bodies.begin(), model.system.bodies.end(), [&](const BodySpec& body) {
    const std::vector<Name>& names = body.joint.coordinates;
    return std::any_of(names.begin(), names.end(),
                       [&](const Name& one) { return name == one.text || name == one.text + "_dot"; });
  });
}

/// The force laws on a coordinate, with 0 in the place of what `is_left_out` names; "" where nothing is left
/// that varies.
std::string writeLaws(const ModelSpec& model, const std::string& coordinate,
                      const std::function<bool(const std::string& name)>& is_left_out) {
  std::string sum;
  for (const ForceLaw<Expression>& law : model.system.elements.get<ForceLaw>()) {
    std::string kept = law.force.text;
    bool varies = false;
    for (const std::string& name : getUsedNames(law.force)) {
      if (is_left_out(name)) {
        kept = replaceName(kept, name, "0");
      } else {
        varies = varies || isOfMotion(model, name) || isSignal(model, name);
      }
    }
    if (law.coordinate.text == coordinate && varies) {
      sum += (sum.empty() ? "(" : " + (") + kept + ")";
    }
  }
  return sum;
}

bool slides(const Friction<Expression>& friction, const std::string& coordinate) {
  return friction.coordinate.text == coordinate && !friction.against;
}

/// The friction that the model has grows, so that it sticks under load too. Below 0 there is no level.
void addToLevel(Friction<Expression>& friction, const std::string& growth) {
  friction.coulomb.text = "max(" + friction.coulomb.text + " + " + growth + ", 0)";
}

/// Beside the model's friction on a coordinate, or as one that sets in at a speed of its own.
void addFriction(ModelSpec& model, const std::string& coordinate, const std::string& growth,
                 const std::string& speed) {
  for (Friction<Expression>& friction : model.system.elements.get<Friction>()) {
    if (slides(friction, coordinate)) {
      addToLevel(friction, growth);
      return;
    }
  }
  addForceLaw(model, coordinate, fmt::format("-{}*tanh({}_dot/{})", growth, coordinate, speed));
}

TermCandidate makeLoadCandidate(const char* kind, const char* of, const CoordinateSizes& coordinate,
                                const std::string& load) {
  constexpr double kOnset = 0.04;  // of the largest speed, amid those that dry friction is scanned with
  const std::string name = coordinate.name;
  TermCandidate candidate;
  candidate.term = fmt::format("{}.{}", kind, name);
  candidate.meaning =
      fmt::format("friction that grows with {}, as of a gear: c abs({}) on {}", of, load, name);
  candidate.unit = "1";
  candidate.dissipates = true;
  candidate.add = [name, load, speed = toText(kOnset * coordinate.speed)](
                      ModelSpec& changed, const std::string& coefficient, const std::vector<std::string>&) {
    addFriction(changed, name, coefficient + "*abs(" + load + ")", speed);
  };
  return candidate;
}

}  // namespace

std::vector<TermCandidate> listLoadCandidates(const ModelSpec& model, const ModelSizes& sizes) {
  std::vector<TermCandidate> candidates;
  for (const CoordinateSizes& coordinate : sizes.coordinates) {
    const std::string load =
        writeLaws(model, coordinate.name, [&](const std::string& name) { return isSignal(model, name); });
    const std::string drive =
        writeLaws(model, coordinate.name, [&](const std::string& name) { return isOfMotion(model, name); });
    if (!load.empty()) {
      candidates.push_back(makeLoadCandidate("load_friction", "load", coordinate, load));
    }
    if (!drive.empty()) {
      candidates.push_back(makeLoadCandidate("drive_friction", "the drive's force", coordinate, drive));
    }
  }
  return candidates;
}

}  // namespace twinmap
