#include "framework/inference/clock_fault.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/base/text/number_text.hpp"
#include "framework/estimation/levels.hpp"

namespace twinmap {
namespace {

std::string describeRate(const ClockFault& fault) {
  const double rate = fault.size / (1.0 - fault.size);  // stamps over true times, less 1
  return fmt::format("the clock runs {} % {} (sd {} %)", toShortText(100.0 * std::abs(rate), kStddevDigits),
                     rate > 0.0 ? "fast" : "slow", toShortText(100.0 * fault.stddev, kStddevDigits));
}

std::string describeLateness(const ClockFault& fault, bool is_further) {
  const std::string from = fault.kind == ClockFaultKind::kSlip
                               ? fmt::format("from t = {} s on ", toShortText(fault.from, kEstimateDigits))
                               : "";
  const char* direction = is_further         ? (fault.size > 0.0 ? "later" : "earlier")
                          : fault.size > 0.0 ? "late"
                                             : "early";
  return fmt::format("{}{} {} ms {} (sd {} ms)", from, is_further ? "it is" : "the record is",
                     toShortText(1e3 * std::abs(fault.size), kStddevDigits), direction,
                     toShortText(1e3 * fault.stddev, kStddevDigits));
}

}  // namespace

double calcLateness(const std::vector<ClockFault>& faults, double stamp) {
  double lateness = 0.0;
  for (const ClockFault& fault : faults) {
    lateness += fault.size * fault.calcShape(stamp);
  }
  return lateness;
}

std::vector<std::string> describe(const std::vector<ClockFault>& faults) {
  std::vector<ClockFault> in_order = faults;
  std::stable_sort(in_order.begin(), in_order.end(),
                   [](const ClockFault& a, const ClockFault& b) { return a.from < b.from; });
  std::vector<std::string> said;
  for (const ClockFault& fault : in_order) {
    said.push_back(fault.kind == ClockFaultKind::kRate ? describeRate(fault)
                                                       : describeLateness(fault, !said.empty()));
  }
  return said;
}

}  // namespace twinmap
