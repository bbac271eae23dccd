#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/estimation/box_prior.hpp"
#include "framework/estimation/surrogate/leading_scores.hpp"
#include "kernels/surrogate/box_moments.hpp"

namespace twinmap {

/// The point that explains scores best, and what it leaves of them.
struct ScoreExplanation {
  Eigen::VectorXd point;       ///< m, normalised
  Eigen::VectorXd innovation;  ///< L^-1 r with L L' = C: independent, of unit variance, if all is right
  Eigen::VectorXd lower;       ///< L, packed, as in kernels/exact
  Eigen::MatrixXd jacobian;    ///< L^-1 ds / dx, r x u
  Eigen::MatrixXd prior;       ///< u x u, information of the prior as a normal distribution

  /// Of the unknowns: (J'J + prior)^-1, u x u.
  Eigen::MatrixXd calcCovariance() const;
  /// L^-1 of scores (r).
  Eigen::VectorXd whiten(Eigen::VectorXd scores) const;
};

/// A minimum that a ScoreInversion found, as a normal distribution within the box.
struct ScoreMode {
  double share = 0.0;            ///< of the evidence, above 0
  gp::Moments moments;           ///< u
  std::vector<double> widening;  ///< of each window's standard deviations, 1 where they explain the residuals
};

/// Infers normalised unknowns (the first u variables of a point) from scores, under the prior within the box.
///
/// Levenberg and Marquardt's method searches, from the training simulations of most similar scores, the least
///   r' C^-1 r + log det C + 3 (x - m)' P (x - m),   r = scores - s(x),   C = 1 + D R D,
/// with mean m and relative information P of the prior (BoxPrior; 3 |x|^2 where it is uniform), first with
/// the mean error variances alone for C and the scores that say most, then twice with C at the point reached,
/// held, and again while the residuals are beyond it, the errors of the windows to blame enlarged to them. 3
/// is the precision of the box; it keeps the search where the linearisation is worth something. The
/// likelihood, linearised there, with what the prior says beside the bounds, is then restricted to the box
/// (gp::calcBoxMoments). Distinct minima are mixed by their evidence, in Laplace's approximation.
///
/// The search is that of kernels/exact, which exported C contains, too.
///
/// One object a thread: it holds the buffers.
class ScoreInversion {
 public:
  /// `surrogate` must outlive the object. prior: of the unknowns.
  ScoreInversion(const ForwardSurrogate& surrogate, BoxPrior prior);

  /// Mean (u) and covariance (u x u) given scores (r) and normalised known variables (m - u). Cost: some 15
  /// evaluations of the processes, and per minimum two of their variances and of r^3 / 3 flops.
  gp::Moments infer(const Eigen::Ref<const Eigen::VectorXd>& scores,
                    const Eigen::Ref<const Eigen::VectorXd>& known);

  /// Standard deviations (u) that the last infer() would have found at the minimum of most evidence, were
  /// there no error but the noise: of the box moments of J'J, J = ds / dx, and the prior.
  const Eigen::VectorXd& getNoiseStddev() const { return noise_stddev_; }

  /// The distinct minima that the last infer() mixed, the likeliest first.
  const std::vector<ScoreMode>& getModes() const { return modes_; }

  /// The minimum of most evidence that the last infer() found, as explain() would; null where that enlarged
  /// errors. Valid until the next call.
  const ScoreExplanation* findExplanation() const { return explained_ ? &explanation_ : nullptr; }

  /// The minimum of most evidence, searched from `start` (u, normalised; moved into the box), and, if that
  /// explains too little, from the most similar simulations. Errors are not enlarged: what a measurement
  /// contradicts is to be seen. The result is valid until the next call. Cost: some 10 evaluations of the
  /// processes where `start` suffices, else that of infer().
  const ScoreExplanation& explain(const Eigen::Ref<const Eigen::VectorXd>& scores,
                                  const Eigen::Ref<const Eigen::VectorXd>& known,
                                  const Eigen::Ref<const Eigen::VectorXd>& start);

 private:
  /// Of a minimum refined: what a search keeps of the last one only.
  struct Refined {
    Eigen::VectorXd lower;     // L, packed
    Eigen::MatrixXd jacobian;  // L^-1 ds / dx, r x u
    std::vector<double> widening;
  };

  exact::score_problem describeProblem() const;
  exact::score_search beginSearch(const exact::score_problem& problem,
                                  const Eigen::Ref<const Eigen::VectorXd>& scores,
                                  const Eigen::Ref<const Eigen::VectorXd>& known);
  static void evaluate(const exact::score_search* search, int window, int count);
  static void calcStddev(const exact::score_search* search, int window);
  static std::vector<Refined> refine(exact::score_search& search, bool may_widen);
  void keepExplanation(const exact::score_search& search, int index, Refined& refined);
  void keepModes(const exact::score_search& search, std::vector<Refined>& refined);

  const ForwardSurrogate& surrogate_;
  const BoxPrior prior_;
  Eigen::VectorXd rough_weights_, correlation_;
  LeadingScores leading_;
  std::vector<gp::SharedProcess::Workspace> workspaces_;
  std::vector<double> room_;  ///< of searches
  Eigen::VectorXd noise_stddev_;
  ScoreExplanation explanation_;
  std::vector<ScoreMode> modes_;
  bool explained_ = false;
};

}  // namespace twinmap
