#pragma once

#include <limits>

namespace twinmap {

/// What a number must satisfy; checked when read, and written into the JSON schema.
struct NumberRule {
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  bool minimum_allowed = true;  ///< false: strictly above
  const char* text = "must be a number";
};

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr NumberRule kAnyNumber{};
inline constexpr NumberRule kPositive{0.0, kInfinity, false, "must be a number above 0"};
inline constexpr NumberRule kNonNegative{0.0, kInfinity, true, "must be a number, 0 or above"};
inline constexpr NumberRule kFraction{0.0, 1.0, true, "must be a fraction from 0 to 1"};
inline constexpr NumberRule kSampleInterval{1e-9, kInfinity, true, "must be a number, 1e-9 or above"};
inline constexpr NumberRule kSampleCount{1.0, 1e6, true, "must be a whole number from 1 to 1000000"};
inline constexpr NumberRule kThousand{1.0, 1e3, true, "must be a whole number from 1 to 1000"};
inline constexpr NumberRule kHundredThousand{1.0, 1e5, true, "must be a whole number from 1 to 100000"};
inline constexpr NumberRule kCountOrNone{0.0, 1e5, true, "must be a whole number from 0 to 100000"};
inline constexpr NumberRule kCount{1.0, 1e7, true, "must be a whole number from 1 to 10000000"};

}  // namespace twinmap
