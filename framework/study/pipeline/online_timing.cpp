#include "framework/study/pipeline/online_timing.hpp"

#include <algorithm>
#include <chrono>
#include <optional>

namespace twinmap {
namespace {

/// Times update(i) for the first samples.
template <class Update>
OnlineTimes timeUpdates(Eigen::Index samples, const Update& update) {
  constexpr Eigen::Index kMaxUpdates = 100;
  const Eigen::Index updates = std::min(samples, kMaxUpdates);
  std::vector<double> microseconds;
  for (Eigen::Index i = 0; i < updates; ++i) {
    const auto start = std::chrono::steady_clock::now();
    update(i);
    const std::chrono::duration<double, std::micro> elapsed = std::chrono::steady_clock::now() - start;
    microseconds.push_back(elapsed.count());
  }
  std::sort(microseconds.begin(), microseconds.end());
  const auto last = microseconds.size() - 1;
  return {static_cast<int>(updates), microseconds[last / 2], microseconds[last * 99 / 100]};
}

}  // namespace

OnlineTimes timeOnlineUpdates(const OnlineModel& model, const LabelledFeatures& testing) {
  const std::unique_ptr<Estimator::Workspace> inferring = model.map->makeWorkspace();
  std::optional<TrustWorkspace> judging;
  if (model.trust) {
    judging.emplace(*model.trust);
  }
  return timeUpdates(testing.features.cols(), [&](Eigen::Index i) {
    const auto features = testing.features.col(i);
    const auto known = testing.inputs.col(i);
    const Estimate& inferred = model.map->infer(features, known, *inferring);
    if (model.trust) {
      judge(*model.trust, features, known, inferred, inferring->findExplanation(), *judging);
    }
  });
}

}  // namespace twinmap
