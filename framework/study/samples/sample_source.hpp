#pragma once

#include "framework/simulation/sample_generator.hpp"
#include "framework/store/trajectory_store.hpp"

namespace twinmap {

/// Where the samples of a run come from. The cases of a sweep share one, which knows the outputs at the times
/// of all of them.
struct SampleSource {
  const Simulator& simulator;
  TrajectoryStore& store;               ///< of the simulator's model and layout
  TrajectoryStore* stencils = nullptr;  ///< openStencilStore; null if none are needed
};

/// The responses at the times and modes of `layout`, which must be among those that the trajectories have.
Trajectories selectRows(Trajectories trajectories, const ResponseLayout& layout);

/// The same of responses (columns) alone, of the layout `from`.
Eigen::MatrixXd selectRows(Eigen::MatrixXd responses, const ResponseLayout& from, const ResponseLayout& to);

}  // namespace twinmap
