#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/estimation/surrogate/forward_surrogate.hpp"
#include "kernels/linalg/triangular.hpp"

namespace twinmap {

/// The likelihood of measured scores by a forward surrogate, without linearisation: for the unknowns x (u,
/// normalised) in the box
///   -1/2 (r' C^-1 r + log det C),   r = scores - s(x),   C = 1 + D(x) R D(x),
/// and -infinity outside. One object a thread: it holds the buffers.
class ScoreLikelihood {
 public:
  /// `surrogate` must outlive the object.
  explicit ScoreLikelihood(const ForwardSurrogate& surrogate);

  /// Scores (r), normalised known variables (m - u), and by how much the windows' standard deviations are
  /// larger than they say (ScoreMode::widening).
  void setMeasurement(const Eigen::Ref<const Eigen::VectorXd>& scores,
                      const Eigen::Ref<const Eigen::VectorXd>& known, std::vector<double> widening);

  /// Of n points (u x n). Cost of each: one evaluation of the processes and of their variances, and r^3 / 3
  /// flops.
  Eigen::VectorXd calcLogs(const Eigen::MatrixXd& unknown);

 private:
  double calcLog(Eigen::Index point);

  const ForwardSurrogate& surrogate_;
  std::vector<gp::SharedProcess::Workspace> workspaces_;
  std::vector<double> widening_;
  Eigen::VectorXd scores_, known_, residual_;
  Eigen::MatrixXd points_, values_, stddev_, covariance_;
  linalg::TriangularScratch scratch_;
};

}  // namespace twinmap
