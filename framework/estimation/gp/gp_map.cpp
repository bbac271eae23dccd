#include "framework/estimation/gp/gp_map.hpp"

namespace twinmap {

Eigen::MatrixXd GpMap::makeProcessInputs(const Eigen::MatrixXd& features,
                                         const Eigen::MatrixXd& inputs) const {
  return stackRows(transform.apply(features), known_inputs.scale(inputs));
}

Estimates GpMap::predict(const Eigen::MatrixXd& features, const Eigen::MatrixXd& known) const {
  const Eigen::MatrixXd inputs = makeProcessInputs(features, known);
  const auto parameters = static_cast<Eigen::Index>(processes.size());
  Estimates predictions{Eigen::MatrixXd(parameters, features.cols()),
                        Eigen::MatrixXd(parameters, features.cols())};
  for (Eigen::Index p = 0; p < parameters; ++p) {
    const gp::Prediction standardised =
        std::visit([&](const auto& process) { return process->predict(inputs); }, processes[p]);
    predictions.mean.row(p) = target_offset[p] + target_scale[p] * standardised.mean.transpose().array();
    const Eigen::ArrayXd noise_variance =
        gp::getNoiseVariance(processes[p]) * noise.calcFactors(processes[p], p, inputs);
    predictions.stddev.row(p) =
        target_scale[p] * (standardised.latent_variance.array() + noise_variance).sqrt().transpose();
  }
  return predictions;
}

}  // namespace twinmap
