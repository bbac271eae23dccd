#pragma once

#include <vector>

#include "framework/models/fmu/package/model_description.hpp"

namespace twinmap::fmi {

/// The points at which a Co-Simulation FMU communicates.
struct CommunicationGrid {
  std::vector<double> points;  ///< s, increasing, from 0
  double step = 0.0;           ///< s; of all steps, for an FMU that takes one size only; 0: they differ
};

/// Points that meet every one of `targets` (s, increasing, above 0) with steps of at most `largest` (s), as
/// even as the FMU allows: an FMU that cannot vary its step gets the largest step of one size that meets
/// them, and one with a fixed internal step gets multiples of it where the targets are. Throws FmuFailure
/// where a fixed step would have to be less than a millionth of the last target.
CommunicationGrid calcCommunicationGrid(const std::vector<double>& targets, double largest,
                                        const Capabilities& capabilities);

}  // namespace twinmap::fmi
