#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "framework/estimation/log_coordinates.hpp"
#include "framework/estimation/posterior/noise/residual_loss.hpp"
#include "framework/estimation/refined/measured_misfit.hpp"
#include "framework/experiment/points/prior.hpp"

namespace twinmap {

/// chi-square and its linear model at a point, in LogCoordinates: with the whitened residual r, weighted, and
/// its derivatives -J, and the prior's misfit beside it,
///   misfit(at + step) ~ misfit - 2 step' descent + step' information step.
struct LocalSurface {
  bool simulated = false;  ///< if not, the rest is empty
  Eigen::VectorXd at;      ///< u
  double chi_square = 0.0;
  double loss = 0.0;           ///< chi-square where the loss is plain
  double misfit = 0.0;         ///< loss and the prior's misfit, which is 0 where it is uniform
  double degrees = 0.0;        ///< of freedom: residuals less the parameters that they determine
  Eigen::Index residuals = 0;  ///< independent ones
  Eigen::MatrixXd information;
  Eigen::VectorXd descent;
  Eigen::VectorXd residual;  ///< whitened; of one measurement after the other
  Eigen::VectorXd weights;   ///< 1 but for outliers (LinearLoss::weights)
};

/// One measurement of those that a surface explains together.
struct MeasuredPart {
  MeasuredMisfit* misfit;             ///< of all unknown parameters of its trial
  const RefinementModel* model;       ///< of its trial; null: without windows and hypotheses
  std::vector<Eigen::Index> unknown;  ///< which of all unknown parameters these are
  /// Of each of the model's windows; empty: a sum of squares.
  std::vector<ResidualLoss> losses{};
  std::size_t window = 0;  ///< at which it looks, where it has losses
};

/// How well simulators explain one or several measurements of one machine, over the box of all unknown
/// parameters in LogCoordinates. For one thread.
class MisfitSurface {
 public:
  /// Coordinates and prior, of all unknown parameters, and what the parts point to must outlive the object.
  /// side_by_side: whether parts are simulated each by a thread; none may share a simulator with another.
  MisfitSurface(std::vector<MeasuredPart> parts, const LogCoordinates& coordinates, const Prior& prior,
                bool side_by_side = false)
      : parts_(std::move(parts)), coordinates_(coordinates), prior_(prior), side_by_side_(side_by_side) {
    for (MeasuredPart& part : parts_) {
      part.window = part.losses.empty() ? 0 : part.losses.size() - 1;
    }
  }

  Eigen::Index getDimensions() const { return coordinates_.getCount(); }
  int getSimulations() const;
  const LogCoordinates& getCoordinates() const { return coordinates_; }
  const std::vector<MeasuredPart>& getParts() const { return parts_; }
  const Prior& getPrior() const { return prior_; }

  /// Of the parts' windows (RefinementModel::getWindows), as many as the one with the most has.
  std::size_t countWindows() const;
  /// Every part looks at its window of that number from now on, its last one where it has fewer.
  void setWindow(std::size_t window);
  /// Whether every part looks at its last window.
  bool seesAll() const { return sees_all_; }

  /// Points (u x n) in half-widths of the bounds, as the parts take them.
  Eigen::MatrixXd toBox(const Eigen::MatrixXd& points) const;
  /// Of each part its misfit at all columns of `box` (toBox), with derivatives.
  std::vector<std::vector<LocalMisfit>> linearizeEach(const Eigen::MatrixXd& box);
  /// At all columns of `points` (u x n), one batch of each part, with derivatives.
  std::vector<LocalSurface> linearize(const Eigen::MatrixXd& points);
  /// What linearize() says where another surface of the same measurements has been linearised, in other
  /// coordinates: nothing is simulated.
  LocalSurface convert(const LocalSurface& local, const MisfitSurface& from) const;
  /// LocalSurface::misfit (n), infinite where a simulation fails; one batch of each part. After linearize().
  Eigen::VectorXd calcMisfits(const Eigen::MatrixXd& points);
  /// log of the posterior density (n) in these coordinates, but for a summand: normal noise, -infinity
  /// outside the bounds, where nothing is simulated.
  Eigen::VectorXd calcLogPosteriors(const Eigen::MatrixXd& points);
  /// The prior's misfit and its linear model at a point, in these coordinates.
  PriorMisfit linearizePrior(const Eigen::VectorXd& at) const;
  /// Points of [-1, 1]^u (u x n) as uniform numbers from which those of the prior follow.
  Eigen::MatrixXd spreadAsPrior(const Eigen::MatrixXd& points) const;
  /// log of the prior's density in these coordinates, but for a summand.
  double calcLogPrior(const Eigen::VectorXd& point) const {
    return coordinates_.calcLogUniform(point) + prior_.calcLogDensity(coordinates_.toParameters(point));
  }

 private:
  void visitParts(const std::function<void(std::size_t part)>& visit) const;
  Eigen::VectorXd calcLosses(const Eigen::MatrixXd& points);
  void addPrior(LocalSurface& surface) const;

  std::vector<MeasuredPart> parts_;
  const LogCoordinates& coordinates_;
  const Prior& prior_;
  const bool side_by_side_;
  bool sees_all_ = true;
};

}  // namespace twinmap
