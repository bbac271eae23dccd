#include <fmt/core.h>

#include "framework/base/text/number_text.hpp"
#include "framework/diagnosis/term_candidates.hpp"

namespace twinmap {
namespace {

/// Of what is known of a body, a tenth is much.
constexpr double kMuch = 0.1;
constexpr const char* kAxes[] = {"x", "y", "z"};

Expression addTo(const Expression& expression, const std::string& term) {
  return {"(" + expression.text + ") + " + term, expression.where};
}

void addBody(const BodySpec& body, std::size_t index, const ModelSizes& sizes,
             std::vector<TermCandidate>& candidates) {
  const std::string& name = body.name.text;
  TermCandidate mass;
  mass.term = "mass." + name;
  mass.meaning = fmt::format("another mass of {}, by c", name);
  mass.unit = "kg";
  mass.size = kMuch * sizes.masses[index];
  mass.add = [index](ModelSpec& model, const std::string& coefficient, const std::string&) {
    Expression& changed = model.system.bodies[index].mass;
    changed = addTo(changed, coefficient);
  };
  if (mass.size > 0.0) {
    candidates.push_back(mass);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    TermCandidate center;
    center.term = fmt::format("center_{}.{}", kAxes[axis], name);
    center.meaning = fmt::format("another centre of mass of {}, by c along its {}", name, kAxes[axis]);
    center.unit = "m";
    center.size = kMuch * sizes.lengths[index];
    center.add = [index, axis](ModelSpec& model, const std::string& coefficient, const std::string&) {
      Expression& changed = model.system.bodies[index].center_of_mass[axis];
      changed = addTo(changed, coefficient);
    };
    if (center.size > 0.0) {
      candidates.push_back(center);
    }
    TermCandidate moment;
    moment.term = fmt::format("inertia_{}.{}", kAxes[axis], name);
    moment.meaning = fmt::format("another moment of inertia of {} about its {}, by c", name, kAxes[axis]);
    moment.unit = "kg m2";
    moment.size = kMuch * sizes.moments[index];
    moment.add = [index, axis](ModelSpec& model, const std::string& coefficient, const std::string&) {
      Expression& changed = model.system.bodies[index].inertia.moments[axis];
      changed = addTo(changed, coefficient);
    };
    if (moment.size > 0.0) {
      candidates.push_back(moment);
    }
  }
}

Eigen::Vector3d calcCross(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Gravity turned by the coefficient about `axis`.
TermCandidate makeTilt(const ModelSizes& sizes, const Eigen::Vector3d& axis, const char* name) {
  constexpr double kLarge = 0.02;  // rad: what a spirit level shows at once
  const Eigen::Vector3d turned = calcCross(axis, sizes.gravity);
  TermCandidate tilt;
  tilt.term = fmt::format("tilt.{}", name);
  tilt.meaning = fmt::format("gravity turned by c about the ground's {}", name);
  tilt.unit = "rad";
  tilt.size = kLarge;
  tilt.add = [turned](ModelSpec& model, const std::string& coefficient, const std::string&) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double part = turned[static_cast<Eigen::Index>(i)];
      if (part != 0.0) {
        model.system.gravity[i] = addTo(model.system.gravity[i], toText(part) + "*" + coefficient);
      }
    }
  };
  return tilt;
}

}  // namespace

std::vector<TermCandidate> listBodyCandidates(const ModelSpec& model, const ModelSizes& sizes) {
  std::vector<TermCandidate> candidates;
  for (std::size_t i = 0; i < model.system.bodies.size(); ++i) {
    addBody(model.system.bodies[i], i, sizes, candidates);
  }
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(i);
    // turning gravity about itself changes nothing
    if (calcCross(axis, sizes.gravity).norm() > 1e-9 * sizes.gravity.norm()) {
      candidates.push_back(makeTilt(sizes, axis, kAxes[i]));
    }
  }
  return candidates;
}

}  // namespace twinmap
