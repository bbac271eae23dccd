#include "framework/diagnosis/candidates/replace_name.hpp"

namespace twinmap {

std::string replaceName(const std::string& text, const std::string& name, const std::string& replacement) {
  const auto is_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  std::string replaced;
  for (std::size_t at = 0; at < text.size();) {
    const bool begins = at == 0 || !(is_word(text[at - 1]) || text[at - 1] == '.');
    const std::size_t end = at + name.size();
    if (begins && text.compare(at, name.size(), name) == 0 && (end >= text.size() || !is_word(text[end]))) {
      replaced += replacement;
      at = end;
    } else {
      replaced += text[at++];
    }
  }
  return replaced;
}

}  // namespace twinmap
