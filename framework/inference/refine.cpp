#include "framework/inference/refine.hpp"

#include <cmath>

#include "framework/features/noise_whitener.hpp"
#include "framework/sensitivity/feature_sensitivities.hpp"
#include "framework/sensitivity/fisher_information.hpp"
#include "framework/spec/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// The features' linear model at a point, whitened, in widths of the bounds.
struct Linearized {
  SampleStatus status;
  VectorXd residual;     // W (measured - simulated)
  MatrixXd information;  // searched parameters
  VectorXd descent;      // J' W' residual
  double chi_square = 0.0;
};

class Refiner {
 public:
  Refiner(const ModelSpec& model, const Simulator& simulator, const FeatureExtractor& extractor,
          const FeatureNoise& noise, const VectorXd& features, const SearchedParameters& searched)
      : unknown_(collectUnknown(model)),
        simulator_(simulator.clone()),
        extractor_(extractor),
        noise_(noise),
        features_(features),
        searched_(searched),
        lower_(calcLowerBounds(unknown_).segment(searched.first, searched.count)),
        widths_(calcWidths(unknown_).segment(searched.first, searched.count)) {}

  Linearized linearize(const VectorXd& point) {
    const LocalModel local = calcLocalModel(*simulator_, extractor_, unknown_, point);
    simulations_ += 2 * static_cast<int>(unknown_.size()) + 1;
    if (!local.status.ok) {
      return {local.status, {}, {}, {}, 0.0};
    }
    const NoiseWhitener whitener(noise_.calcCovariance(local.response));
    const MatrixXd jacobian =
        whitener.apply(local.sensitivities.middleCols(searched_.first, searched_.count));
    Linearized result;
    result.residual = whitener.apply(features_ - local.features);
    result.information = jacobian.transpose() * jacobian;
    result.descent = jacobian.transpose() * result.residual;
    result.chi_square = result.residual.squaredNorm();
    return result;
  }

  /// The Gauss-Newton step in widths, damped a little where the features say nothing.
  VectorXd calcStep(const Linearized& at) const {
    constexpr double kDamping = 1e-6;
    MatrixXd normal = at.information;
    normal.diagonal().array() += kDamping;
    return linalg::solvePositiveDefinite(normal, at.descent);
  }

  /// The point after a step, within the box; the step is cut to what was taken.
  VectorXd move(const VectorXd& point, VectorXd& step) const {
    const auto before = point.segment(searched_.first, searched_.count);
    const VectorXd after = (before + step.cwiseProduct(widths_)).cwiseMax(lower_).cwiseMin(lower_ + widths_);
    step = (after - before).cwiseQuotient(widths_);
    VectorXd moved = point;
    moved.segment(searched_.first, searched_.count) = after;
    return moved;
  }

  VectorXd calcStddev(const Linearized& at) const {
    return calcLimitCovariance(at.information).diagonal().cwiseSqrt().cwiseProduct(widths_);
  }

  /// sqrt(s' I s) of the way between two points.
  double calcDistance(const Linearized& at, const VectorXd& from, const VectorXd& to) const {
    const VectorXd way = (to - from).segment(searched_.first, searched_.count).cwiseQuotient(widths_);
    return std::sqrt(way.dot(at.information * way));
  }

  int getSimulations() const { return simulations_; }

 private:
  const std::vector<ParameterSpec> unknown_;
  const std::unique_ptr<Simulator> simulator_;
  const FeatureExtractor& extractor_;
  const FeatureNoise& noise_;
  const VectorXd& features_;
  const SearchedParameters searched_;
  const VectorXd lower_, widths_;
  int simulations_ = 0;
};

/// One step, halved until it improves the fit. False if none does.
bool improve(Refiner& refiner, Linearized& at, Refined& refined) {
  constexpr int kHalvings = 4;
  constexpr double kSmallStep = 0.1;  // standard deviations
  VectorXd step = refiner.calcStep(at);
  for (int i = 0; i < kHalvings; ++i, step *= 0.5) {
    const VectorXd point = refiner.move(refined.point, step);
    const double length = std::sqrt(step.dot(at.information * step));
    Linearized tried = refiner.linearize(point);
    if (tried.status.ok && (tried.chi_square <= at.chi_square || length < kSmallStep)) {
      at = std::move(tried);
      refined.point = point;
      refined.converged = length < kSmallStep;
      return true;
    }
    refined.status = tried.status;
  }
  return false;
}

}  // namespace

Refined refine(const ModelSpec& model, const Simulator& simulator, const FeatureExtractor& extractor,
               const FeatureNoise& noise, const VectorXd& features, const VectorXd& start,
               const SearchedParameters& searched, int max_steps) {
  Refiner refiner(model, simulator, extractor, noise, features, searched);
  Refined refined;
  VectorXd nowhere = VectorXd::Zero(searched.count);
  refined.point = refiner.move(start, nowhere);
  Linearized at = refiner.linearize(refined.point);
  refined.status = at.status;
  if (!at.status.ok) {
    return refined;
  }
  while (refined.steps < max_steps && !refined.converged && improve(refiner, at, refined)) {
    ++refined.steps;
  }
  if (refined.steps > 0) {
    refined.status = {};
  }
  refined.stddev = refiner.calcStddev(at);
  refined.chi_square = at.chi_square;
  refined.distance = refiner.calcDistance(at, start, refined.point);
  refined.simulations = refiner.getSimulations();
  return refined;
}

}  // namespace twinmap
