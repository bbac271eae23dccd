#pragma once

#include "kernels/tracking/belief.hpp"

namespace twinmap::tracking {

/// What is known of the levels (p) at each of N times.
struct Course {
  Eigen::MatrixXd means, stddevs;  ///< p x N
};

/// A measurement as it was used: its rows, the time since the one before, and what was forgotten before it.
struct SmoothedStep {
  double dt = 0.0;
  StateRows rows;             ///< none of a measurement that was not used
  Eigen::VectorXd forgotten;  ///< p: variance that a sudden change adds before it; empty: none
  Eigen::VectorXd units;      ///< n: variance of priors that begin before it; empty: none
};

/// The smoother of Rauch, Tung and Striebel, by the adjoint recursion (Bryson and Frazier) that inverts
/// nothing. It says what all measurements say of each time. rates (p): variance per unit of time. Returns log
/// of the density of all values, which tells rates from each other, beside the course. O(N k n^2).
struct Smoothed {
  Course course;
  double log_likelihood = 0.0;
};
Smoothed smooth(const Model& model, const std::vector<SmoothedStep>& steps, const Eigen::VectorXd& rates);

}  // namespace twinmap::tracking
