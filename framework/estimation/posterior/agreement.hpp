#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "framework/estimation/posterior/simulator_posterior.hpp"

namespace twinmap {

/// Whether several measurements can be of one machine.
struct Agreement {
  double excess = 0.0;   ///< least misfit of all together less the sum of those of each alone
  double p_value = 1.0;  ///< share of agreeing measurements whose excess is as large; at least 1 / 2000
  bool isAtFloor() const;
};

/// What one measurement says about the unknown parameters near the joint estimate, in LogCoordinates.
struct PartInformation {
  std::vector<Eigen::Index> unknown;  ///< which of all
  Eigen::MatrixXd information;        ///< J'J
  Eigen::VectorXd descent;            ///< J'r
};

/// Of each measurement of a problem at a point `best` of all its unknown parameters. Cost: a simulation with
/// derivatives each. Throws std::runtime_error where one fails.
std::vector<PartInformation> linearizeParts(const PosteriorProblem& problem, const Eigen::VectorXd& best);

/// A score test: what each measurement's linear model about the joint estimate says that it would gain alone,
/// within the bounds, is compared with what it would gain by normal noise. Where each measurement determines
/// every one of s shared parameters, the sum over n measurements is chi-square of (n - 1) s degrees of
/// freedom; where one alone determines nothing, or the estimate is at a bound, it is not, so that it is
/// simulated, 1999 times. The excess itself is no such measure: a window that hardly sees a parameter gains
/// by it along a bent valley, far from the joint estimate, what no linear model says (twelve of twelve
/// agreeing recordings, of 14 windows each, were below p = .23). Where it is beyond that chi-square all the
/// same, with a tenth of the probability, nothing depends on linear models: the p-value is the smaller one of
/// the two, that of the excess times ten, so that at most a tenth more measurements than it says are called
/// contradictory. All misfits contain that of the prior. The result depends on `seed` alone. Cost: some 2000
/// (n + 1) solutions of u equations.
Agreement testAgreement(double joint_misfit, const std::vector<double>& separate_misfits,
                        const std::vector<PartInformation>& parts, const PosteriorProblem& problem,
                        const Eigen::VectorXd& best, std::uint64_t seed);

}  // namespace twinmap
