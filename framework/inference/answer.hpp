#pragma once

#include <string>
#include <vector>

#include "framework/inference/inferrer.hpp"

namespace twinmap {

/// What is believed of a measurement.
struct Answer {
  Eigen::VectorXd mean, stddev;          ///< p
  EstimationMethod method;               ///< the map's kind, or refined on the simulator
  Mixture mixture{};                     ///< where it is one, whose mean and stddev are above
  Eigen::VectorXd lower95{}, upper95{};  ///< p: of a mixture the ends of its smallest set
  std::vector<Intervals> intervals95{};  ///< p, of a mixture: its smallest sets
  IntervalReach reach{};                 ///< of other sets; of refined answers not given

  bool isRefined() const { return method == EstimationMethod::kRefined; }
};

/// The map's.
Answer makeMapAnswer(const Inference& inference);

/// The refined answer where it was accepted, else the map's.
Answer chooseAnswer(const InferredMeasurement& inferred);

/// By how much the map's standard deviations are above what the measurement allows, as the map predicts it
/// (p); empty where it cannot.
Eigen::VectorXd calcRatioToLimit(const Inference& inference);

/// From this ratio on an answer of the map is estimator_limited.
constexpr double kEstimatorLimitedRatio = 1.5;

/// Whether the answer is the map's and its errors are mostly the map's own, or not known to it.
bool isEstimatorLimited(const InferredMeasurement& inferred);

/// Names of all that is to be said against an answer, the most severe first: what the trust model says, then
/// "multimodal" where a mixture's lie apart, "nonlinear" or "not_refined" where a refinement was tried
/// and not accepted, then "estimator_limited". {"ok"} where nothing is; empty where nobody has judged.
std::vector<std::string> listStatuses(const InferredMeasurement& inferred);

}  // namespace twinmap
