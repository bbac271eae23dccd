#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "framework/diagnosis/candidates/term_candidates.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"

namespace twinmap {
namespace {

/// The numbers of one contact's law, and whose it is.
struct WrittenContact {
  std::string name;        ///< of its coordinate and side, or its body
  std::string coordinate;  ///< empty of a point on a plane
  Expression& stiffness;
  std::optional<Expression>& exponent;
  Expression& dissipation;
};

/// action(WrittenContact) of each elastic contact of a model, always in the same order.
template <class Action>
void forEachContact(ForceElements<Expression>& elements, Action action) {
  for (Stop<Expression>& stop : elements.get<Stop>()) {
    if (!stop.isRigid()) {
      stop.dissipation = stop.dissipation.value_or(Expression{});
      action(WrittenContact{stop.coordinate.text + (stop.above ? "_above" : "_below"), stop.coordinate.text,
                            *stop.stiffness, stop.exponent, *stop.dissipation});
    }
  }
  for (Backlash<Expression>& play : elements.get<Backlash>()) {
    action(WrittenContact{play.coordinate.text, play.coordinate.text, play.law.stiffness, play.law.exponent,
                          play.law.dissipation});
  }
  for (Contact<Expression>& contact : elements.get<Contact>()) {
    action(WrittenContact{contact.station.body.text, "", contact.law.stiffness, contact.law.exponent,
                          contact.law.dissipation});
  }
}

using ChangeContact = void (*)(const WrittenContact& contact, const std::string& coefficient, double force);

/// From F to F0 (F/F0)^(1 + c): F0 keeps the stiffness near what it was.
void raisePower(const WrittenContact& contact, const std::string& coefficient, double force) {
  const std::string stiffness = contact.stiffness.text;
  contact.stiffness.text = fmt::format("({0})*(({0})/{1})^{2}", stiffness, force, coefficient);
  const std::string power = contact.exponent ? "(" + contact.exponent->text + ")*" : "";
  contact.exponent = Expression{fmt::format("{}(1 + {})", power, coefficient), {}};
}

void raiseLoss(const WrittenContact& contact, const std::string& coefficient, double) {
  contact.dissipation.text = fmt::format("({}) + {}", contact.dissipation.text, coefficient);
}

/// How large what presses is, and how fast: of its coordinate, or the largest that moves along a line.
struct ContactSizes {
  double force = 0.0, speed = 0.0;
  bool is_angle = false;
};

ContactSizes calcSizes(const std::string& coordinate, const ModelSizes& sizes) {
  ContactSizes largest;
  for (const CoordinateSizes& one : sizes.coordinates) {
    if (coordinate.empty() ? !one.is_angle : coordinate == one.name) {
      largest = {std::max(largest.force, one.force), std::max(largest.speed, one.speed), one.is_angle};
    }
  }
  return largest;
}

AddTerm makeAdd(ChangeContact change, std::size_t contact, double force) {
  return [=](ModelSpec& model, const std::string& coefficient, const std::vector<std::string>&) {
    std::size_t at = 0;
    forEachContact(model.system.elements, [&](const WrittenContact& one) {
      if (at++ == contact) {
        change(one, coefficient, force);
      }
    });
  };
}

TermCandidate makePower(const std::string& name, std::size_t contact, const ContactSizes& sizes) {
  TermCandidate candidate;
  candidate.term = "contact_power." + name;
  candidate.meaning = "the contact's force grows with the power 1 + c of what it is";
  candidate.unit = "1";
  candidate.size = kHertz;
  candidate.add = makeAdd(raisePower, contact, sizes.force);
  return candidate;
}

TermCandidate makeLoss(const std::string& name, std::size_t contact, const ContactSizes& sizes) {
  TermCandidate candidate;
  candidate.term = "contact_loss." + name;
  candidate.meaning = "the contact loses energy: by c more of its force for each unit of speed into it";
  candidate.unit = sizes.is_angle ? "s/rad" : "s/m";
  candidate.size = 1.0 / sizes.speed;
  candidate.dissipates = true;
  candidate.add = makeAdd(raiseLoss, contact, sizes.force);
  return candidate;
}

}  // namespace

std::vector<TermCandidate> listContactCandidates(const ModelSpec& model, const ModelSizes& sizes) {
  std::vector<TermCandidate> candidates;
  std::set<std::string> names;
  ForceElements<Expression> elements = model.system.elements;
  std::size_t contact = 0;
  forEachContact(elements, [&](const WrittenContact& one) {
    const std::size_t place = contact++;
    const ContactSizes typical = calcSizes(one.coordinate, sizes);
    if (typical.force > 0.0) {
      const std::string name =
          names.insert(one.name).second ? one.name : fmt::format("{}_{}", one.name, place);
      candidates.push_back(makePower(name, place, typical));
      candidates.push_back(makeLoss(name, place, typical));
    }
  });
  return candidates;
}

}  // namespace twinmap
