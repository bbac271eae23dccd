#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinmap {

/// What log evidences differ by where they do not tell terms apart: 20 to 1.
constexpr double kTiedEvidence = 3.0;

/// What a term would explain of a residual beside what the parameters can take up (Rao's score test; Rao
/// 1948), by the linear model at a fit.
struct TermScore {
  bool visible = false;      ///< whether the parameters do not take it up whole; if not, the rest is 0
  double estimate = 0.0;     ///< of its coefficient
  double stddev = 0.0;       ///< of the estimate
  double z = 0.0;            ///< estimate / stddev: normal with variance 1 where the term is absent
  Eigen::VectorXd shifts{};  ///< u: how the parameters move where the term has the estimate
};

/// The terms of a model at a fit, with what the parameters explain projected out.
class ScoreTest {
 public:
  /// residual: n, in noise standard deviations; jacobian: n x u, of the parameters; terms: n x k, of the
  /// terms' coefficients. Cost: 2 n u^2 + 4 n u k flops.
  ScoreTest(const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian, const Eigen::MatrixXd& terms);

  /// size: of a coefficient that matters, which decides what is visible: a term that moves the response by
  /// less than a tenth of the noise in all, or of which the parameters take up all but a thousandth, as much
  /// as the integration's error leaves of one that is a parameter, is not.
  TermScore calcScore(Eigen::Index term, double size) const;

  /// u: how the parameters move where a term has a coefficient.
  Eigen::VectorXd calcShifts(Eigen::Index term, double coefficient) const {
    return -coefficient * taken_up_.col(term);
  }

  /// Length of what a term of coefficient 1 does besides the parameters, in noise standard deviations.
  double calcLength(Eigen::Index term) const { return terms_.col(term).norm(); }

  /// What several terms (k) explain together, by least squares.
  struct JointScore {
    double gain = 0.0;          ///< of chi-square
    Eigen::VectorXd estimates;  ///< k; empty where the terms are not distinct
    Eigen::VectorXd stddevs;    ///< k, each where those behind it are absent
    Eigen::VectorXd shifts;     ///< u: how the parameters move
  };
  JointScore calcJointScore(const std::vector<Eigen::Index>& terms) const;

  /// What each two terms take from chi-square together (k x k, above the diagonal); 0 of those that are
  /// alike.
  Eigen::MatrixXd calcPairGains() const;

  /// Cosine between what two terms do besides the parameters: 1 where one test cannot tell them apart.
  double calcLikeness(Eigen::Index a, Eigen::Index b) const;

  /// Standard deviation of a term's coefficient where noise is as the residual that remains with it, which is
  /// no smaller than stated and may follow itself: a lag-one autoregression and a size for each sequence of
  /// neighbours. starts: the first residual of each sequence, ascending.
  double calcCautiousStddev(Eigen::Index term, const std::vector<Eigen::Index>& starts) const;

 private:
  const Eigen::MatrixXd jacobian_;  ///< scaled to columns of length 1
  Eigen::VectorXd lengths_;         ///< of its columns before
  const Eigen::MatrixXd given_;
  Eigen::VectorXd residual_;  ///< less what the parameters explain
  Eigen::MatrixXd terms_;     ///< likewise
  Eigen::MatrixXd taken_up_;  ///< u x k: by which parameters
};

/// Two-sided p-value of a standard normal z; of the largest of `tests`, by Bonferroni's bound.
double calcPValue(double z, int tests);

/// The p-value of the largest of `tests` gains of chi-square by two coefficients, likewise.
double calcPairPValue(double gain, double tests);

/// The |z| that the largest of `tests` exceeds with a probability of at most `level` where nothing is
/// missing.
double calcCriticalZ(double level, int tests);

/// log of the evidence for a coefficient that takes `gain` from chi-square and has the sd `stddev`, by a
/// prior that is normal about 0 with the sd `size`, against its absence: Laplace's approximation, exact where
/// the model is linear.
double calcLogEvidence(double gain, double stddev, double size);

/// Of a coefficient of any size up to one that matters: its prior is normal about 0 with an sd between `size`
/// (or the estimate, where that is larger) and a billionth of it, each order of magnitude as likely, so that
/// what decides between terms is how well they explain and not how small their coefficients are beside
/// `size`. Laplace's approximation, exact where gain = (estimate / stddev)^2.
struct SizedCoefficient {
  double estimate = 0.0, stddev = 0.0, size = 0.0;
};
double calcLogEvidence(double gain, const SizedCoefficient& coefficient);

}  // namespace twinmap
