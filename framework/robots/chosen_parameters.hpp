#pragma once

#include <string>
#include <vector>

#include "framework/robots/robot_names.hpp"

namespace twinmap::robots {

/// What of a robot becomes parameters of the experiment.
struct Chosen {
  bool inertia = false, friction = false, armature = false, damping = false;
};

/// Throws ExperimentError for a word that is none of them.
Chosen readChosen(const std::vector<std::string>& words);

/// A number of the robot's file that is a parameter of the experiment.
struct RobotParameter {
  std::string name;  ///< in the experiment
  double value = 0.0, stddev = 0.0, lower = 0.0, upper = 0.0;
  std::string unit;
  bool has_prior = true;  ///< else uniform within the bounds
};

/// The parameters of a robot, in the order of the experiment.
class ChosenParameters {
 public:
  ChosenParameters(RobotNames& names, double relative_stddev)
      : names_(names), relative_stddev_(relative_stddev) {}

  /// A number that is about `size` where it is 0; the text that stands for it.
  std::string add(const std::string& wish, double value, double size, const std::string& unit);
  /// One above 0.
  std::string addPositive(const std::string& wish, double value, const std::string& unit);
  /// Of which only its range is known.
  std::string addRange(const std::string& wish, double upper, const std::string& unit);

  const std::vector<RobotParameter>& getAll() const { return all_; }

 private:
  RobotNames& names_;
  double relative_stddev_;
  std::vector<RobotParameter> all_;
};

}  // namespace twinmap::robots
