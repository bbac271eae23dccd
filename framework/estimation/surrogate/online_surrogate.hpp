#pragma once

#include <memory>

#include "framework/estimation/estimate.hpp"
#include "framework/estimation/surrogate/score_inversion.hpp"
#include "framework/estimation/surrogate/surrogate.hpp"

namespace twinmap {

/// A surrogate made ready for one measurement after another. Estimates are those of the surrogate, bit for
/// bit. Immutable.
class OnlineSurrogate {
 public:
  explicit OnlineSurrogate(std::shared_ptr<const Surrogate> surrogate) : surrogate_(std::move(surrogate)) {}

  const Surrogate& getSurrogate() const { return *surrogate_; }

  /// The buffers of one thread, and the result.
  class Workspace {
   public:
    explicit Workspace(const OnlineSurrogate& map)
        : inversion(*map.surrogate_->forward, map.surrogate_->prior) {
      estimate.method = EstimationMethod::kSurrogate;
      estimate.correlation = map.surrogate_->validation.residual_correlation;
    }
    Estimate estimate;
    const ScoreExplanation* findExplanation() const { return inversion.findExplanation(); }

   private:
    friend class OnlineSurrogate;
    ScoreInversion inversion;
  };

  /// features: d, finite; known: the inputs of the set-up (q). The result, whose inputs are the scores and
  /// the normalised known inputs, lies in the workspace until its next use. Cost: that of
  /// ScoreInversion::infer().
  const Estimate& infer(const Eigen::Ref<const Eigen::VectorXd>& features,
                        const Eigen::Ref<const Eigen::VectorXd>& known, Workspace& workspace) const;

  /// The minima of the last inference (u x n, in the parameters' units), the likeliest first, those of less
  /// than a thousandth of the evidence left out.
  Eigen::MatrixXd listBasins(const Workspace& workspace) const;

  /// What the inferences' inputs are for features (d x n) and known inputs (q x n).
  Eigen::MatrixXd makeInputs(const Eigen::MatrixXd& features, const Eigen::MatrixXd& known) const;

 private:
  std::shared_ptr<const Surrogate> surrogate_;
};

}  // namespace twinmap
