#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/models/start_states.hpp"
#include "framework/simulation/model_numbers.hpp"

namespace twinmap {

/// An output that shows a coordinate or a speed.
struct StartReading {
  Eigen::Index output = 0;  ///< number of the model's output
  bool of_slope = false;    ///< whether it measures the coordinate whose speed is sought
  double gain = 1.0, offset = 0.0;
  bool varies = false;  ///< whether gain or offset depend on parameters

  /// The state where the output has a value and a slope.
  double read(double value, double slope) const { return (of_slope ? slope : value - offset) / gain; }
};

/// Those of a state, slopes last; none of a state of first order.
/// Throws SimulationFailure for a gain or an offset that is not finite.
std::vector<StartReading> listReadings(const ModelSpec& model, const StartState& state,
                                       ModelNumbers& numbers);

}  // namespace twinmap
