#include "framework/export/c_code/runtime_sources.hpp"

#include <stdexcept>

extern "C" {
extern const char twinmap_runtime_begin[], twinmap_runtime_end[];
}

namespace twinmap {

std::string_view getRuntimeSource(std::string_view name) {
  const std::string_view all(twinmap_runtime_begin,
                             static_cast<std::size_t>(twinmap_runtime_end - twinmap_runtime_begin));
  const std::string begin = "@@FILE " + std::string(name) + "\n";
  const std::size_t found = all.find(begin);
  if (found == std::string_view::npos) {
    throw std::logic_error("no runtime source " + std::string(name));
  }
  const std::size_t first = found + begin.size();
  return all.substr(first, all.find("@@FILE ", first) - first);
}

std::string fillSlot(std::string text, std::string_view slot, std::string_view content) {
  for (std::size_t at = text.find(slot); at != std::string::npos; at = text.find(slot, at + content.size())) {
    text.replace(at, slot.size(), content);
  }
  return text;
}

}  // namespace twinmap
