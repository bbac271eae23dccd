#pragma once

#include <Eigen/Core>

#include "kernels/gp/leave_one_out.hpp"
#include "kernels/gp/sparse/sparse_gaussian_process.hpp"

namespace twinmap::gp {

/// Groups left out as from an exact process (kernels/gp/leave_one_out.hpp), inducing inputs kept too. With r
/// = y - prediction, c = L_B^-1 a and e as in SparseGaussianProcess, Woodbury's identity gives for a group g
///   alpha_g = r_g / s_n^2,   P_gg = (I - c_g'c_g / s_n^2) / s_n^2 - (R^-1 e_g)'(R^-1 e_g) / s_n^4,
/// and to the variance 1 / P belongs what the inducing inputs leave undetermined. `inputs` (d x n) and
/// `target` (n) are those that the process was fitted to. Cost: 2 n m (m + d) flops.
LeaveOneOut calcLeaveGroupsOut(const SparseGaussianProcess& process,
                               const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                               const Eigen::Ref<const Eigen::VectorXd>& target, const SampleGroups& groups);

}  // namespace twinmap::gp
