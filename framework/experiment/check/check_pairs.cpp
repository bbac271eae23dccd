#include "framework/experiment/check/check_pairs.hpp"

#include <algorithm>
#include <utility>

#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/output_units.hpp"

namespace twinmap {
namespace {

class PairCheck {
 public:
  explicit PairCheck(const ModelSpec& model) : model_(model), elements_(model.system.elements) {}

  void run() const {
    for (const auto& friction : elements_.get<Friction>()) {
      requireAlike(friction, "friction acts");
    }
    for (const auto& backlash : elements_.get<Backlash>()) {
      requireAlike(backlash, "play is");
    }
    for (const auto& stop : elements_.get<Stop>()) {
      requireAlike(stop, "a stop is");
      if (stop.isRigid()) {
        requireFree(stop);
      }
    }
    checkSticking();
  }

 private:
  std::string findUnit(const Name& coordinate) const {
    OutputSpec output;
    output.coordinate = coordinate;
    return findOutputUnit(output, model_.system);
  }

  template <class Element>
  void requireAlike(const Element& element, const char* what) const {
    if (!element.against) {
      return;
    }
    const Name& against = *element.against;
    if (against.text == element.coordinate.text) {
      throw ExperimentError(
          against.where, against.text,
          "must be another one than 'coordinate'; leave 'against' out for what stands still");
    }
    if (findUnit(against) != findUnit(element.coordinate)) {
      throw ExperimentError(against.where, against.text,
                            "is in " + findUnit(against) + ", but '" + element.coordinate.text + "' in " +
                                findUnit(element.coordinate) + ": " + what +
                                " between two lengths or two angles");
    }
  }

  void checkSticking() const {
    std::vector<std::pair<std::string, std::string>> all;
    for (const auto& friction : elements_.get<Friction>()) {
      if (!friction.switches()) {
        continue;
      }
      if (!isPrescribed(friction.coordinate) || (friction.against && !isPrescribed(*friction.against))) {
        requireFree(friction);
      }
      std::pair<std::string, std::string> pair{friction.coordinate.text,
                                               friction.against ? friction.against->text : ""};
      if (pair.second < pair.first) {
        std::swap(pair.first, pair.second);
      }
      if (std::find(all.begin(), all.end(), pair) != all.end()) {
        throw ExperimentError(friction.coordinate.where, friction.coordinate.text,
                              "has friction with 'model: coulomb' already, and which of them holds it is not "
                              "determined; add their levels up in one");
      }
      all.push_back(std::move(pair));
    }
  }

  template <class Element>
  void requireFree(const Element& element) const {
    requireFree(element.coordinate);
    if (element.against) {
      requireFree(*element.against);
    }
  }
  void requireFree(const Name& name) const {
    if (isPrescribed(name)) {
      throw ExperimentError(name.where, name.text,
                            "moves as a signal says (motions), so that it can neither stick nor be thrown "
                            "back; make what slides on it a body whose joint has it as its parent");
    }
  }
  bool isPrescribed(const Name& name) const {
    const std::vector<MotionSpec>& motions = model_.system.motions;
    return std::any_of(motions.begin(), motions.end(),
                       [&](const MotionSpec& motion) { return motion.coordinate.text == name.text; });
  }

  const ModelSpec& model_;
  const ForceElements<Expression>& elements_;
};

}  // namespace

void checkPairs(const ModelSpec& model) {
  PairCheck(model).run();
}

}  // namespace twinmap
