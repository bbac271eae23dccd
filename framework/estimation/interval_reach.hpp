#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinmap {

/// The 50 %, 68 % and 95 % intervals of a normal distribution are mean +- so many standard deviations.
constexpr double kNormal50 = 0.674489750196082;
constexpr double kNormal68 = 0.994457883209753;
constexpr double kNormal95 = 1.959963984540054;

/// How many standard deviations from the mean a parameter's intervals reach.
struct Reach {
  double of50 = kNormal50, of95 = kNormal95;

  /// A normal distribution's interval reaches so many standard deviations where it has the probability of
  /// one that reaches `depth`: linear between the two, in proportion outside.
  double toNormalDepth(double depth) const;
};

/// That of p parameters where errors are not those of normal distributions: p x 1 of a map, p x n of n
/// answers. Empty where they are.
struct IntervalReach {
  Eigen::MatrixXd of50{}, of95{};

  bool isGiven() const { return of95.size() > 0; }
  Reach get(Eigen::Index parameter, Eigen::Index answer = 0) const {
    return isGiven() ? Reach{of50(parameter, answer), of95(parameter, answer)} : Reach{};
  }
  void set(Eigen::Index parameter, Eigen::Index answer, const Reach& reach) {
    of50(parameter, answer) = reach.of50;
    of95(parameter, answer) = reach.of95;
  }
  /// Of an answer that is a normal distribution among those that are not.
  void setNormal(Eigen::Index answer) {
    if (isGiven()) {
      of50.col(answer).setConstant(kNormal50);
      of95.col(answer).setConstant(kNormal95);
    }
  }
};

/// A map's for each of so many answers.
IntervalReach replicate(const IntervalReach& reach, Eigen::Index answers);

/// A parameter's in each answer; empty where none is given.
std::vector<Reach> takeReaches(const IntervalReach& reach, Eigen::Index parameter);

/// The standard error of a share that so many independent samples tell, where it ought to be `probability`.
double calcShareError(double probability, double samples);

/// What a further value is below with this probability, given n others in ascending order: the ceil(p (n +
/// 1))-th of them, or the last (split conformal prediction: Lei, G'Sell, Rinaldo, Tibshirani and Wasserman,
/// JASA 113, 2018).
double calcConformalQuantile(const Eigen::VectorXd& sorted, double probability);

/// How far intervals of a parameter must reach to hold what they say, given how many standard deviations the
/// truths of held-out answers lie from their means: conformal quantiles. Those of the normal distribution
/// unless the errors are of another shape: unless its intervals, stretched so that those of 68 % hold what
/// they say, still hold more or fewer by more than two standard errors of `samples` independent answers, of
/// which there may be fewer than depths. Else quantiles only add chance; how wide errors are is told by the
/// factor of standard deviations, with its own caution.
Reach calcReach(const Eigen::VectorXd& depths, double samples);

}  // namespace twinmap
