#pragma once

#include <string>

#include "framework/estimation/refined/misfit.hpp"

namespace twinmap {

constexpr double kConverged = 0.03;  ///< standard deviations: adds 0.05 % to the error

/// The Gauss-Newton step as far as the limits allow it, and its largest component in standard deviations.
struct NewtonStep {
  Eigen::VectorXd step;
  double length;
};
NewtonStep calcNewtonStep(const LocalMisfit& local, const SearchBox& box);

/// Where a search ended.
struct SearchEnd {
  LocalMisfit local;  ///< its status is not ok where the start itself could not be simulated
  bool converged = false;
  Eigen::VectorXd rest;  ///< s, the Gauss-Newton step that was not taken; empty unless converged
  int iterations = 0;
  std::string message;  ///< why it has not converged
};

/// The least misfit from `start` (s, half-widths) by Levenberg and Marquardt's method within the limits of
/// the box. An iteration linearises the misfit, then tries three dampings at once and takes the best
/// (DampedSteps). It has converged where the Gauss-Newton step, parameters at a limit held, is below 0.03
/// standard deviations in every parameter; and also where no step improves the misfit any more, or the
/// iterations are used up, but that step is below 0.3: on chaotic responses the error of the integration
/// makes the misfit rough, which hides smaller improvements. What such a step leaves open is `rest`, part of
/// the answer's uncertainty. Where a limit stops a step of more than one standard deviation there is no
/// minimum that a covariance could describe: that has not converged. A simulation that fails is a step not
/// taken. Cost: a batch of three simulations with derivatives an iteration in lanes, which costs what one
/// does; else three simulations and then one with derivatives. One to three iterations from a good start.
SearchEnd search(Misfit& misfit, const Eigen::VectorXd& start, int max_iterations = 30);

}  // namespace twinmap
