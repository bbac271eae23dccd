#include "framework/estimation/posterior/draws/followed_draws.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "framework/estimation/bounded_information.hpp"
#include "framework/estimation/box_points.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/estimation/posterior/draws/linear_posterior.hpp"
#include "framework/experiment/points/prior.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Residuals and minus their derivatives in the surface's coordinates, of one part of it.
struct LinearResponse {
  VectorXd residual;
  MatrixXd jacobian;     ///< of all coordinates
  MatrixXd information;  ///< of its jacobian
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
      MatrixXd information = MatrixXd::Zero(points.rows(), points.rows());
      information(own, own) = slopes(own).asDiagonal() * local.information * slopes(own).asDiagonal();
      columns[static_cast<std::size_t>(i)].push_back(
          {local.residual, std::move(jacobian), std::move(information)});
    }
  }
  return columns;
}

/// The same measurements at fewer times, where all parts can be thinned (MeasuredMisfit::makeThinned).
class ThinnedSurface {
 public:
  explicit ThinnedSurface(const MisfitSurface& whole) {
    std::vector<MeasuredPart> parts;
    for (const MeasuredPart& part : whole.getParts()) {
      misfits_.push_back(part.losses.empty() ? part.misfit->makeThinned() : nullptr);
      if (!misfits_.back()) {
        return;
      }
      parts.push_back({misfits_.back().get(), nullptr, part.unknown});
    }
    surface_.emplace(std::move(parts), whole.getCoordinates(), whole.getPrior());
  }

  MisfitSurface* find() { return surface_ ? &*surface_ : nullptr; }

 private:
  std::vector<std::unique_ptr<MeasuredMisfit>> misfits_;
  std::optional<MisfitSurface> surface_;
};

/// Leads draws of the linear response to where the simulator responds so.
class Follower {
 public:
  Follower(MisfitSurface& surface, const VectorXd& at)
      : surface_(surface), at_(at), center_(linearizeColumns(surface, at_).front()) {}

  /// Moves those columns of `points` that are away from what their draws (columns of `drawn`) ask for, in
  /// steps of Gauss and Newton. Returns those that have not arrived.
  std::vector<Index> lead(const MatrixXd& drawn, std::vector<Index> away, MatrixXd& points) const {
    for (int step = 0; step < kFewIterations && !center_.empty() && !away.empty(); ++step) {
      move(drawn, away, points);
      away = listAway(drawn, away, points);
    }
    return away;
  }

  /// Those of some columns whose response noise would tell from what is asked for.
  std::vector<Index> listAway(const MatrixXd& drawn, const std::vector<Index>& looked_at,
                              const MatrixXd& points) const {
    constexpr double kArrived = 0.25;  // of what chi-square varies by among draws
    const double close = kArrived * std::sqrt(2.0 * static_cast<double>(surface_.getDimensions()));
    const VectorXd excess = calcExcess(drawn(Eigen::all, looked_at), points(Eigen::all, looked_at));
    std::vector<Index> away;
    for (std::size_t i = 0; i < looked_at.size(); ++i) {
      if (!(std::abs(excess[static_cast<Index>(i)]) < close)) {
        away.push_back(looked_at[i]);
      }
    }
    return away;
  }

 private:
  void move(const MatrixXd& drawn, const std::vector<Index>& moved, MatrixXd& points) const {
    const std::size_t most = countTogether();
    for (std::size_t first = 0; first < moved.size(); first += most) {
      const std::size_t end = std::min(first + most, moved.size());
      const std::vector<Index> batch(moved.begin() + static_cast<std::ptrdiff_t>(first),
                                     moved.begin() + static_cast<std::ptrdiff_t>(end));
      const auto columns = linearizeColumns(surface_, points(Eigen::all, batch));
      for (std::size_t i = 0; i < batch.size(); ++i) {
        const VectorXd step = calcStep(columns[i], drawn.col(batch[i]), points.col(batch[i]));
        points.col(batch[i]) = clampToBox(points.col(batch[i]) + step);
      }
    }
  }

  /// Points whose Jacobians are held together.
  std::size_t countTogether() const {
    Index numbers = 1;
    for (const LinearResponse& part : center_) {
      numbers += part.jacobian.size();
    }
    return static_cast<std::size_t>(std::max<Index>(1, kNumbersTogether / numbers));
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

  VectorXd calcWanted(const LinearResponse& center, const VectorXd& drawn) const {
    return center.residual - center.jacobian * (drawn - at_);
  }

  VectorXd calcStep(const std::vector<LinearResponse>& here, const VectorXd& drawn,
                    const VectorXd& point) const {
    if (here.empty()) {
      return VectorXd::Zero(point.size());
    }
    MatrixXd information = addBounds(surface_.linearizePrior(drawn).information);
    VectorXd descent = information * (drawn - point);
    for (std::size_t part = 0; part < here.size(); ++part) {
      information += here[part].information;
      descent += here[part].jacobian.transpose() * (here[part].residual - calcWanted(center_[part], drawn));
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
  const Follower follower(surface, basin.local.at);
  importance::AdaptiveDraws followed = drawLinear(surface, basin, draws, seed);
  MatrixXd& points = followed.draws.points;
  const MatrixXd drawn = points;
  std::vector<Index> away = listIndices(Index{draws});
  ThinnedSurface thinned(surface);
  if (MisfitSurface* few = thinned.find(); few != nullptr) {
    Follower(*few, basin.local.at).lead(drawn, away, points);
    away = follower.listAway(drawn, away, points);
  }
  away = follower.lead(drawn, std::move(away), points);
  const auto arrived = static_cast<double>(draws) - static_cast<double>(away.size());
  followed.draws.weights = VectorXd::Constant(draws, 1.0 / std::max(1.0, arrived));
  followed.draws.weights(away).setZero();
  followed.effective_sample_size = 2.0 * arrived < draws ? 0.0 : arrived;
  return followed;
}

}  // namespace twinmap
