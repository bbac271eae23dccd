#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <utility>

#include "framework/models/mechanism/equilibrium.hpp"
#include "framework/models/mechanism/lanes/recording/recorded_model.hpp"
#include "kernels/lanes/problem.hpp"

namespace twinmap {

/// What equilibria and modes are found by.
struct RestPrograms {
  program::Program residuals;  ///< [rest_rates; rest_closures], rest_pivots, d residuals / d [coordinates;
                               ///< states of first order] by columns; with directions also d residuals / d
                               ///< parameters by columns
  int pivot_count = 0;         ///< of rest_pivots
  program::Program linearization;
};

/// Made when first asked for, by any thread.
class DeferredRest {
 public:
  explicit DeferredRest(std::function<RestPrograms()> make) : make_(std::move(make)) {}

  const RestPrograms& get() {
    std::call_once(made_, [this] {
      programs_ = make_();
      make_ = nullptr;  // and what it holds of the record
    });
    return programs_;
  }

 private:
  std::function<RestPrograms()> make_;
  std::once_flag made_;
  RestPrograms programs_;
};

/// Of more coordinates neither equilibria nor modes nor implicit steps are offered. The derivatives by each
/// coordinate and speed of 30 take 3 s and 0.4 GB to compile; both grow as the fourth power.
constexpr int kMostDifferentiated = 30;

/// The programs of a model that all threads share; immutable. Symbols: see RecordedModel.
struct LaneModel {
  program::InputCounts counts;
  int coordinate_count = 0;
  int origin_parameter = -1;      ///< ModelSpec::time_origin, among the sampled
  int hidden_count = 0;           ///< states of sensors and controllers, and modes of switches
  RecordedExcitation excitation;  ///< its symbols are not to be used
  RecordedSampling sampling;      ///< likewise
  bool is_memoryless = false;     ///< nothing is integrated: `problem` has no states
  lanes::Problem problem;         ///< the motion and its outputs
  program::Program start;  ///< initial states (of the first phase's inputs), events, delays; with directions
                           ///< their derivatives, one by one
  std::shared_ptr<DeferredRest> at_rest;
  std::vector<int> directions;             ///< parameters by which there are derivatives
  std::vector<int> prescribed;             ///< coordinates that move as signals say
  std::shared_ptr<const LoopModel> loops;  ///< null: none

  int countDirections() const { return static_cast<int>(directions.size()); }
  int getFirstOrderCount() const { return counts.states - 2 * coordinate_count - hidden_count; }
  bool isDifferentiated() const { return coordinate_count <= kMostDifferentiated; }
  bool hasEvents() const { return problem.guard_count > 0; }
  int getClosureCount() const { return loops ? static_cast<int>(loops->plan.rows.size()) : 0; }
};

/// Why a pivot is not positive.
inline const char* getSingularReason(const LaneModel& model) {
  return model.loops ? "a loop is in a singular configuration (links that are aligned), or a body without "
                       "inertia can move freely"
                     : kSingularMassMatrix;
}

/// What implicit integration evaluates.
struct StiffPrograms {
  program::Program
      derivative;             ///< of the states, which it leads back to the conditions of loops; then pivots
  program::Program jacobian;  ///< d derivative / d states, column by column
};

/// Compiles a recorded model. directions: parameters by which there are derivatives; none: for its values
/// alone. Appends to the recorder. Cost: milliseconds; with derivatives as much more as there are directions.
LaneModel compileModel(const RecordedModel& recorded, const std::vector<int>& directions = {});

/// Appends to the recorder.
StiffPrograms compileStiff(const RecordedModel& recorded);

}  // namespace twinmap
