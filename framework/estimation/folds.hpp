#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinmap {

/// Samples below `count` that the fold leaves out, one of every `folds`, in rising order.
std::vector<Eigen::Index> listLeftOut(Eigen::Index count, Eigen::Index folds, Eigen::Index fold);

/// Those that it keeps.
std::vector<Eigen::Index> listKept(Eigen::Index count, Eigen::Index folds, Eigen::Index fold);

/// Draws of the noise of so many samples, for about so many columns: more than four tell little that is new.
Eigen::Index countDraws(Eigen::Index samples, Eigen::Index columns);

}  // namespace twinmap
