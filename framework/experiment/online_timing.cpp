#include "framework/experiment/online_timing.hpp"

#include <algorithm>
#include <chrono>

namespace twinmap {

OnlineTimes timeOnlineUpdates(const OnlineModel& model, const LabelledFeatures& testing) {
  constexpr Eigen::Index kMostUpdates = 200;
  const Eigen::Index updates = std::min(testing.features.cols(), kMostUpdates);
  const OnlineMap map(model.map);
  OnlineMap::Workspace inferring(map);
  TrustWorkspace judging;
  std::vector<double> microseconds;
  for (Eigen::Index i = 0; i < updates; ++i) {
    const auto features = testing.features.col(i);
    const auto known = testing.inputs.col(i);
    const auto start = std::chrono::steady_clock::now();
    const Inference& inferred = map.infer(features, known, inferring);
    if (model.trust) {
      judge(*model.trust, features, known, inferred, judging);
    }
    const std::chrono::duration<double, std::micro> elapsed = std::chrono::steady_clock::now() - start;
    microseconds.push_back(elapsed.count());
  }
  std::sort(microseconds.begin(), microseconds.end());
  const auto last = microseconds.size() - 1;
  return {static_cast<int>(updates), microseconds[last / 2], microseconds[last * 99 / 100]};
}

}  // namespace twinmap
