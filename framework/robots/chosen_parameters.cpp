#include "framework/robots/chosen_parameters.hpp"

#include <algorithm>
#include <cmath>

#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/source_location.hpp"

namespace twinmap::robots {
namespace {

/// Bounds at this many standard deviations, and the nominal value amid them: 6e-5 of a normal prior is
/// beyond.
constexpr double kReach = 4.0;

}  // namespace

Chosen readChosen(const std::vector<std::string>& words) {
  Chosen chosen;
  const std::vector<std::string> known{"inertia", "friction", "armature", "damping"};
  bool* const switches[] = {&chosen.inertia, &chosen.friction, &chosen.armature, &chosen.damping};
  for (const std::string& word : words) {
    const auto found = std::find(known.begin(), known.end(), word);
    if (found == known.end()) {
      throw ExperimentError("--parameters: '" + word + "' is none of " + listNames(known) +
                            suggestName(word, known));
    }
    *switches[found - known.begin()] = true;
  }
  return chosen;
}

std::string ChosenParameters::add(const std::string& wish, double value, double size,
                                  const std::string& unit) {
  const double stddev = relative_stddev_ * std::max(std::abs(value), size);
  all_.push_back(
      {names_.take(wish), value, stddev, value - kReach * stddev, value + kReach * stddev, unit, true});
  return all_.back().name;
}

std::string ChosenParameters::addPositive(const std::string& wish, double value, const std::string& unit) {
  const std::string name = add(wish, value, 0.0, unit);
  RobotParameter& added = all_.back();
  constexpr double kNearest = 0.05;  // of the value: where a prior reaches 0, what is left above it
  added.lower = std::max(added.lower, kNearest * value);
  added.upper = 2.0 * value - added.lower;
  return name;
}

std::string ChosenParameters::addRange(const std::string& wish, double upper, const std::string& unit) {
  all_.push_back({names_.take(wish), 0.5 * upper, 0.0, 0.0, upper, unit, false});
  return all_.back().name;
}

}  // namespace twinmap::robots
