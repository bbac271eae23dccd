#include "framework/estimation/posterior/draws/marginal_surface.hpp"

#include <algorithm>
#include <limits>

#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// The information of some coordinates with the box as a normal distribution, factorised: what a recording
/// does not determine keeps the width of its bounds.
MatrixXd factorize(const MatrixXd& information, const std::vector<Index>& coordinates) {
  MatrixXd own = information(coordinates, coordinates);
  own.diagonal().array() += kHalfWidthInformation;
  return linalg::calcCholesky(own).lower;
}

}  // namespace

MarginalSurface::MarginalSurface(MisfitSurface& surface, std::vector<Index> kept,
                                 const std::vector<Basin>& basins)
    : surface_(surface), kept_(std::move(kept)) {
  for (Index j = 0; j < surface.getDimensions(); ++j) {
    if (!std::binary_search(kept_.begin(), kept_.end(), j)) {
      others_.push_back(j);
    }
  }
  const auto k = static_cast<Index>(kept_.size());
  for (const Basin& basin : basins) {
    const MatrixXd lower = factorize(basin.local.information, others_);
    predictions_.push_back({basin.local.at(kept_), basin.local.at(others_),
                            -linalg::solveCholesky(lower, basin.local.information(others_, kept_)),
                            linalg::solveCholesky(linalg::calcCholesky(basin.covariance(kept_, kept_)).lower,
                                                  MatrixXd::Identity(k, k))});
  }
}

VectorXd MarginalSurface::predict(const VectorXd& kept) const {
  const Prediction* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Prediction& prediction : predictions_) {
    const VectorXd apart = kept - prediction.kept_at;
    if (const double distance = apart.dot(prediction.inverse * apart); distance < least) {
      least = distance;
      nearest = &prediction;
    }
  }
  return (nearest->other_at + nearest->slopes * (kept - nearest->kept_at)).cwiseMax(-1.0).cwiseMin(1.0);
}

double MarginalSurface::integrate(const LocalSurface& local) const {
  if (!local.simulated) {
    return -std::numeric_limits<double>::infinity();
  }
  const MatrixXd lower = factorize(local.information, others_);
  const double gain = linalg::solveLower(lower, local.descent(others_)).squaredNorm();
  return -0.5 * (local.loss - gain) - lower.diagonal().array().log().sum() + surface_.calcLogPrior(local.at);
}

VectorXd MarginalSurface::calcLogPosteriors(const MatrixXd& points) {
  std::vector<Index> inside;
  for (Index i = 0; i < points.cols(); ++i) {
    if (points.col(i).cwiseAbs().maxCoeff() <= 1.0) {
      inside.push_back(i);
    }
  }
  VectorXd logs = VectorXd::Constant(points.cols(), -std::numeric_limits<double>::infinity());
  if (inside.empty()) {
    return logs;
  }
  MatrixXd whole(surface_.getDimensions(), static_cast<Index>(inside.size()));
  for (Index i = 0; i < whole.cols(); ++i) {
    const VectorXd kept = points.col(inside[static_cast<std::size_t>(i)]);
    whole(kept_, i) = kept;
    whole(others_, i) = predict(kept);
  }
  const std::vector<LocalSurface> predicted = surface_.linearize(whole);
  for (Index i = 0; i < whole.cols(); ++i) {
    const LocalSurface& local = predicted[static_cast<std::size_t>(i)];
    if (local.simulated) {
      const VectorXd step =
          linalg::solveCholesky(factorize(local.information, others_), local.descent(others_));
      whole(others_, i) = (local.at(others_) + step).cwiseMax(-1.0).cwiseMin(1.0);
    }
  }
  const std::vector<LocalSurface> improved = surface_.linearize(whole);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    logs[inside[i]] = integrate(improved[i]);
  }
  return logs;
}

}  // namespace twinmap
