#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/simulation/excitation/excitation.hpp"

namespace twinmap {

/// The excitation of one sample as numbers, for a program that evaluates no expressions.
struct ExcitationTable {
  Eigen::VectorXd times;       ///< s
  Eigen::MatrixXd values;      ///< times x signals; at an edge the value after it
  std::vector<double> phases;  ///< s: 0, the times at which a signal may jump or bend, the duration
  Eigen::MatrixXd begin, end;  ///< phases - 1 x signals: limits from within each; pulses are linear between

  bool operator==(const ExcitationTable& other) const;
};

/// `excitation`: updated for the sample; is muted again. `times`: increasing, within [0, duration].
ExcitationTable calcExcitationTable(Excitation& excitation, const Eigen::VectorXd& times, double duration);

/// Where the excitation is sampled for a program: every `interval` (s), and at the end.
Eigen::VectorXd makeExcitationTimes(double interval, double duration);

}  // namespace twinmap
