#pragma once

#include <memory>
#include <string>
#include <vector>

#include "framework/base/log/run_control.hpp"
#include "framework/simulation/simulator.hpp"
#include "framework/study/samples/sample_source.hpp"
#include "framework/study/samples/simulate_missing.hpp"
#include "framework/study/sweep/model_groups.hpp"

namespace twinmap {

/// The samples of a group of cases, or their stencils.
struct SharedSamples {
  std::string failure;  ///< why the group's model cannot be simulated; the rest is null then
  std::unique_ptr<Simulator> simulator;
  std::unique_ptr<TrajectoryStore> store;
  Eigen::MatrixXd missing;        ///< parameters x n: points that the store does not have
  double allowed_failures = 1.0;  ///< when the group is given up (MissingOptions)
};

/// Opens the store of the group's samples in `root`, and finds those of `points` that are missing. Throws
/// std::runtime_error if another process has the store.
SharedSamples openSharedSamples(const ModelGroup& group, const Eigen::MatrixXd& points,
                                const std::filesystem::path& root);

/// The same of the stencils at `points`, without those of samples that have failed or were given up.
/// `group` has equal bounds (splitByBounds), `samples` are those of the group that it is a part of.
SharedSamples openSharedStencils(const ModelGroup& group, const Eigen::MatrixXd& points,
                                 const SharedSamples& samples, const std::filesystem::path& root);

/// A stage of a sweep that simulates.
struct SharedStage {
  double memory = 0.0;            ///< bytes of responses that may be held at a time
  std::string name = "simulate";  ///< human-readable
  int simulations = 1;            ///< behind each sample, as progress counts them
};

/// Simulates all that is missing, group after group, each with all threads; a group that is given up holds up
/// no other. Returns what was done; stopped, if fewer were simulated or given up than the total.
SimulationProgress simulateShared(std::vector<SharedSamples>& groups, const SharedStage& stage,
                                  const RunControl& control);

}  // namespace twinmap
