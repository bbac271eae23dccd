#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/diagnosis/candidates/observed_motion.hpp"
#include "framework/diagnosis/diagnosis.hpp"

namespace twinmap {

/// The force of a term that was found, on one coordinate.
struct TermForce {
  std::size_t term = 0;        ///< of Diagnosis::terms
  std::size_t coordinate = 0;  ///< of FitMotion::getCoordinates()
  Expression force;
};

/// A coordinate over time.
struct MovingCoordinate {
  Eigen::VectorXd position, speed;
};

/// What moves in one recording.
struct RecordedMotion {
  std::vector<MovingCoordinate> coordinates;
  std::vector<Eigen::VectorXd> forces;  ///< FitMotion::getTermForces()
};

/// How the machine moves where the corrected experiment of a diagnosis fits best.
class FitMotion {
 public:
  /// All must outlive the object. Throws std::runtime_error where the fit cannot be simulated.
  FitMotion(const Diagnosis& diagnosis, const ExperimentSpec& experiment, const RecordedFeatures& recordings);

  /// Those on which forces may act and that move in the first recording.
  const std::vector<ForcedCoordinate>& getCoordinates() const { return coordinates_; }

  /// Of the terms that are forces; one that couples two coordinates has two.
  const std::vector<TermForce>& getTermForces() const { return forces_; }

  /// At times (s) of a recording. Throws std::runtime_error where that cannot be simulated.
  RecordedMotion simulate(std::size_t recording, const Eigen::VectorXd& times) const;

 private:
  const Diagnosis& diagnosis_;
  const RecordedFeatures& recordings_;
  std::vector<ForcedCoordinate> coordinates_;
  std::vector<TermForce> forces_;
};

}  // namespace twinmap
