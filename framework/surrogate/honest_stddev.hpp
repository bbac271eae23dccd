#pragma once

#include <Eigen/Core>

namespace twinmap {

/// The factor by which standard deviations must be multiplied so that both the 95 % and the 68 % interval
/// hold, from the absolute errors of samples that took no part in the training, each over its standard
/// deviation: the larger of the two conformal quantiles, each over that of the normal distribution. Below 1
/// only where the quantiles' upper confidence limits (97.5 %) are, and then the larger of these: claiming
/// less than the map does must be beyond doubt. More than 2000 samples leave little doubt: of errors with
/// heavier tails than normal ones, 50 % intervals would hold too much then, and the factor is one by which
/// 50 % intervals hold as much too much as 95 % intervals too little, the latter counting twice. Errors with
/// lighter tails keep the factor of the 68 % interval.
double calcStddevScale(const Eigen::VectorXd& absolute_z);

/// The factor of the 68 % interval, of a share one standard error lower: what it is at least, rather than by
/// chance, and without the tails.
double calcLeastStddevScale(const Eigen::VectorXd& absolute_z);

/// What the standard deviations of a map's answers (p parameters) lack.
struct StddevLack {
  Eigen::VectorXd least_scale;     ///< p: calcLeastStddevScale()
  Eigen::VectorXd typical_stddev;  ///< p: their geometric mean, before any factor, in the parameters' units
};

/// Geometric mean of each row of standard deviations.
Eigen::VectorXd calcTypicalStddev(const Eigen::MatrixXd& stddev);

/// The factors (p) for a map that learnt from answers of another, which lacked something: the variance of its
/// own answers, of such typical standard deviations (p), is that of its teacher's and of its own errors, and
/// lacks what the former does. At most the teacher's factors, at least 1.
Eigen::VectorXd calcPupilScale(const StddevLack& teacher, const Eigen::VectorXd& typical_stddev);

}  // namespace twinmap
