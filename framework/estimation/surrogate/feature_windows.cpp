#include "framework/estimation/surrogate/feature_windows.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace twinmap {
namespace {

using Eigen::Index;

constexpr Index kTimesPerWindow = 8, kFeaturesPerWindow = 16;
/// Of long responses: each window is a search of its own, and 200 scores are kept of all together.
constexpr Index kMostTimeWindows = 64;

/// Whether each feature is the only one of its output at its time, so that the time orders them.
std::vector<bool> findTimed(const std::vector<FeatureInfo>& infos) {
  std::map<std::pair<int, double>, int> counts;
  for (const FeatureInfo& info : infos) {
    ++counts[{info.output, info.time}];
  }
  std::vector<bool> timed;
  for (const FeatureInfo& info : infos) {
    timed.push_back(info.output >= 0 && counts[{info.output, info.time}] == 1);
  }
  return timed;
}

std::vector<FeatureWindow> makeTimeWindows(const std::vector<FeatureInfo>& infos,
                                           const std::vector<bool>& timed) {
  std::set<double> times;
  for (std::size_t i = 0; i < infos.size(); ++i) {
    if (timed[i]) {
      times.insert(infos[i].time);
    }
  }
  const auto count = static_cast<Index>(times.size());
  const Index windows = std::min(kMostTimeWindows, (count + kTimesPerWindow - 1) / kTimesPerWindow);
  std::vector<FeatureWindow> found(static_cast<std::size_t>(windows));
  for (std::size_t i = 0; i < infos.size(); ++i) {
    if (timed[i]) {
      const Index rank = std::distance(times.begin(), times.find(infos[i].time));
      found[static_cast<std::size_t>(rank * windows / count)].push_back(static_cast<Index>(i));
    }
  }
  return found;
}

}  // namespace

std::vector<FeatureWindow> makeFeatureWindows(const std::vector<FeatureInfo>& infos) {
  const std::vector<bool> timed = findTimed(infos);
  std::vector<FeatureWindow> windows = makeTimeWindows(infos, timed);
  const FeatureInfo* last = nullptr;
  for (std::size_t i = 0; i < infos.size(); ++i) {
    if (timed[i]) {
      continue;
    }
    const bool alike = last != nullptr && last->output == infos[i].output && last->unit == infos[i].unit;
    if (!alike || static_cast<Index>(windows.back().size()) == kFeaturesPerWindow) {
      windows.emplace_back();
    }
    windows.back().push_back(static_cast<Index>(i));
    last = &infos[i];
  }
  return windows;
}

std::vector<FeatureWindow> makeWindowsInOrder(Index count) {
  return makeFeatureWindows(std::vector<FeatureInfo>(static_cast<std::size_t>(count)));
}

}  // namespace twinmap
