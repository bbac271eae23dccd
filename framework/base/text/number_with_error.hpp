#pragma once

#include <string>

namespace twinmap {

/// "%.*f".
std::string toFixedText(double value, int decimals);

/// A figure with its standard error in parentheses, in units of the last digits: 0.938(30) is 0.938 with a
/// standard error of 0.030 (Guide to the expression of uncertainty in measurement, 7.2.2); 12.3(1.2) where
/// the error reaches the decimal point. The error has two significant digits. Where it is 0, not finite or
/// below 1e-8, the value alone with `decimals`.
std::string toTextWithError(double value, double standard_error, int decimals);

}  // namespace twinmap
