#pragma once

#include <cstdint>

namespace twinmap {

/// Channels of a posterior's random numbers (RandomPurpose::kPosterior): what each way to draw takes is its
/// own.
enum DrawChannel : std::uint64_t {
  kOfDraws = 0,
  kOfCenters = 1,  ///< of parts about single draws
  kOfSlices = 2,   ///< of elliptical slices
  kOfPicks = 3,    ///< which part of a mixture a draw is of
  kOfMinima = 4
};

}  // namespace twinmap
