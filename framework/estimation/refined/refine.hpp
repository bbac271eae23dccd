#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "framework/estimation/refined/refined.hpp"
#include "framework/estimation/refined/refinement_model.hpp"
#include "framework/estimation/refined/search_box.hpp"
#include "framework/experiment/points/prior.hpp"
#include "framework/simulation/simulator.hpp"

namespace twinmap {

/// A point where a refinement may begin: the answer of a map, or a simulation that is similar.
struct RefinementStart {
  std::string name;       ///< "inverse_map", "training 3"
  Eigen::VectorXd point;  ///< of the sampled box; what is not searched is held there
};

/// One measurement to refine.
struct RefinementTask {
  Eigen::VectorXd features;             ///< d, finite
  std::vector<RefinementStart> starts;  ///< at least one, in the order they are tried
  SearchedParameters searched;
  bool uses_growing_windows =
      true;  ///< where no start is accepted, fit growing windows of time; else the starts alone
  /// Of the searched parameters (s x s, half-widths) around the first start, as the map sees it: an answer is
  /// first sought at that distance (confirm()); empty: unknown.
  Eigen::MatrixXd covariance{};
  std::shared_ptr<const Prior> prior{};  ///< of all unknown parameters; null: uniform within their bounds
};

/// Least squares on the simulator from one start after another, until an answer is accepted (search,
/// testMinimum); where none is, the best of them with the reason.
Refined refine(Simulator& simulator, const RefinementModel& model, const RefinementTask& task);

/// Measurements side by side on a team of threads; the result does not depend on their number. `before_each`
/// is called by any thread before it begins one; what it throws ends the team.
std::vector<Refined> refineAll(const Simulator& prototype, const RefinementModel& model,
                               const std::vector<RefinementTask>& tasks, int threads,
                               const std::function<void()>& before_each = nullptr);

/// As refineAll(), but the first 16 alone before the others, which are not tried if none of these is
/// accepted: a model whose answers least squares cannot find (one whose forces jump with its state, for
/// example) would take all starts for each of them, some seconds.
std::vector<Refined> refineOrAbortEarly(const Simulator& prototype, const RefinementModel& model,
                                        const std::vector<RefinementTask>& tasks, int threads,
                                        const std::function<void()>& before_each = nullptr);

}  // namespace twinmap
