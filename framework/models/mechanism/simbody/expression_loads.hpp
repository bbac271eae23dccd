#pragma once

#include <array>
#include <vector>

#include "framework/models/mechanism/simbody/forces.hpp"
#include "framework/simulation/model_numbers.hpp"

namespace twinmap {

/// Applied forces, applied moments and force laws: expressions of constants, parameters, coordinates, speeds
/// (<coordinate>_dot), excitation signals and the time t. Compiled once, used for all parameter sets.
class ExpressionLoads {
 public:
  /// Throws ExperimentError for unknown names and expressions that do not compile. `model` and `names` must
  /// outlive the object unchanged.
  ExpressionLoads(const ModelSpec& model, const SystemNames& names, const ExpressionScope& numbers);

  /// Takes over the values of constants and parameters, and the stations of the applied forces.
  void update(const ExpressionScope& values, NumberEvaluator& numbers);

  /// Adds all loads at a state that is realized to Velocity. `signals`: one value per excitation signal.
  void add(double t, const std::vector<double>& signals, ForceSum& sum);

 private:
  using Components = std::array<CompiledExpression, 3>;
  struct AppliedForce {
    const AppliedForceSpec& spec;
    Station station;
    Components components;
    ForceFrame frame;
  };
  struct AppliedMoment {
    int body;
    Components components;
    ForceFrame frame;
  };
  struct ForceLaw {
    int coordinate;
    CompiledExpression force;
  };

  void defineNames(const ExpressionScope& numbers);
  void compileLoads();
  Components compile3(const Expression3& expressions);
  void setValues(double t, const std::vector<double>& signals, const ForceSum& sum);

  const ModelSpec& model_;
  const SystemNames& names_;
  ExpressionScope scope_;
  int first_coordinate_ = 0, first_speed_ = 0, first_signal_ = 0, time_ = 0;
  std::vector<AppliedForce> forces_;
  std::vector<AppliedMoment> moments_;
  std::vector<ForceLaw> laws_;
};

}  // namespace twinmap
