#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinmap {

/// Samples below `count` that the fold leaves out, one of every `folds`, in rising order.
std::vector<Eigen::Index> listLeftOut(Eigen::Index count, Eigen::Index folds, Eigen::Index fold);

/// Those that it keeps.
std::vector<Eigen::Index> listKept(Eigen::Index count, Eigen::Index folds, Eigen::Index fold);

}  // namespace twinmap
