#include "framework/base/text/base64.hpp"

namespace twinmap {

std::string encodeBase64(const std::vector<unsigned char>& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
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

}  // namespace twinmap
