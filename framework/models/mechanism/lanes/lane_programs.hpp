#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "framework/models/mechanism/lanes/lane_model.hpp"
#include "framework/models/mechanism/simbody_model.hpp"

namespace twinmap {

/// A model compiled for lanes: what all clones of a simulator share.
class LanePrograms {
 public:
  /// Compiles the model, which must outlive the programs, if lanes can simulate it, and compares it with
  /// `simbody`, unless that is null. Cost: some ten milliseconds, most of it the comparison.
  LanePrograms(ModelContext& context, SimbodyModel* simbody);

  /// Why lanes cannot simulate the model; empty if they can. Else the rest must not be used.
  const std::string& getObstacle() const { return obstacle_; }

  const LaneModel& getValues() const { return *values_; }

  /// With the derivatives by all parameters of which they are asked for; compiled when first asked for, by
  /// any thread.
  const LaneModel& getDerivatives(const SystemNames& names);

  /// Of compileStiff(); likewise.
  const StiffPrograms& getStiff(const SystemNames& names);

 private:
  std::string compile(ModelContext& context, SimbodyModel* simbody);

  const ModelSpec& model_;
  std::optional<LaneModel> values_, derivatives_;
  std::optional<StiffPrograms> stiff_;
  std::string obstacle_;
  std::mutex compiling_;
};

}  // namespace twinmap
