#pragma once

#include <Eigen/Core>

#include "framework/experiment/model/model_spec.hpp"
#include "kernels/tracking/belief.hpp"

namespace twinmap {

/// The coordinates that parameters are tracked in. They are half-widths of the bounds from their middle, so
/// that normal distributions stay normal. They are logarithms, likewise scaled, where the prior is of the
/// logarithm.
class TrackSpace {
 public:
  explicit TrackSpace(const std::vector<ParameterSpec>& parameters);

  Eigen::Index count() const { return center_.size(); }
  double toCoordinate(Eigen::Index parameter, double value) const;
  double toValue(Eigen::Index parameter, double coordinate) const;
  /// d coordinate / d value, at a value.
  double calcSlope(Eigen::Index parameter, double value) const;

 private:
  std::vector<bool> is_log_;
  Eigen::VectorXd center_, half_width_;
};

/// What is known of the parameters before any measurement, in these coordinates.
struct TrackPrior {
  tracking::Belief belief;
  std::vector<Eigen::Index>
      uniform;  ///< parameters that are, between -1 and 1; the belief has their variance
};
TrackPrior makeTrackPrior(const ModelSpec& model, const TrackSpace& space);

}  // namespace twinmap
