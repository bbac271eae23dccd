#include "framework/experiment/model/jumps.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>

#include "framework/experiment/model/elements/force_elements.hpp"

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

/// Whether "v * abs(v)" or "abs(v) * v" stands there, which has no kink.
bool isDrag(std::string text, std::string argument) {
  for (std::string* one : {&text, &argument}) {
    one->erase(std::remove(one->begin(), one->end(), ' '), one->end());
  }
  const std::string call = "abs(" + argument + ")";
  return text.find(argument + "*" + call) != std::string::npos ||
         text.find(call + "*" + argument) != std::string::npos;
}

/// As an operand: a name as it is, all else in parentheses.
std::string makeOperand(const std::string& argument) {
  return std::all_of(argument.begin(), argument.end(), isPartOfName) ? argument : "(" + argument + ")";
}

}  // namespace

std::string describeJump(const Expression& force) {
  if (const std::string of = findCall(force.text, "sign"); !of.empty()) {
    return fmt::format("sign({0}) jumps: write tanh({1} / eps), eps a small value of {0}", of,
                       makeOperand(of));
  }
  if (const std::string of = findCall(force.text, "abs"); !of.empty() && !isDrag(force.text, of)) {
    return fmt::format("abs({0}) has a kink: write sqrt({1}^2 + eps^2), eps a small value of {0}", of,
                       makeOperand(of));
  }
  for (const char* stepped : {"floor", "rint"}) {
    if (const std::string of = findCall(force.text, stepped); !of.empty()) {
      return fmt::format("{}({}) jumps: write the force without it", stepped, of);
    }
  }
  return "";
}

std::string describeJump(const ForceLaw<Expression>& law) {
  const std::string& on = law.coordinate.text;
  return findCall(law.force.text, "sign") == on + "_dot"
             ? fmt::format(
                   "sign({0}_dot) jumps: give this term as friction: [{{coordinate: {0}, model: coulomb, "
                   "coulomb: LEVEL}}]",
                   on)
             : describeJump(law.force);
}

std::vector<std::string> listJumps(const SystemSpec& system) {
  std::vector<std::string> jumps;
  const std::vector<ForceLaw<Expression>>& laws = system.elements.get<ForceLaw>();
  for (std::size_t i = 0; i < laws.size(); ++i) {
    if (const std::string jump = describeJump(laws[i]); !jump.empty()) {
      jumps.push_back(fmt::format("system.force_laws[{}].force: {}", i, jump));
    }
  }
  return jumps;
}

}  // namespace twinmap
