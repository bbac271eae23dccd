#pragma once

#include <unordered_map>
#include <vector>

#include "framework/simulation/model_numbers.hpp"

namespace twinmap {

/// The expressions that vary, of force elements, states and outputs: of constants, parameters, coordinates,
/// speeds (<coordinate>_dot), the force of gravity on them (<coordinate>_gravity), states of first order,
/// excitation signals and their rates, the time t, and named expressions; those of outputs of accelerations
/// too (<coordinate>_ddot). Parsed once, used for all parameter sets.
class StateExpressions {
 public:
  /// Throws ExperimentError for names that are taken and wrong expressions. `model` must
  /// outlive the object unchanged.
  StateExpressions(const ModelSpec& model, const NamedValues<double>& numbers);

  /// Takes over the values of constants and parameters.
  void setNumbers(const NamedValues<double>& values);

  /// In the order of the file. `rates`: time derivatives of the coordinates; `gravity`: forces on them, where
  /// needsGravity(). `signal_rates`: as Excitation::calcRates() gives them.
  void setState(double t, const std::vector<double>& coordinates, const std::vector<double>& rates,
                const std::vector<double>& gravity, const std::vector<double>& states,
                const std::vector<double>& signals, const std::vector<double>& signal_rates);
  bool needsGravity() const { return !gravity_.empty(); }
  /// 0 where no expression uses them.
  std::size_t getSignalRateCount() const { return signal_rates_.size(); }
  /// Of the coordinates, for expressions of outputs.
  void setAccelerations(const std::vector<double>& accelerations);

  /// The value at the state; may be inf or NaN. `expression`: one of the model's, by its address.
  double calc(const Expression& expression) const { return values_.calc(bound_.at(&expression)); }

 private:
  void defineNames(const ModelSpec& model, const NamedValues<double>& numbers);
  void defineStates(const ModelSpec& model);
  void defineGravity(const ModelSpec& model);
  void defineAccelerations(const ModelSpec& model);
  void setFrom(int first, const std::vector<double>& values);
  void setAt(const std::vector<int>& places, const std::vector<double>& values);

  NamedValues<double> values_;
  int first_coordinate_ = 0, first_speed_ = 0, first_signal_ = 0, time_ = 0, first_state_ = 0;
  int first_named_ = 0, first_acceleration_ = 0;
  std::vector<int> gravity_;       ///< places, by the coordinates; empty where no expression uses them
  std::vector<int> signal_rates_;  ///< places
  std::vector<BoundExpression> named_;
  std::unordered_map<const Expression*, BoundExpression> bound_;
};

}  // namespace twinmap
