#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <string>

#include "framework/base/log/notice.hpp"
#include "framework/inference/asked.hpp"

namespace twinmap {

/// "  NAME: what happened\n    what to do\n" of a status, its places filled with the arguments, as it stands
/// below the line of a measurement.
template <class... Arguments>
std::string explainNotice(Notice notice, const Arguments&... arguments) {
  std::string text = describeNotice(notice, arguments...);
  text.insert(std::min(text.find('\n') + 1, text.size()), text.find('\n') == std::string::npos ? "" : "  ");
  return fmt::format("  {}: {}\n", getNotice(notice).name, text);
}

/// Its first line alone, where its remedy has been tried or is another.
template <class... Arguments>
std::string explainBriefly(Notice notice, const Arguments&... arguments) {
  const std::string text = describeNotice(notice, arguments...);
  return fmt::format("  {}: {}\n", getNotice(notice).name, text.substr(0, text.find('\n')));
}

/// Why a posterior is not reliable. More draws are not advised where they were taken, nor where parameters
/// are not determined one by one (`undetermined`: "1 of m, L").
inline std::string explainUnreliable(const std::string& why, const Asked& asked,
                                     const std::string& undetermined = "") {
  constexpr int kMany = 4000;  // as the notice advises
  if (!undetermined.empty()) {
    return explainBriefly(Notice::kUnreliable, why) +
           fmt::format("    Fix {} at known values, or measure another output.\n", undetermined);
  }
  return asked.draws < kMany
             ? explainNotice(Notice::kUnreliable, why)
             : explainBriefly(Notice::kUnreliable, why) +
                   "    Narrow the bounds, or measure another output; more draws would hardly help.\n";
}

}  // namespace twinmap
