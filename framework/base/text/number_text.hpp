#pragma once

#include <string>

namespace twinmap {

/// Significant digits of what people read: of an estimate, of another figure, of a standard deviation, and of
/// a size that is known roughly.
constexpr int kEstimateDigits = 6, kFigureDigits = 4, kStddevDigits = 3, kRoughDigits = 2;

/// The shortest decimal text that reads back as the same number; "nan", "inf".
std::string toText(double value);

/// Rounded to `digits` significant digits, human-readable: "0.9374", "1.3e-05".
std::string toShortText(double value, int digits);

/// The number, if `text` is a plain decimal literal ("3.3", "-1e-3"); inf and nan are not.
bool parseLiteral(const std::string& text, double& value);

}  // namespace twinmap
