#include "kernels/gp/online/process_view.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::VectorXd;

bool ProcessView::sharesInputs(const ProcessView& other) const {
  return (&inputs == &other.inputs || (inputs.cols() == other.inputs.cols() && inputs == other.inputs)) &&
         mean.getCenter() == other.mean.getCenter();
}

VectorXd ProcessView::calcConstantGradient() const {
  VectorXd gradient = VectorXd::Zero(inputs.rows());
  if (structure.linear_term) {
    const double variance = hyperparameters.linear_stddev * hyperparameters.linear_stddev;
    gradient = variance * (inputs.colwise() - mean.getCenter()) * weights;
  }
  if (structure.mean == MeanFunction::kLinear) {
    gradient += mean_coefficients.tail(inputs.rows());
  }
  return gradient;
}

ProcessView viewProcess(const Process& process) {
  if (const auto* exact = std::get_if<std::shared_ptr<const GaussianProcess>>(&process)) {
    const GaussianProcess& gp = **exact;
    return {gp.getStructure(),   gp.getHyperparameters(), gp.getMean(), gp.getInputs(),
            gp.getAlpha(),       gp.getFactor(),          nullptr,      gp.getWhitenedBasis(),
            gp.getBasisFactor(), gp.getMeanCoefficients()};
  }
  const SparseGaussianProcess& gp = *std::get<std::shared_ptr<const SparseGaussianProcess>>(process);
  const SparseGaussianProcessParts& parts = gp.getParts();
  const VariationalPosterior& posterior = parts.posterior;
  return {parts.structure,
          parts.hyperparameters,
          gp.getMean(),
          parts.inducing,
          posterior.weights,
          posterior.inducing_factor,
          &posterior.correction_factor,
          posterior.whitened_basis / parts.hyperparameters.noise_stddev,
          posterior.basis_factor,
          posterior.mean_coefficients};
}

double getNlml(const Process& process) {
  if (const auto* exact = std::get_if<std::shared_ptr<const GaussianProcess>>(&process)) {
    return (*exact)->getNlml();
  }
  return std::get<std::shared_ptr<const SparseGaussianProcess>>(process)->getParts().posterior.bound;
}

double getNoiseVariance(const Process& process) {
  const double stddev =
      std::visit([](const auto& trained) { return trained->getHyperparameters().noise_stddev; }, process);
  return stddev * stddev;
}

}  // namespace twinmap::gp
