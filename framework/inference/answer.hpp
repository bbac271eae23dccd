#pragma once

#include <string>
#include <vector>

#include "framework/inference/inferrer.hpp"

namespace twinmap {

/// What is believed of a measurement.
struct Answer {
  Eigen::VectorXd mean, stddev;  ///< p
  bool refined = false;          ///< on the simulator; else the map's
};

/// The refined answer where it was accepted, else the map's.
Answer chooseAnswer(const InferredMeasurement& inferred);

/// Names of all that is to be said against an answer, the gravest first: what the trust model says, then
/// "nonlinear" or "not_refined" where a refinement was tried and not accepted. {"ok"} where nothing is; empty
/// where nobody has judged.
std::vector<std::string> listStatuses(const InferredMeasurement& inferred);

}  // namespace twinmap
