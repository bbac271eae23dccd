#pragma once

#include <Eigen/Core>
#include <optional>

namespace twinmap {

/// A misfit about a point by its linear model,
///   misfit(at + step) ~ misfit - 2 step' descent + step' hessian step.
struct LinearModel {
  const Eigen::VectorXd& at;
  double misfit;
  const Eigen::MatrixXd& hessian;
  const Eigen::VectorXd& descent;

  /// What a step gains if the linear model holds.
  double calcGain(const Eigen::VectorXd& step) const {
    return 2.0 * step.dot(descent) - step.dot(hessian * step);
  }
};

/// Where a search may go, the direction in which it stays (u; or empty), and how far in a coordinate at once.
struct StepBounds {
  Eigen::VectorXd lower, upper, held{};
  double longest = 0.5;  // half of a coordinate's bounds
};

/// The steps of one search for a minimum by Levenberg and Marquardt's method within bounds. An iteration
/// tries three dampings side by side, from nearly a Gauss-Newton step to a short one, or one where the linear
/// model held the last time, and takes the best. Coordinates at a bound whose descent points outwards are
/// held.
class DampedSteps {
 public:
  explicit DampedSteps(StepBounds bounds) : bounds_(std::move(bounds)) {}

  const StepBounds& getBounds() const { return bounds_; }
  /// The step without damping, within the bounds: coordinates that it would take beyond them end there, and
  /// the others are solved for again, as those make up for these no longer.
  Eigen::VectorXd calcNewtonStep(const LinearModel& from) const { return calcStep(from, 0.0); }
  /// `step` from there, shortened to what a linear model is believed for.
  Eigen::VectorXd take(const LinearModel& from, const Eigen::VectorXd& step) const;
  /// Points (u x n) to try.
  Eigen::MatrixXd propose(const LinearModel& from) const;
  /// Which of these points is the best, by their misfits (n), infinite where one fails; none where none
  /// improves. Centres the damping on it, or raises it.
  std::optional<Eigen::Index> choose(const LinearModel& from, const Eigen::MatrixXd& tried,
                                     const Eigen::VectorXd& misfits);
  /// Whether no step improves any more.
  bool areExhausted() const;

 private:
  Eigen::VectorXd calcStep(const LinearModel& from, double damping) const;

  StepBounds bounds_;
  double damping_ = 1e-2;
  bool linear_ = false;  // whether the last step gained what the linear model said
};

}  // namespace twinmap
