#include <fmt/core.h>

#include "framework/base/text/number_text.hpp"
#include "framework/diagnosis/candidates/term_candidates.hpp"

namespace twinmap {
namespace {

constexpr const char* kAxes[] = {"x", "y", "z"};

Expression addTo(const Expression& expression, const std::string& term) {
  return {"(" + expression.text + ") + " + term, expression.where};
}

/// The expression of a body that a coefficient is added to.
using BodyExpression = std::function<Expression&(BodySpec&)>;

/// Nothing of size 0 is a candidate: a body without mass has none to correct.
void addCorrection(TermCandidate candidate, std::size_t index, const BodyExpression& get,
                   std::vector<TermCandidate>& candidates) {
  if (!(candidate.size > 0.0)) {
    return;
  }
  candidate.add = [index, get](ModelSpec& model, const std::string& coefficient,
                               const std::vector<std::string>&) {
    Expression& changed = get(model.system.bodies[index]);
    changed = addTo(changed, coefficient);
  };
  candidates.push_back(std::move(candidate));
}

/// About each axis, or about the joint's alone where the file gives no other.
void addMoments(const BodySpec& body, std::size_t index, const ModelSizes& sizes,
                std::vector<TermCandidate>& candidates) {
  const std::string& name = body.name.text;
  const auto add = [&](const std::string& key, const std::string& axis, const BodyExpression& get) {
    addCorrection({key + "." + name,
                   fmt::format("another moment of inertia of {} about its {}, by c", name, axis),
                   "kg m2",
                   kLargeShare * sizes.moments[index],
                   false,
                   {},
                   false,
                   {}},
                  index, get, candidates);
  };
  if (!body.inertia.about_axis.text.empty()) {
    add("inertia", "joint's axis",
        [](BodySpec& changed) -> Expression& { return changed.inertia.about_axis; });
    return;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    add(std::string("inertia_") + kAxes[axis], kAxes[axis],
        [axis](BodySpec& changed) -> Expression& { return changed.inertia.moments[axis]; });
  }
}

void addBody(const BodySpec& body, std::size_t index, const ModelSizes& sizes,
             std::vector<TermCandidate>& candidates) {
  const std::string& name = body.name.text;
  addCorrection(
      {"mass." + name,
       fmt::format("another mass of {}, by c", name),
       "kg",
       kLargeShare * sizes.masses[index],
       false,
       {},
       false,
       {}},
      index, [](BodySpec& changed) -> Expression& { return changed.mass; }, candidates);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    addCorrection(
        {fmt::format("center_{}.{}", kAxes[axis], name),
         fmt::format("another centre of mass of {}, by c along its {}", name, kAxes[axis]),
         "m",
         kLargeShare * sizes.lengths[index],
         false,
         {},
         false,
         {}},
        index, [axis](BodySpec& changed) -> Expression& { return changed.center_of_mass[axis]; }, candidates);
  }
  addMoments(body, index, sizes, candidates);
}

Eigen::Vector3d calcCross(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Gravity turned by the coefficient about `axis`.
TermCandidate makeTilt(const ModelSizes& sizes, const Eigen::Vector3d& axis, const char* name) {
  const Eigen::Vector3d turned = calcCross(axis, sizes.gravity);
  TermCandidate tilt;
  tilt.term = fmt::format("tilt.{}", name);
  tilt.meaning = fmt::format("gravity turned by c about the ground's {}", name);
  tilt.unit = "rad";
  tilt.size = kLargeTilt;
  tilt.add = [turned](ModelSpec& model, const std::string& coefficient, const std::vector<std::string>&) {
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
