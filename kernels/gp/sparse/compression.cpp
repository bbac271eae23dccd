#include "kernels/gp/sparse/compression.hpp"

#include <algorithm>

#include "kernels/gp/sparse/inducing_points.hpp"
#include "kernels/gp/sparse/variational_bound.hpp"
#include "kernels/gp/training_set.hpp"

namespace twinmap::gp {
namespace {

using Eigen::VectorXd;

/// y = (K + s_n^2 I) alpha + H'b = L L' alpha + H'b.
VectorXd restoreTarget(const GaussianProcess& process) {
  const auto factor = process.getFactor().triangularView<Eigen::Lower>();
  const VectorXd half = factor.transpose() * process.getAlpha();
  const Eigen::MatrixXd basis =
      calcMeanBasis(process.getStructure().mean, process.getInputs().colwise() - process.getCenter());
  return factor * half + basis * process.getMeanCoefficients();
}

}  // namespace

std::shared_ptr<const SparseGaussianProcess> compress(const GaussianProcess& process, double tolerance,
                                                      InputStorage storage) {
  constexpr double kLoosest = 0.1;  // of the signal: a process that is nearly all noise keeps some points
  if (process.getStructure().linear_term) {
    return nullptr;
  }
  const Hyperparameters& hyperparameters = process.getHyperparameters();
  const double noise_ratio = hyperparameters.noise_stddev / hyperparameters.signal_stddev;
  const Eigen::Index most = process.getSampleCount() / 2;
  SparseGaussianProcessParts parts{
      process.getStructure(),
      hyperparameters,
      process.getCenter(),
      chooseInducingPoints(process.getInputs(), process.getStructure(), hyperparameters, most + 1,
                           std::min(tolerance * noise_ratio * noise_ratio, kLoosest)),
      {}};
  if (parts.inducing.cols() > most) {
    return nullptr;
  }
  if (storage == InputStorage::kSingle) {
    parts.inducing = parts.inducing.cast<float>().cast<double>().eval();
  }
  const VectorXd target = restoreTarget(process);
  const VariationalBound bound(process.getInputs(), target, parts.inducing, parts.structure);
  if (!bound.calcPosterior(hyperparameters, parts.posterior)) {
    return nullptr;
  }
  return std::make_shared<const SparseGaussianProcess>(std::move(parts));
}

}  // namespace twinmap::gp
