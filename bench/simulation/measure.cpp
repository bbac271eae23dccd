#include "bench/simulation/measure.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>

namespace twinmap::bench {

double readThreadTime() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double readWallTime() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::vector<double> measureInAlternation(const std::vector<Side>& sides, int rounds, double (*readTime)()) {
  std::vector<std::vector<double>> times(sides.size());
  for (int round = -1; round < rounds; ++round) {
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const double begin = readTime();
      sides[i].run();
      if (round >= 0) {
        times[i].push_back(1e6 * (readTime() - begin) / sides[i].samples);
      }
    }
  }
  std::vector<double> medians;
  for (std::vector<double>& side : times) {
    std::nth_element(side.begin(), side.begin() + rounds / 2, side.end());
    medians.push_back(side[rounds / 2]);
  }
  return medians;
}

}  // namespace twinmap::bench
