#include "framework/estimation/gp/predict_left_out.hpp"

#include "kernels/gp/leave_one_out.hpp"
#include "kernels/gp/sparse/sparse_leave_one_out.hpp"

namespace twinmap {
namespace {

/// The samples left out of one process, in the standardised parameter.
gp::LeaveOneOut calcLeftOut(const gp::Process& process, const Eigen::MatrixXd& inputs,
                            const Eigen::VectorXd& target, const gp::SampleGroups& groups, int threads) {
  if (const auto* exact = std::get_if<std::shared_ptr<const gp::GaussianProcess>>(&process)) {
    return gp::calcLeaveGroupsOut(**exact, groups, threads);
  }
  const auto& sparse = std::get<std::shared_ptr<const gp::SparseGaussianProcess>>(process);
  return gp::calcLeaveGroupsOut(*sparse, inputs, target, groups);
}

}  // namespace

Estimates predictLeftOut(const GpMap& map, const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& targets,
                         int replicates, const TrainingControl& control) {
  const gp::SampleGroups groups = gp::makeDrawGroups(inputs.cols(), replicates);
  Estimates predictions{targets, targets};
  for (Eigen::Index p = 0; p < targets.rows(); ++p) {
    gp::throwIfStopped(control.stop);
    const gp::LeaveOneOut left_out =
        calcLeftOut(map.processes[p], inputs, targets.row(p).transpose(), groups, control.threads);
    const Eigen::RowVectorXd mean = targets.row(p) - left_out.residual.transpose();
    predictions.mean.row(p) = map.target_offset[p] + map.target_scale[p] * mean.array();
    // The stddev left out holds the likelihood's noise, which the profile redistributes.
    const double noise = gp::getNoiseVariance(map.processes[p]);
    const Eigen::ArrayXd latent = left_out.stddev.array().square() - noise;
    const Eigen::ArrayXd factors = map.noise.calcFactors(map.processes[p], p, inputs);
    predictions.stddev.row(p) = map.target_scale[p] * (latent + noise * factors).sqrt().transpose();
  }
  return predictions;
}

}  // namespace twinmap
