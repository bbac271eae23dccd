#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "framework/estimation/estimate.hpp"

namespace twinmap {

/// How calibrated the predictions are for all parameters of a sample together: the joint predictive
/// distribution is normal with covariance D R D, D = diag(stddev) and R the correlation of the errors; or a
/// mixture, of which the smallest highest-density set is found by draws.
struct JointFigures {
  double coverage95 = 0.0;  ///< fraction of samples whose squared Mahalanobis distance is below the 95 %
  double coverage90 = 0.0;  ///< quantile of chi-square with p degrees of freedom
  double coverage50 = 0.0;
  double nlpd = 0.0;  ///< mean negative log joint predictive density, in the parameters' units
};

struct JointMetrics : JointFigures {
  JointFigures se;  ///< Monte Carlo standard error of each figure, by the jackknife over the samples
};

struct JointColumn {
  const char* name;
  double JointFigures::*value;
};

/// All of them by name, in the order of joint.csv.
constexpr std::array<JointColumn, 4> kJointColumns{{{"coverage95", &JointFigures::coverage95},
                                                    {"coverage90", &JointFigures::coverage90},
                                                    {"coverage50", &JointFigures::coverage50},
                                                    {"nlpd", &JointFigures::nlpd}}};

/// `truth` is p x n; the estimates have R (p x p, positive definite), one for all samples or one for each, or
/// mixtures. O(p^2 n), O(p^3 n) for one each.
JointMetrics calcJointMetrics(const Eigen::MatrixXd& truth, const Estimates& estimates);

}  // namespace twinmap
