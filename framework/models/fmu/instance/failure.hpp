#pragma once

#include "framework/simulation/simulation_failure.hpp"

namespace twinmap::fmi {

/// A call of the FMU that ended with Discard, Error or Fatal, or what it makes impossible: why one sample
/// failed.
class FmuFailure : public SimulationFailure {
 public:
  /// `fatal`: no function of any instance may be called any more in this process.
  explicit FmuFailure(const std::string& reason, bool fatal = false)
      : SimulationFailure(reason), fatal_(fatal) {}

  bool isFatal() const { return fatal_; }

 private:
  bool fatal_;
};

}  // namespace twinmap::fmi
