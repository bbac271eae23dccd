#include "framework/estimation/estimator.hpp"

#include <stdexcept>

#include "framework/estimation/run_tasks.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd Estimator::getProjection() const {
  return {};
}

MatrixXd Estimator::listBasins(const Workspace& /*workspace*/) const {
  return {};
}

Estimates Estimator::predict(const Eigen::Ref<const MatrixXd>& features,
                             const Eigen::Ref<const MatrixXd>& known, int threads) const {
  if (features.rows() != countFeatures() || known.rows() != countKnown() ||
      (countKnown() > 0 && known.cols() != features.cols())) {
    throw std::invalid_argument("features or known inputs are of other sizes than the map's");
  }
  const Index count = features.cols(), parameters = getResidualCorrelation().rows();
  Estimates all{MatrixXd(parameters, count), MatrixXd(parameters, count)};
  all.correlations.resize(givesCorrelations() ? static_cast<std::size_t>(count) : 0);
  all.mixtures.resize(givesMixtures() ? static_cast<std::size_t>(count) : 0);
  all.interval_factors = replicate(getIntervalFactors(), count);
  runChunks(threads, count, [&](Index first, Index end) {
    const std::unique_ptr<Workspace> workspace = makeWorkspace();
    VectorXd settings(known.rows());
    for (Index i = first; i < end; ++i) {
      if (settings.size() > 0) {
        settings = known.col(i);
      }
      const Estimate& estimate = infer(features.col(i), settings, *workspace);
      all.mean.col(i) = estimate.mean;
      all.stddev.col(i) = estimate.stddev;
      if (estimate.mixture.isGiven()) {
        all.mixtures[static_cast<std::size_t>(i)] = estimate.mixture;
      }
      if (!all.correlations.empty()) {
        all.correlations[static_cast<std::size_t>(i)] = estimate.correlation;
      }
    }
  });
  return all;
}

}  // namespace twinmap
