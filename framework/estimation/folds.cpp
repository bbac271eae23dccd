#include "framework/estimation/folds.hpp"

#include <algorithm>

namespace twinmap {

using Eigen::Index;

std::vector<Index> listLeftOut(Index count, Index folds, Index fold) {
  std::vector<Index> listed;
  for (Index i = fold; i < count; i += folds) {
    listed.push_back(i);
  }
  return listed;
}

std::vector<Index> listKept(Index count, Index folds, Index fold) {
  std::vector<Index> listed;
  for (Index i = 0; i < count; ++i) {
    if (i % folds != fold) {
      listed.push_back(i);
    }
  }
  return listed;
}

Index countDraws(Index samples, Index columns) {
  constexpr Index kMost = 4;
  return std::clamp<Index>(columns / samples, 1, kMost);
}

}  // namespace twinmap
