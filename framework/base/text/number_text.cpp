#include "framework/base/text/number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace twinmap {
namespace {

constexpr std::size_t kLongestNumber = 64;

}  // namespace

std::string toText(double value) {
  std::array<char, kLongestNumber> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return std::string(text.data(), result.ptr);
}

std::string toShortText(double value, int digits) {
  std::array<char, kLongestNumber> text{};
  const auto result =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, digits);
  return std::string(text.data(), result.ptr);
}

bool parseLiteral(const std::string& text, double& value) {
  const char* first = text.data() + (text.rfind('+', 0) == 0 ? 1 : 0);
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(first, last, value);
  return error == std::errc() && end == last && first != last && std::isfinite(value);
}

}  // namespace twinmap
