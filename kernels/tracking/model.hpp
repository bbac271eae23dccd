#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

namespace twinmap::tracking {

/// How one parameter moves. Its level x is a random walk, x(t + dt) = x(t) + slope dt + N(0, rate dt).
struct Drift {
  /// Variance of the walk per unit of time; 0: constant; NaN: unknown. Then it is from a rate of a
  /// measurement's standard deviation over 1024 to 8 of them between two measurements.
  double rate = 0.0;
  bool has_slope = false;  ///< constant, unknown: one unit of the parameter within the first interval at most
  double change_stddev = 0.0;  ///< of a sudden change; 0: three of a measurement
  double change_weight = 1.0;  ///< how much likelier it changes than others
  /// Of an error that all measurements share, so that it does not average out: its standard deviation over
  /// that of a measurement.
  double shared_error = 0.0;
};

/// A condition that a parameter follows: it is level + coefficient (condition - its first value).
struct Follow {
  Eigen::Index parameter = 0, condition = 0;
  /// Of the coefficient's prior, whose mean is 0; 0: ten units of the parameter over the first value.
  double stddev = 0.0;
};

/// p parameters, in units in which their bounds are -1 and 1, and how they move. The state (n) is
/// their levels, then the slopes of those that have one, then a coefficient for each Follow.
struct Model {
  std::vector<Drift> drifts;  ///< p
  std::vector<Follow> follows;
  Eigen::Index conditions = 0;
  Eigen::VectorXd mean;        ///< p, before the first measurement
  Eigen::MatrixXd covariance;  ///< p x p, likewise
  double false_alarms = 1e-3;  ///< a measurement, over all parameters together

  Eigen::Index countParameters() const { return static_cast<Eigen::Index>(drifts.size()); }
  Eigen::Index countSlopes() const;
  Eigen::Index countStates() const {
    return countParameters() + countSlopes() + static_cast<Eigen::Index>(follows.size());
  }
};

/// One of several things that a measurement may say, as the likelihood is of it alone.
struct Mode {
  Eigen::MatrixXd rows;       ///< k x p
  Eigen::VectorXd values;     ///< k
  Eigen::VectorXd variances;  ///< p
  double log_weight = 0.0;    ///< by which its density is multiplied
};

/// What one measurement says: values = rows parameters + noise of unit variance, independent. Where several
/// separate values fit, the likelihood is the sum of modes; rows and values are then those of all together.
struct Measurement {
  double time = 0.0;
  Eigen::MatrixXd rows;    ///< k x p
  Eigen::VectorXd values;  ///< k
  Eigen::VectorXd
      variances;  ///< p, of each parameter by this measurement alone; infinite where it says nothing
  Eigen::VectorXd conditions;  ///< of the model; NaN where missing
  std::vector<Mode> modes{};
};

inline Eigen::Index Model::countSlopes() const {
  Eigen::Index count = 0;
  for (const Drift& drift : drifts) {
    count += drift.has_slope ? 1 : 0;
  }
  return count;
}

}  // namespace twinmap::tracking
