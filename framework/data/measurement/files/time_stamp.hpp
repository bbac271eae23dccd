#pragma once

#include <string>
#include <string_view>

namespace twinmap {

/// Reads a date and time of ISO 8601, "2026-11-26T10:00:00.25Z", "2026-11-26 10:00:00+01:00", as seconds
/// since 1970-01-01 UTC; without a zone it is UTC. Fractions of a second after a point or a comma. Returns
/// false for another text. Precise to 0.24 us, the spacing of such numbers.
bool parseTimeStamp(std::string_view text, double& seconds);

/// The same, or a number of seconds since 1970.
bool parseTime(const std::string& text, double& seconds);

}  // namespace twinmap
