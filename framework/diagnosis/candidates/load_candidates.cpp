#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <vector>

#include "framework/base/text/number_text.hpp"
#include "framework/diagnosis/candidates/split_sum.hpp"
#include "framework/diagnosis/candidates/term_candidates.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/gravity_name.hpp"

namespace twinmap {
namespace {

template <class T>
bool isAmong(const std::vector<T>& items, const std::string& name) {
  return std::any_of(items.begin(), items.end(), [&](const T& one) { return one.name.text == name; });
}

/// What an expression depends on.
struct Dependence {
  bool on_drive = false, on_coordinates = false, on_speeds = false;
};

void addDependence(const Dependence& more, Dependence& all) {
  all.on_drive = all.on_drive || more.on_drive;
  all.on_coordinates = all.on_coordinates || more.on_coordinates;
  all.on_speeds = all.on_speeds || more.on_speeds;
}

/// A drive's force is of signals and their rates, of what controllers write, of states such as currents, or
/// of time.
bool isOfDrive(const ModelSpec& model, const std::string& name) {
  const std::vector<ControllerSpec>& controllers = model.system.controllers;
  const auto is_rate = [&](const SignalSpec& signal) {
    return name == signal.name.text + "_dot" || name == signal.name.text + "_ddot";
  };
  return name == "t" || isAmong(model.excitation, name) || isAmong(model.system.states, name) ||
         std::any_of(model.excitation.begin(), model.excitation.end(), is_rate) ||
         std::any_of(controllers.begin(), controllers.end(),
                     [&](const ControllerSpec& one) { return isAmong(one.writes, name); });
}

const NamedExpression* findNamed(const ModelSpec& model, const std::string& name) {
  const std::vector<NamedExpression>& named = model.system.expressions;
  const auto found = std::find_if(named.begin(), named.end(),
                                  [&](const NamedExpression& one) { return one.name.text == name; });
  return found == named.end() ? nullptr : &*found;
}

Dependence findDependence(const ModelSpec& model, const Expression& expression) {
  Dependence all;
  for (const std::string& name : getUsedNames(expression)) {
    if (const NamedExpression* named = findNamed(model, name)) {
      addDependence(findDependence(model, named->value), all);
      continue;
    }
    all.on_drive = all.on_drive || isOfDrive(model, name);
    for (const BodySpec& body : model.system.bodies) {
      for (const Name& coordinate : body.joint.coordinates) {
        all.on_coordinates =
            all.on_coordinates || name == coordinate.text || name == coordinate.text + kGravitySuffix;
        all.on_speeds = all.on_speeds || name == coordinate.text + "_dot";
      }
    }
  }
  return all;
}

/// What acts on a coordinate: what it carries, and what drives it. Sums; "" for nothing.
struct Acting {
  std::string load, drive;
};

void appendSummand(std::string& sum, const std::string& summand) {
  sum += (sum.empty() ? "" : " + ") + summand;
}

/// Of a force law; what it says of speeds alone is neither.
void addLaw(const ModelSpec& model, const std::string& force, Acting& acting) {
  for (const std::string& summand : splitSum(force)) {
    const bool is_negative = summand.rfind("-(", 0) == 0;
    const NamedExpression* named =
        findNamed(model, is_negative ? summand.substr(2, summand.size() - 3) : summand);
    if (named != nullptr) {
      addLaw(model, is_negative ? "-(" + named->value.text + ")" : named->value.text, acting);
      continue;
    }
    const Dependence on = findDependence(model, {summand, {}});
    if (on.on_drive) {
      appendSummand(acting.drive, summand);
    } else if (on.on_coordinates && !on.on_speeds) {
      appendSummand(acting.load, summand);
    }
  }
}

/// A weight that does not change loads as dry friction does.
Acting findActing(const ModelSpec& model, const CoordinateSizes& coordinate) {
  Acting acting;
  for (const ForceLaw<Expression>& law : model.system.elements.get<ForceLaw>()) {
    if (law.coordinate.text == coordinate.name) {
      addLaw(model, law.force.text, acting);
    }
  }
  if (coordinate.is_weighed || (coordinate.gravity > 0.0 && !acting.load.empty())) {
    appendSummand(acting.load, coordinate.name + kGravitySuffix);
  }
  return acting;
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

bool isKnown(const ModelSpec& model, const std::string& name) {
  const Dependence on = findDependence(model, {name, {}});
  return on.on_drive || on.on_coordinates || on.on_speeds || findNamed(model, name) != nullptr ||
         isAmong(model.parameters, name) || isAmong(model.nuisance, name) || isAmong(model.constants, name);
}

/// Whether a force is still what it was: a term that it spoke of may have been taken out.
bool isKnown(const ModelSpec& model, const Expression& force) {
  const auto names = getUsedNames(force);
  return std::all_of(names.begin(), names.end(),
                     [&](const std::string& name) { return isKnown(model, name); });
}

TermCandidate makeLoadCandidate(const char* kind, const char* of, const CoordinateSizes& coordinate,
                                const Acting& acting, std::string Acting::*part) {
  constexpr double kOnset = 0.04;  // of the largest speed, amid those that dry friction is scanned with
  const std::string name = coordinate.name, load = acting.*part;
  TermCandidate candidate;
  candidate.term = fmt::format("{}.{}", kind, name);
  candidate.meaning =
      fmt::format("friction that grows with {}, as of a gear: c abs({}) on {}", of, load, name);
  candidate.unit = "1";
  candidate.dissipates = true;
  candidate.add = [coordinate, load, part, speed = toText(kOnset * coordinate.speed)](
                      ModelSpec& changed, const std::string& coefficient, const std::vector<std::string>&) {
    const std::string there =
        isKnown(changed, Expression{load, {}}) ? load : findActing(changed, coordinate).*part;
    if (!there.empty()) {
      addFriction(changed, coordinate.name, coefficient + "*abs(" + there + ")", speed);
    }
  };
  return candidate;
}

}  // namespace

std::vector<TermCandidate> listLoadCandidates(const ModelSpec& model, const ModelSizes& sizes) {
  std::vector<TermCandidate> candidates;
  for (const CoordinateSizes& coordinate : sizes.coordinates) {
    const Acting acting = findActing(model, coordinate);
    if (!acting.load.empty()) {
      candidates.push_back(makeLoadCandidate("load_friction", "load", coordinate, acting, &Acting::load));
    }
    if (!acting.drive.empty()) {
      candidates.push_back(
          makeLoadCandidate("drive_friction", "the drive's force", coordinate, acting, &Acting::drive));
    }
  }
  return candidates;
}

}  // namespace twinmap
