#include "framework/experiment/expression/jumps.hpp"

#include <fmt/core.h>

#include <cctype>

namespace twinmap {
namespace {

/// What stands within the parentheses that open at `open`.
std::string takeArgument(const std::string& text, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < text.size(); ++i) {
    depth += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
    if (depth == 0) {
      return text.substr(open + 1, i - open - 1);
    }
  }
  return "";
}

bool isPartOfName(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// The argument of the first call of a function; "" where it is not called.
std::string findCall(const std::string& text, const std::string& function) {
  for (std::size_t at = text.find(function); at != std::string::npos; at = text.find(function, at + 1)) {
    const std::size_t open = text.find_first_not_of(' ', at + function.size());
    if ((at == 0 || !isPartOfName(text[at - 1])) && open != std::string::npos && text[open] == '(') {
      return takeArgument(text, open);
    }
  }
  return "";
}

}  // namespace

std::string describeJump(const Expression& force) {
  if (const std::string of = findCall(force.text, "sign"); !of.empty()) {
    return fmt::format("sign({0}) jumps: write tanh(({0}) / eps), eps a small value of {0}", of);
  }
  if (const std::string of = findCall(force.text, "abs"); !of.empty()) {
    return fmt::format("abs({0}) has a kink: write sqrt(({0})^2 + eps^2), eps a small value of {0}", of);
  }
  for (const char* stepped : {"floor", "rint"}) {
    if (const std::string of = findCall(force.text, stepped); !of.empty()) {
      return fmt::format("{}({}) jumps: write the force without it", stepped, of);
    }
  }
  return "";
}

}  // namespace twinmap
