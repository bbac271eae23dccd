#include "framework/base/text/base64.hpp"

#include <string_view>

namespace twinmap {
namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

}  // namespace

std::string encodeBase64(const std::vector<unsigned char>& bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto get = [&](std::size_t k) { return k < bytes.size() ? static_cast<unsigned>(bytes[k]) : 0U; };
    const unsigned group = (get(i) << 16U) | (get(i + 1) << 8U) | get(i + 2);
    for (const unsigned shift : {18U, 12U, 6U, 0U}) {
      text += kDigits[(group >> shift) & 63U];
    }
  }
  const std::size_t padding = (3 - bytes.size() % 3) % 3;
  return text.replace(text.size() - padding, padding, padding, '=');
}

std::string decodeBase64(const std::string& letters) {
  constexpr unsigned kBitsOfLetter = 6, kBitsOfByte = 8;
  std::string bytes;
  unsigned bits = 0, count = 0;
  for (const char letter : letters) {
    const std::size_t digit = kDigits.find(letter);
    if (digit == std::string_view::npos) {
      break;
    }
    bits = (bits << kBitsOfLetter) | static_cast<unsigned>(digit);
    count += kBitsOfLetter;
    if (count >= kBitsOfByte) {
      count -= kBitsOfByte;
      bytes += static_cast<char>((bits >> count) & 255U);
    }
  }
  return bytes;
}

}  // namespace twinmap
