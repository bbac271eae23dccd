#include "framework/online_timing.hpp"

#include <algorithm>
#include <chrono>

namespace twinmap {

void timeOnlineUpdates(const GpMap& map, const LabelledFeatures& testing, RunSummary& run) {
  constexpr Eigen::Index kMostUpdates = 200;
  const Eigen::Index updates = std::min(testing.features.cols(), kMostUpdates);
  std::vector<double> microseconds;
  for (Eigen::Index i = 0; i < updates; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const Predictions inferred = map.predict(testing.features.col(i), testing.inputs.col(i));
    const std::chrono::duration<double, std::micro> elapsed = std::chrono::steady_clock::now() - start;
    microseconds.push_back(elapsed.count());
  }
  std::sort(microseconds.begin(), microseconds.end());
  const auto last = microseconds.size() - 1;
  run.online = {static_cast<int>(updates), microseconds[last / 2], microseconds[last * 99 / 100]};
}

}  // namespace twinmap
