#include "framework/estimation/surrogate/online_surrogate.hpp"

#include "framework/estimation/levels.hpp"
#include "framework/estimation/surrogate/surrogate_file.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const Estimate& OnlineSurrogate::infer(const Eigen::Ref<const VectorXd>& features,
                                       const Eigen::Ref<const VectorXd>& known,
                                       Estimator::Workspace& buffers) const {
  auto& workspace = static_cast<Workspace&>(buffers);
  Estimate& estimate = workspace.estimate;
  estimate.inputs = makeInputs(features, known);
  const Index r = surrogate_->forward->getScoreCount();
  surrogate_->convertMoments(
      workspace.inversion.infer(estimate.inputs.head(r), estimate.inputs.tail(known.size())), estimate.mean,
      estimate.stddev);
  surrogate_->shrinkToPrior(estimate.mean, estimate.stddev);
  estimate.limit_stddev = surrogate_->calcLimit(workspace.inversion.getNoiseStddev());
  return estimate;
}

MatrixXd OnlineSurrogate::listBasins(const Estimator::Workspace& buffers) const {
  const auto& workspace = static_cast<const Workspace&>(buffers);
  const Index u = surrogate_->unknown;
  MatrixXd basins(u, 0);
  for (const ScoreMode& mode : workspace.inversion.getModes()) {
    if (mode.share >= kRareLevel) {
      basins.conservativeResize(u, basins.cols() + 1);
      basins.rightCols<1>() =
          surrogate_->center.head(u) + surrogate_->half_width.head(u).cwiseProduct(mode.moments.mean.head(u));
    }
  }
  return basins;
}

void OnlineSurrogate::save(Hdf5Writer& file, const std::string& group) const {
  writeSurrogate(file, group, *surrogate_);
}

std::shared_ptr<const Estimator> loadSurrogate(const Hdf5Reader& file, const std::string& group) {
  return std::make_shared<const OnlineSurrogate>(
      std::make_shared<const Surrogate>(readSurrogate(file, group)));
}

MatrixXd OnlineSurrogate::makeInputs(const MatrixXd& features, const MatrixXd& known) const {
  const Index q = known.rows();
  MatrixXd inputs(surrogate_->forward->getScoreCount() + q, features.cols());
  inputs.topRows(inputs.rows() - q) = surrogate_->forward->calcScores(features);
  if (q > 0) {
    inputs.bottomRows(q) = (known.colwise() - surrogate_->center.tail(q)).array().colwise() /
                           surrogate_->half_width.tail(q).array();
  }
  return inputs;
}

}  // namespace twinmap
