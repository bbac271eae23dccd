#pragma once

#include <string>
#include <vector>

namespace twinmap {

/// What a recorder's clock may do: start late, run fast or slow, be late from a time on (a slip: samples that
/// were lost or doubled while the time is an index).
enum class ClockFaultKind { kLate, kRate, kSlip };

/// A part of a clock's lateness: a sample whose stamp is t was taken at t - lateness(t), lateness being the
/// sum of size (kLate), size * t (kRate), and size from `from` on (kSlip).
struct ClockFault {
  ClockFaultKind kind = ClockFaultKind::kLate;
  double from = 0.0;    ///< s, of a slip: the first stamp that is late
  double size = 0.0;    ///< s, or s/s
  double stddev = 0.0;  ///< of the size

  /// Lateness at a stamp per size.
  double calcShape(double stamp) const {
    return kind == ClockFaultKind::kRate ? stamp : kind == ClockFaultKind::kSlip && stamp < from ? 0.0 : 1.0;
  }
};

/// s
double calcLateness(const std::vector<ClockFault>& faults, double stamp);

/// What each says: "the record is 20 ms late (sd 0.1 ms)", "the clock runs 0.3 % fast (sd 0.001 %)", "from t
/// = 15.28 s on the record is 2.4 ms late (sd 0.1 ms)", and of further slips "from t = 20 s on it is 1 ms
/// earlier (sd 0.1 ms)".
std::vector<std::string> describe(const std::vector<ClockFault>& faults);

}  // namespace twinmap
