#include "framework/estimation/folds.hpp"

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

}  // namespace twinmap
