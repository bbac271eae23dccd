#pragma once

#include <memory>
#include <vector>

#include "framework/inference/clock/clock_fault.hpp"
#include "framework/inference/nuisance_search.hpp"

namespace twinmap {

/// The simulator of a recording whose clock has faults (ClockedSimulator), which lie within `half_widths` of
/// their sizes.
std::shared_ptr<const SimulatorRefiner> makeClockedSimulator(const RecordedSamples& recorded,
                                                             const std::vector<NuisanceSize>& faults,
                                                             const Eigen::VectorXd& half_widths);

/// The point with the sizes behind it.
Eigen::VectorXd appendSizes(const Eigen::VectorXd& point, const std::vector<NuisanceSize>& faults);

/// The features without those whose true time cannot be simulated (NaN).
Eigen::VectorXd takeWithin(const RecordedSamples& recorded, const std::vector<NuisanceSize>& faults);

/// A least-squares fit of the parameters and a clock's faults, with its linear model.
struct ClockedFit {
  Eigen::VectorXd point;  ///< all unknown of the model
  std::vector<NuisanceSize> faults;
  Eigen::VectorXd residual;  ///< whitened, n
  Eigen::MatrixXd jacobian;  ///< minus its derivatives: by the model's unknown in half-widths, by sizes
  double misfit = 0.0;       ///< with that of the bounds
  std::vector<FeatureInfo> infos;

  bool isGiven() const { return residual.size() > 0; }
  double calcDegrees() const;
};

/// At a point; not given where it cannot be simulated.
ClockedFit linearizeClocked(const RecordedSamples& recorded, const Eigen::VectorXd& point,
                            const std::vector<NuisanceSize>& faults);

/// Gauss and Newton's steps from a point on, halved until the misfit falls. Not given where that cannot be
/// simulated. No search(): which samples can be simulated changes with each step, and among those of the
/// first point that finds no late clock (bench/recordings.py: 15 of 15 become 0 on three of four mechanisms).
ClockedFit fitClock(const RecordedSamples& recorded, const Eigen::VectorXd& point,
                    const std::vector<NuisanceSize>& faults);

}  // namespace twinmap
