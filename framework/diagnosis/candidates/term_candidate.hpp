#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// A scale of a term's own, such as the speed at which friction sets in. A fit keeps it within a factor
/// `reach` of its value.
struct OwnScale {
  std::string meaning, unit;
  double value = 0.0;
  double reach = 5.0;  ///< more than the steps of a scan
  /// Whether the term is one at 0 as well: what is found goes on toward that (followToLimit).
  bool has_limit = false;
};

/// What a term is of.
enum class TermPlace { kMachine, kStart, kInputs, kSensors };

/// "machine", "start", "inputs", "sensors"
const char* getName(TermPlace place);

/// Adds a term to a model that has the parameter `coefficient`. own_scales: numbers, or parameters.
using AddTerm = std::function<void(ModelSpec& model, const std::string& coefficient,
                                   const std::vector<std::string>& own_scales)>;

/// A term that a model may lack: a coefficient, 0 where it is absent, and what it multiplies.
struct TermCandidate {
  std::string term;     ///< "drag.x": names it; the same of all own scales
  std::string meaning;  ///< "drag: force -c |x_dot| x_dot on x"
  std::string unit;     ///< of the coefficient, coherent SI
  double size = 1.0;    ///< of a coefficient that matters: its prior reaches so far
  /// Whether it takes energy where its coefficient is positive, as friction does.
  bool dissipates = false;
  std::vector<OwnScale> own_scales;  ///< the first one is scanned, others begin at their value
  bool has_states = false;           ///< whether it adds states to the model
  AddTerm add;
  /// Of an experiment with trials, to each of theirs instead; empty where a trial lacks what it acts on.
  std::vector<AddTerm> add_to_trials{};
  /// Whether the coefficient is the share, 0 to 1, in which it takes the place of what the model has.
  bool is_share = false;
  TermPlace place = TermPlace::kMachine;

  /// The coefficient, and its own scales.
  Eigen::Index countCoefficients() const { return 1 + static_cast<Eigen::Index>(own_scales.size()); }
  /// The same as a fit begins with them, the coefficient at `first`.
  Eigen::VectorXd listValues(double first) const {
    return Eigen::VectorXd::NullaryExpr(countCoefficients(), [&](Eigen::Index i) {
      return i == 0 ? first : own_scales[static_cast<std::size_t>(i - 1)].value;
    });
  }
  const AddTerm& getAdd(std::size_t trial) const {
    return add_to_trials.empty() ? add : add_to_trials[trial];
  }
};

}  // namespace twinmap
