#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/experiment/files/sweep_cases.hpp"
#include "framework/simulation/response_layout.hpp"
#include "framework/store/trajectory_store.hpp"

namespace twinmap {

/// Cases whose responses come from the same simulations.
struct ModelGroup {
  std::vector<int> cases;  ///< indices, ascending
  ModelSpec model;  ///< of the first, with the longest max_wall_time and the most allowed_failures of all
  Eigen::VectorXd times;  ///< s, those of all cases; sorted
  int modes = 0;
};

/// Groups the cases by what determines their responses (writeTrajectoryContent). Cases that differ in their
/// features' times share simulations at all of these times: the response at a time does not depend on which
/// others are asked for. Only twinmap's own integrator keeps that bit for bit; with Simbody's, which
/// moves machines with loops where its engine is asked for, times differ between groups. In the order of
/// their first cases.
std::vector<ModelGroup> groupByModel(const std::vector<SweepCase>& cases);

/// Training and test points of the cases of the group that `wanted` (one per case) asks for, each point once:
/// parameters x n.
Eigen::MatrixXd collectPoints(const std::vector<SweepCase>& cases, const ModelGroup& group,
                              const std::vector<bool>& wanted);

/// The group by the bounds of its parameters, on which stencils depend, in the order of the first
/// cases.
std::vector<ModelGroup> splitByBounds(const std::vector<SweepCase>& cases, const ModelGroup& group);

/// The points at which the cases of the group that `wanted` asks for need derivatives
/// (listDerivativePoints), each once: parameters x n.
Eigen::MatrixXd collectDerivativePoints(const std::vector<SweepCase>& cases, const ModelGroup& group,
                                        const std::vector<bool>& wanted);

/// The group's store in `root`, to see what it has.
TrajectoryStore openToRead(const ModelGroup& group, const std::filesystem::path& root);

/// The layout of the group's responses, without the outputs' units.
ResponseLayout makeLayout(const ModelGroup& group);

}  // namespace twinmap
