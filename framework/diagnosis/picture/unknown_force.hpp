#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "framework/diagnosis/picture/fit_motion.hpp"

namespace twinmap {

/// A force as a function of one quantity.
struct ForceCurve {
  Eigen::VectorXd at;            ///< k, rising
  Eigen::VectorXd mean, stddev;  ///< k, N or N m
  double prior_stddev = 0.0;     ///< where the recordings say nothing
  double log_evidence = 0.0;     ///< against none
};

/// A force along one recording.
struct ForceOverTime {
  ForceCurve force;             ///< over time, s
  MovingCoordinate coordinate;  ///< at the same times
  Eigen::VectorXd fine_times;   ///< 1001
  MovingCoordinate fine;        ///< at these
  Eigen::VectorXd term_force;   ///< at these: of the term; empty without one
};

/// The force on a coordinate that the recordings ask for beside the model.
struct UnknownForce {
  std::size_t coordinate = 0;            ///< of FitMotion
  std::optional<std::size_t> term = {};  ///< of Diagnosis::terms, in whose place it stands
  std::vector<ForceOverTime> recordings{};
  ForceCurve over_position{}, over_speed{};  ///< were it a function of that alone, the same in all recordings

  /// Of all recordings together.
  double getEvidenceOverTime() const { return recordings.front().force.log_evidence; }
  /// Whether the recordings do not speak against a function of one quantity: its evidence is hardly less than
  /// that of a force that changes with time as it likes, and than none.
  bool mayBe(const ForceCurve& curve) const;
};

/// In the place of each term that was found and is a force on a coordinate: what the recordings say there,
/// whatever its law, beside the model without it, with the parameters and the other terms of the fit with it,
/// as well as these are known. On each coordinate without such a term, and on all where something is left
/// unexplained: beside the corrected model, whose parameters are free and take up what they can. Those with a
/// term first; by the first `count` recordings. The process is that of searchProcess(), by the
/// linear model at the fit. Throws std::runtime_error where the fit cannot be simulated with its derivatives.
/// Cost: for each 40 to 320 derivatives a recording over time, 65 each over position and speed.
std::vector<UnknownForce> estimateUnknownForces(const Diagnosis& diagnosis,
                                                const RecordedFeatures& recordings, const FitMotion& motion,
                                                std::size_t count);

}  // namespace twinmap
