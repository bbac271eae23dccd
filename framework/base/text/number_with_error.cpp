#include "framework/base/text/number_with_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace twinmap {
namespace {

/// Decimals that show two significant digits of an error that is rounded to them: 0.0996 is 0.10.
int calcDecimals(double standard_error) {
  constexpr double kRoundsUp = 0.995;  // 99.5 and above have three digits before rounding to two
  const int exponent = static_cast<int>(std::floor(std::log10(standard_error / kRoundsUp)));
  return std::max(0, 1 - exponent);
}

}  // namespace

std::string toFixedText(double value, int decimals) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

std::string toTextWithError(double value, double standard_error, int decimals) {
  constexpr double kNegligible = 1e-8;
  if (!std::isfinite(value) || !std::isfinite(standard_error) || standard_error < kNegligible) {
    return toFixedText(value, decimals);
  }
  const int shown = calcDecimals(standard_error);
  const bool reaches_point = standard_error >= 0.995;
  const double in_last_digits = standard_error * std::pow(10.0, reaches_point ? 0 : shown);
  return toFixedText(value, shown) + "(" + toFixedText(in_last_digits, reaches_point ? shown : 0) + ")";
}

}  // namespace twinmap
