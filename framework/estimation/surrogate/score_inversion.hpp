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
/// What decides where the search looks is computed by kernels/exact, so that exported C looks there, too.
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
  /// What residuals are divided by: standard deviations, or a Cholesky factor of their covariance.
  struct Metric {
    Eigen::ArrayXd weights;
    Eigen::VectorXd lower;  ///< packed, as in kernels/exact
    double log_determinant = 0.0;
    bool diagonal = true;
    std::vector<Eigen::Index> counts;  ///< of each window, the first scores that take part; empty: all do

    Eigen::Index count(std::size_t window, const gp::SharedProcess& process) const {
      return counts.empty() ? process.getFunctionCount() : counts[window];
    }
  };
  /// A minimum and the normal likelihood around it.
  struct Minimum {
    Eigen::VectorXd point;  // u
    double objective = 0.0;
    Eigen::VectorXd residual;           // L^-1 r, r
    Eigen::VectorXd lower;              // L, packed
    Eigen::MatrixXd jacobian;           // L^-1 ds / dx, r x u
    Eigen::MatrixXd information;        // u x u
    Eigen::MatrixXd noise_information;  // the same without the surrogate's errors
    Eigen::VectorXd shift;              // u
    bool widened = false;
    std::vector<double> widening;
  };
  /// A search under way.
  struct Descent {
    double objective;
    double damping = 1e-3;
  };
  /// Of which scores values_ and jacobian_ are those at point_.
  enum class Evaluated { kNone, kLeading, kAll };

  std::vector<Eigen::VectorXd> findStarts() const;
  void evaluate(const Metric& metric, const Eigen::VectorXd& unknown);
  double calcObjective(const Metric& metric, const Eigen::VectorXd& unknown);
  void makeNormalEquations(const Metric& metric);
  bool step(const Metric& metric, Eigen::VectorXd& unknown, Descent& descent);
  bool advance(const Metric& metric, Eigen::VectorXd& unknown, Descent& descent);
  bool moveOn(const Metric& metric, Eigen::VectorXd& unknown, Descent& descent);
  void calcPull(const Eigen::VectorXd& unknown);
  double predictGain(const Eigen::VectorXd& unknown);
  bool solveStep(const Eigen::VectorXd& unknown, double damping);
  double improve(const Metric& metric, int steps, Eigen::VectorXd& unknown);
  void updateMetric(const Eigen::VectorXd& unknown, Metric& metric);
  std::vector<Minimum> searchRoughly(const std::vector<Eigen::VectorXd>& starts);
  bool widen(const Metric& metric, const Eigen::VectorXd& unknown);
  void refine(Minimum& minimum, bool may_widen);
  void keepExplanation(Minimum& minimum);
  void keepModes(const std::vector<Minimum>& minima, const std::vector<gp::Moments>& parts,
                 const Eigen::VectorXd& shares);
  static bool hasEarlierTwin(const std::vector<Minimum>& minima, std::size_t index);

  const ForwardSurrogate& surrogate_;
  const BoxPrior prior_;
  const Eigen::Index unknown_;
  Metric rough_, leading_;
  Evaluated evaluated_ = Evaluated::kNone;
  std::vector<gp::SharedProcess::Workspace> workspaces_;
  std::vector<double> widening_;  ///< of each window's standard deviations
  Eigen::VectorXd scores_, point_, values_, residual_, stddev_, gradient_, noise_stddev_;
  Eigen::VectorXd step_, offset_, pull_;
  Eigen::MatrixXd jacobian_, scaled_jacobian_, normal_, small_;
  ScoreExplanation explanation_;
  std::vector<ScoreMode> modes_;
  bool explained_ = false;
};

}  // namespace twinmap
