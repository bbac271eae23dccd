#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/diagnosis/problem/recorded_problem.hpp"
#include "framework/diagnosis/remainder/process_effects.hpp"

namespace twinmap {

/// A recording at the fit.
struct FittedRecording {
  LinearizedRecordings linear;  ///< of its own unknown parameters: those of the machine, then its nuisance
  std::vector<ProcessEffect> effects;
  Eigen::VectorXd half_widths;  ///< of its own parameters, whose bounds count as weak information
};

/// Recordings that one kind of process may explain: effect number `effect` of each.
struct ProcessProblem {
  const std::vector<FittedRecording>& recordings;
  std::size_t effect = 0;
  Eigen::Index shared = 0;  ///< parameters of the machine, the first of each recording's
};

/// The best size and correlation length of a process: Ornstein and Uhlenbeck's, which may step, linear
/// between its knots.
struct BestProcess {
  double log_evidence = -kInfinity;  ///< against noise alone
  double variance = 0.0;             ///< of the process anywhere
  double correlation_length = 0.0;   ///< in the unit of the knots
};

/// By restricted maximum likelihood (Patterson and Thompson 1971), the correlation length one of `lengths`.
/// Cost: 9 k^3 + 2 n k^2 flops for k knots, a recording and length.
BestProcess searchProcess(const ProcessProblem& problem, const std::vector<double>& lengths);

/// What the recordings say of the parameters and of the process. v: parameters of the machine, then those of
/// one recording after the other.
struct ProcessEstimate {
  Eigen::VectorXd step;                         ///< v: from the fit
  Eigen::MatrixXd covariance;                   ///< v x v
  std::vector<Eigen::VectorXd> means, stddevs;  ///< of the process at the knots of each recording
};

ProcessEstimate estimateProcess(const ProcessProblem& problem, const BestProcess& best);

}  // namespace twinmap
