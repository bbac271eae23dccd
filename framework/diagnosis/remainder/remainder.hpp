#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "framework/diagnosis/problem/recorded_problem.hpp"

namespace twinmap {

/// What a model leaves unexplained, as a process in time: a random force on a coordinate or a random error of
/// an output, whichever has the largest evidence.
struct Remainder {
  std::string what;                   ///< "a force on x", "an error of output x"
  std::vector<std::string> rivals{};  ///< others that the recordings do not tell from it (kTiedEvidence)
  std::string unit;                   ///< of its stddev: N, N m; "noise sd" of an output
  double stddev = 0.0;                ///< of the process at any time
  double correlation_time = 0.0;      ///< s
  double log_evidence = 0.0;          ///< against noise alone
  /// p: the machine's parameters where one of the processes is there, weighted by evidence, as far as the
  /// linear model knows; where there are three or more recordings, no more certain than their scatter between
  /// them allows.
  Eigen::VectorXd mean{}, stddevs{};
  Eigen::VectorXd times{}, process{};  ///< its mean at some times of the first recording, s and `unit`

  /// Of the machine's parameters the first whose mean is out of its bounds by more than its standard
  /// deviation, where the linear model does not hold: then there is no estimate. -1 where none is.
  Eigen::Index findOutside(const std::vector<ParameterSpec>& parameters) const;
};

/// At the best fit `point` (u) of an experiment; p: parameters of the machine that are reported. By the
/// linear model with restricted maximum likelihood (Patterson and Thompson 1971): the process is an
/// Ornstein-Uhlenbeck one, piecewise linear between knots. None where neither has more evidence than noise
/// alone. Throws std::runtime_error where the point cannot be simulated. Cost: a simulation with derivatives
/// along 40 coefficients a coordinate and recording.
std::optional<Remainder> findRemainder(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                                       const Eigen::VectorXd& point, Eigen::Index p);

/// Estimates of one quantity (n), each with its standard deviation, that may scatter by more: their mean and
/// its standard deviation with the variance between them that the scatter shows (random effects; DerSimonian
/// and Laird 1986).
struct RandomEffects {
  double mean = 0.0, stddev = 0.0, between = 0.0;
};
RandomEffects calcRandomEffects(const Eigen::VectorXd& estimates, const Eigen::VectorXd& stddevs);

}  // namespace twinmap
