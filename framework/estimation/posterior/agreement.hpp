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

/// Measurements that agree are called contradictory once in this share.
constexpr double kAgreementLevel = 0.01;

/// What one measurement says about the unknown parameters near the joint estimate, in LogCoordinates.
struct PartInformation {
  std::vector<Eigen::Index> unknown;  ///< which of all
  Eigen::MatrixXd information;        ///< J'J
};

/// Of each measurement of a problem at a point `best` of all its unknown parameters. Cost: a simulation with
/// derivatives each. Throws std::runtime_error where one fails.
std::vector<PartInformation> linearizeParts(const PosteriorProblem& problem, const Eigen::VectorXd& best);

/// The excess where all measurements have the same parameters is that of linear models about the joint
/// estimate `at` (u), with normal noise, minimised within the bounds: where each measurement determines every
/// one of s shared parameters, that of n measurements is chi-square of (n - 1) s degrees of freedom; where
/// one alone determines nothing, or the estimate is at a bound, it is not, so that it is simulated, 1999
/// times. All misfits contain that of the prior. The result depends on `seed` alone. Cost: some 2000 (n + 1)
/// solutions of u equations.
Agreement testAgreement(double joint_misfit, const std::vector<double>& separate_misfits,
                        const std::vector<PartInformation>& parts, const PosteriorProblem& problem,
                        const Eigen::VectorXd& best, std::uint64_t seed);

}  // namespace twinmap
