#include "framework/online/forward_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "framework/features/noise_whitener.hpp"
#include "framework/features/principal_components.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kBeyondBox = 1.25;  // of the half width: the interpolator holds a little outside too

Index countComponents(const VectorXd& variances, Index simulations) {
  constexpr double kSmallestStddev = 0.2;
  constexpr Index kMost = 60;
  const Index above = (variances.array() > kSmallestStddev * kSmallestStddev).count();
  return std::clamp<Index>(above, 1, std::min(kMost, std::max<Index>(simulations / 3, 1)));
}

/// 1 / sqrt(1 + error variance of the interpolation) of each score.
ArrayXd calcScoreWeights(const ForwardModel& model) {
  return (1.0 + model.score_map.getParts().left_out_variance.array()).rsqrt();
}

/// One search; all matrices live in the workspace.
class Search {
 public:
  Search(const ForwardModel& model, Index unknown, ExplanationWorkspace& workspace)
      : model_(model), weights_(calcScoreWeights(model)), unknown_(unknown), workspace_(workspace) {}

  /// Improves `point` and leaves its weighted misfit in the workspace; returns its square.
  double improve(VectorXd& point) {
    constexpr int kMostSteps = 15;
    constexpr double kGain = 1e-3;
    double damping = 1e-6;
    double square = evaluate(point);
    for (int i = 0; i < kMostSteps; ++i) {
      linearize();
      const double before = square;
      if (!step(point, square, damping)) {
        return evaluate(point);
      }
      if (before - square < kGain) {
        break;
      }
    }
    return square;
  }

 private:
  /// Weighted misfit of the scores at a point; its jacobian is left in workspace.forward.
  double evaluate(const VectorXd& point) {
    model_.score_map.evaluate(point, workspace_.forward);
    workspace_.misfit = weights_ * (workspace_.scores - workspace_.forward.values).array();
    return workspace_.misfit.squaredNorm();
  }

  void linearize() {
    workspace_.jacobian = workspace_.forward.jacobian.leftCols(unknown_).array().colwise() * weights_;
    workspace_.gradient.noalias() = workspace_.jacobian.transpose() * workspace_.misfit;
    workspace_.normal.noalias() = workspace_.jacobian.transpose().lazyProduct(workspace_.jacobian);  // small
  }

  /// Tries steps with more and more damping until one improves the point.
  bool step(VectorXd& point, double& square, double& damping) {
    constexpr double kFactor = 10.0, kMostDamping = 1e6, kFloor = 1e-6;
    for (; damping < kMostDamping; damping *= kFactor) {
      MatrixXd damped = workspace_.normal;
      damped.diagonal().array() += damping * damped.diagonal().array() + kFloor;
      workspace_.step = linalg::solvePositiveDefinite(damped, workspace_.gradient);
      workspace_.trial = point;
      workspace_.trial.head(unknown_) =
          (point.head(unknown_) + workspace_.step).cwiseMax(-kBeyondBox).cwiseMin(kBeyondBox);
      const double tried = evaluate(workspace_.trial);
      if (tried < square) {
        point = workspace_.trial;
        square = tried;
        damping = std::max(damping / kFactor, kFloor);
        return true;
      }
    }
    return false;
  }

  const ForwardModel& model_;
  const ArrayXd weights_;
  Index unknown_;
  ExplanationWorkspace& workspace_;
};

/// The training simulation whose scores are most similar.
Index findSimilar(const ForwardModel& model, const VectorXd& scores) {
  const ArrayXd weights = calcScoreWeights(model);
  Index similar = 0;
  ((model.scores.colwise() - scores).array().colwise() * weights)
      .matrix()
      .colwise()
      .squaredNorm()
      .minCoeff(&similar);
  return similar;
}

/// What the components do not span, plus the weighted misfit of the scores.
void completeResidual(const ForwardModel& model, ExplanationWorkspace& workspace) {
  Explanation& best = workspace.best;
  best.residual = workspace.whitened;
  best.residual.noalias() -= model.components * (workspace.scores - workspace.misfit);
  best.chi_square = best.residual.squaredNorm();
}

}  // namespace

void ForwardModel::whiten(const Eigen::Ref<const VectorXd>& features, VectorXd& whitened) const {
  if (whitener.cols() == 1) {
    whitened = whitener.col(0).cwiseProduct(features - center);
  } else {
    whitened.noalias() = whitener * (features - center);
  }
}

ForwardModel fitForwardModel(const MatrixXd& points, const MatrixXd& clean_features,
                             const MatrixXd& noise_covariance) {
  constexpr Index kMostSimulations = 1000;
  const Index n = std::min(points.cols(), kMostSimulations);
  if (n < points.rows() + 3) {
    throw std::invalid_argument("a forward model needs more simulations than parameters");
  }
  const NoiseWhitener noise(noise_covariance);
  const VectorXd center = clean_features.leftCols(n).rowwise().mean();
  const MatrixXd whitened = noise.apply(clean_features.leftCols(n).colwise() - center);
  const PrincipalComponents components = calcPrincipalComponents(whitened);
  const MatrixXd kept = components.directions.leftCols(countComponents(components.variances, n));
  const MatrixXd scores = kept.transpose() * whitened;
  const bool diagonal = noise_covariance.isDiagonal(0.0);
  return {diagonal ? MatrixXd(noise.getMatrix().diagonal()) : noise.getMatrix(), center, kept, scores,
          gp::fitInterpolator(points.leftCols(n), scores)};
}

const Explanation& explain(const ForwardModel& model, const Eigen::Ref<const VectorXd>& features,
                           const Eigen::Ref<const VectorXd>& start, Index unknown,
                           ExplanationWorkspace& workspace) {
  model.whiten(features, workspace.whitened);
  workspace.scores.noalias() = model.components.transpose() * workspace.whitened;
  Search search(model, unknown, workspace);
  Explanation& best = workspace.best;
  best.point = start.cwiseMax(-kBeyondBox).cwiseMin(kBeyondBox);
  double square = search.improve(best.point);
  const double expected = static_cast<double>(model.components.cols());
  if (!(square < expected + 3.0 * std::sqrt(2.0 * expected))) {
    Explanation& other = workspace.other;
    other.point = best.point;
    other.point.head(unknown) =
        model.score_map.getParts().points.col(findSimilar(model, workspace.scores)).head(unknown);
    if (search.improve(other.point) < square) {
      best.point = other.point;
    }
    square = search.improve(best.point);
  }
  completeResidual(model, workspace);
  return best;
}

}  // namespace twinmap
