#include "framework/estimation/posterior/draws/followed_draws.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "framework/estimation/posterior/draws/linear_posterior.hpp"
#include "framework/experiment/points/prior.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Residuals and minus their derivatives in the surface's coordinates, of one part of it.
struct LinearResponse {
  VectorXd residual;
  MatrixXd jacobian;  ///< of all coordinates
};

/// Of each column its parts; no parts where it cannot be simulated.
std::vector<std::vector<LinearResponse>> linearizeColumns(MisfitSurface& surface, const MatrixXd& points) {
  std::vector<std::vector<LinearResponse>> columns(static_cast<std::size_t>(points.cols()));
  const std::vector<std::vector<LocalMisfit>> locals = surface.linearizeEach(surface.toBox(points));
  for (Index i = 0; i < points.cols(); ++i) {
    const VectorXd slopes = surface.getCoordinates().calcSlopes(points.col(i));
    for (std::size_t part = 0; part < locals.size(); ++part) {
      const LocalMisfit& local = locals[part][static_cast<std::size_t>(i)];
      if (!local.status.ok || !local.jacobian.allFinite()) {
        columns[static_cast<std::size_t>(i)].clear();
        break;
      }
      const std::vector<Index>& own = surface.getParts()[part].unknown;
      MatrixXd jacobian = MatrixXd::Zero(local.jacobian.rows(), points.rows());
      jacobian(Eigen::all, own) = local.jacobian * slopes(own).asDiagonal();
      columns[static_cast<std::size_t>(i)].push_back({local.residual, std::move(jacobian)});
    }
  }
  return columns;
}

/// Leads draws of the linear response to where the simulator responds so.
class Follower {
 public:
  Follower(MisfitSurface& surface, const Basin& basin)
      : surface_(surface), at_(basin.local.at), center_(linearizeColumns(surface, at_).front()) {}

  bool isKnown() const { return !center_.empty(); }

  /// One step of Gauss and Newton of some columns towards what their draws (columns of `drawn`) ask for.
  void move(const MatrixXd& drawn, const std::vector<Index>& moved, MatrixXd& points) const {
    constexpr std::size_t kBatch = 8;  // Jacobians in memory at a time
    for (std::size_t first = 0; first < moved.size(); first += kBatch) {
      const std::size_t end = std::min(first + kBatch, moved.size());
      const std::vector<Index> batch(moved.begin() + static_cast<std::ptrdiff_t>(first),
                                     moved.begin() + static_cast<std::ptrdiff_t>(end));
      const auto columns = linearizeColumns(surface_, points(Eigen::all, batch));
      for (std::size_t i = 0; i < batch.size(); ++i) {
        const VectorXd step = calcStep(columns[i], drawn.col(batch[i]), points.col(batch[i]));
        points.col(batch[i]) = (points.col(batch[i]) + step).cwiseMax(-1.0).cwiseMin(1.0);
      }
    }
  }

  /// What the responses at points leave of what is asked for, in noise standard deviations (n); infinite
  /// where one cannot be simulated.
  VectorXd calcExcess(const MatrixXd& drawn, const MatrixXd& points) const {
    VectorXd excess = surface_.calcMisfits(points);
    for (Index i = 0; i < points.cols(); ++i) {
      excess[i] -= surface_.linearizePrior(points.col(i)).misfit;
      for (const LinearResponse& part : center_) {
        excess[i] -= calcWanted(part, drawn.col(i)).squaredNorm();
      }
    }
    return excess;
  }

 private:
  VectorXd calcWanted(const LinearResponse& center, const VectorXd& drawn) const {
    return center.residual - center.jacobian * (drawn - at_);
  }

  VectorXd calcStep(const std::vector<LinearResponse>& here, const VectorXd& drawn,
                    const VectorXd& point) const {
    if (here.empty()) {
      return VectorXd::Zero(point.size());
    }
    MatrixXd information = surface_.linearizePrior(drawn).information;
    information.diagonal().array() += kHalfWidthInformation;
    VectorXd descent = information * (drawn - point);
    for (std::size_t part = 0; part < here.size(); ++part) {
      const MatrixXd& jacobian = here[part].jacobian;
      information += jacobian.transpose() * jacobian;
      descent += jacobian.transpose() * (here[part].residual - calcWanted(center_[part], drawn));
    }
    return linalg::solvePositiveDefinite(information, descent);
  }

  MisfitSurface& surface_;
  const VectorXd at_;
  const std::vector<LinearResponse> center_;
};

}  // namespace

importance::AdaptiveDraws drawFollowed(MisfitSurface& surface, const Basin& basin, int draws,
                                       std::uint64_t seed) {
  constexpr int kSteps = 5;
  constexpr double kArrived = 0.25;  // of what chi-square varies by among draws
  const double close = kArrived * std::sqrt(2.0 * static_cast<double>(surface.getDimensions()));
  const Follower follower(surface, basin);
  importance::AdaptiveDraws followed = drawLinear(surface, basin, draws, seed);
  const MatrixXd drawn = followed.draws.points;
  std::vector<Index> away(static_cast<std::size_t>(draws));
  std::iota(away.begin(), away.end(), Index{0});
  for (int step = 0; step < kSteps && follower.isKnown() && !away.empty(); ++step) {
    follower.move(drawn, away, followed.draws.points);
    const VectorXd excess =
        follower.calcExcess(drawn(Eigen::all, away), followed.draws.points(Eigen::all, away));
    std::vector<Index> still;
    for (std::size_t i = 0; i < away.size(); ++i) {
      if (!(std::abs(excess[static_cast<Index>(i)]) < close)) {
        still.push_back(away[i]);
      }
    }
    away = std::move(still);
  }
  const auto arrived = static_cast<double>(draws) - static_cast<double>(away.size());
  followed.draws.weights = VectorXd::Constant(draws, 1.0 / std::max(1.0, arrived));
  followed.draws.weights(away).setZero();
  followed.effective_sample_size = 2.0 * arrived < draws ? 0.0 : arrived;
  return followed;
}

}  // namespace twinmap
