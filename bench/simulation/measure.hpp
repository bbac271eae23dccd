#pragma once

#include <functional>
#include <vector>

namespace twinmap::bench {

/// Processor time of this thread, and time on the wall, s.
double readThreadTime();
double readWallTime();

/// One of several ways to do the same.
struct Side {
  int samples;  ///< that a run simulates
  std::function<void()> run;
};

/// Median time of each side, in us a sample, over `rounds` rounds in which each side runs once: what else the
/// machine does then meets all of them alike. A round that is not counted comes first.
std::vector<double> measureInAlternation(const std::vector<Side>& sides, int rounds, double (*readTime)());

}  // namespace twinmap::bench
