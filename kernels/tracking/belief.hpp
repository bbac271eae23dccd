#pragma once

#include "kernels/tracking/model.hpp"

namespace twinmap::tracking {

/// A normal distribution of the state (n).
struct Belief {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

/// The model's prior; slopes and coefficients are known to be 0 until their units are (setUnits()).
Belief makePrior(const Model& model);

/// What a step of time does: levels move by their slopes, variances grow by `growth` (p), rate times dt. A
/// walk without a slope stays within its bounds, -1 to 1. It makes no level less known than anywhere between
/// them, or than before the first measurement.
void predict(const Model& model, double dt, const Eigen::VectorXd& growth, Belief& belief);

/// One value: h' state + noise of unit variance, and what the belief says of it.
struct Innovation {
  double value = 0.0, variance = 1.0;
  Eigen::VectorXd gain;  ///< n
};

/// The rows of a measurement over the state (n x k), conditions included. A missing condition has none. What
/// it may do is added to the noise of the rows, which stay of unit variance. `spread`: variance of each
/// condition so far.
struct StateRows {
  Eigen::MatrixXd rows;    ///< n x k
  Eigen::VectorXd values;  ///< k
};
StateRows makeStateRows(const Model& model, const Measurement& measurement, const Eigen::VectorXd& reference,
                        const Eigen::VectorXd& spread, const Belief& belief);

/// Kalman's update by one value after another, as exact as by all at once. With s = h' P h + 1 it is mean +=
/// P h v / s, P -= P h h' P / s. Returns log N(values; prediction). `innovations`, if given: k, of each. O(k
/// n^2), no allocation where these have their sizes.
double update(const StateRows& rows, Belief& belief, std::vector<Innovation>* innovations = nullptr);

}  // namespace twinmap::tracking
