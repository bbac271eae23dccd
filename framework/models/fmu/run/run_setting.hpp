#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <vector>

#include "framework/models/fmu/instance/instance.hpp"
#include "framework/models/fmu/package/unit_conversion.hpp"
#include "framework/simulation/integration/integration.hpp"

namespace twinmap::fmi {

/// Variables of an FMU and how their values become those of the experiment.
struct BoundVariables {
  std::vector<ValueSlot> slots;
  std::vector<UnitConversion> units;  ///< to the FMU of what is set, from it of outputs
  std::vector<std::size_t> sources;   ///< which of the experiment's values each slot takes
};

/// What an FMU is run with; the same for all samples.
struct RunSetting {
  Kind kind = Kind::kCoSimulation;
  BoundVariables parameters, inputs, outputs;
  Eigen::VectorXd times;       ///< s, of the outputs
  double duration = 0.0;       ///< s
  std::optional<double> step;  ///< s, the largest communication step; none: as the FMU suggests
  IntegrationOptions integration;
};

/// Numbers of a group in the experiment's units.
class BoundGroup {
 public:
  BoundGroup() = default;
  explicit BoundGroup(const BoundVariables& variables)
      : variables_(variables), group_(variables.slots), values_(variables.slots.size()) {}

  bool isEmpty() const { return values_.empty(); }

  /// `values`: the experiment's, all of them.
  void set(Instance& instance, const double* values) {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      values_[i] = variables_.units[i].apply(values[variables_.sources[i]]);
    }
    instance.set(group_, values_.data());
  }

  /// Whether both sets of the experiment's values set the same.
  bool isSame(const std::vector<double>& one, const std::vector<double>& other) const {
    return std::all_of(variables_.sources.begin(), variables_.sources.end(),
                       [&](std::size_t source) { return one[source] == other[source]; });
  }

  const std::vector<double>& get(Instance& instance) {
    instance.get(group_, values_.data());
    for (std::size_t i = 0; i < values_.size(); ++i) {
      values_[i] = variables_.units[i].apply(values_[i]);
    }
    return values_;
  }

 private:
  BoundVariables variables_;
  ValueGroup group_;
  std::vector<double> values_;
};

}  // namespace twinmap::fmi
