#pragma once

#include "framework/inference/inferrer.hpp"

namespace twinmap {

// A sample whose stamp is t was taken at t - lateness(t). Parts of the lateness are: "late", its value (s),
// from a time on where that is a slip (samples that were lost or doubled while the time is an index), and
// "rate", its value (s/s) times the stamp.

bool isRate(const NuisanceSize& part);
/// Lateness at a stamp per value.
double calcShape(const NuisanceSize& part, double stamp);
/// s
double calcLateness(const std::vector<NuisanceSize>& parts, double stamp);

/// "the record is 20 ms late (sd 0.1 ms)", "the clock runs 0.3 % fast (sd 0.001 %)", "from t = 15.28 s on the
/// record is 2.4 ms late (sd 0.1 ms)", and of further slips "; from t = 20 s on it is 1 ms earlier (sd 0.1
/// ms)".
std::string describeClock(const std::vector<NuisanceSize>& parts);

}  // namespace twinmap
