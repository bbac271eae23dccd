#include "framework/diagnosis/candidates/split_sum.hpp"

#include <cctype>

#include "framework/base/text/trim.hpp"

namespace twinmap {
namespace {

bool isIn(char c, const char* characters) {
  return std::string(characters).find(c) != std::string::npos;
}

bool isDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.';
}

bool isWord(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
}

/// Behind the number or name at `at`: of "1e-3" the sign is part of it.
std::size_t passWord(const std::string& text, std::size_t at) {
  const bool is_number = isDigit(text[at]);
  while (at < text.size() &&
         (isWord(text[at]) || (is_number && isIn(text[at], "+-") && isIn(text[at - 1], "eE")))) {
    ++at;
  }
  return at;
}

struct Summand {
  std::string text;
  bool is_negative = false;
};

/// Empty where what binds less than a sum stands outside of parentheses.
std::vector<Summand> findSummands(const std::string& text) {
  std::vector<Summand> summands(1);
  int depth = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = isWord(text[at]) ? passWord(text, at) : at + 1;
    Summand& last = summands.back();
    depth += text[at] == '(' ? 1 : text[at] == ')' ? -1 : 0;
    const bool is_sign = depth == 0 && isIn(text[at], "+-");
    if (depth == 0 && isIn(text[at], "?:<>=!&|")) {
      return {};
    }
    const std::string before = trim(last.text);
    if (is_sign && before.empty()) {
      last.is_negative = last.is_negative != (text[at] == '-');
    } else if (is_sign && !isIn(before.back(), "*/^")) {
      summands.push_back({"", text[at] == '-'});
    } else {
      last.text += text.substr(at, end - at);
    }
    at = end;
  }
  return summands;
}

/// Whether the first parenthesis closes at the end.
bool isInParentheses(const std::string& text) {
  int depth = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    depth += text[at] == '(' ? 1 : text[at] == ')' ? -1 : 0;
    if (depth == 0) {
      return text[at] == ')' && at + 1 == text.size();
    }
  }
  return false;
}

void addSummands(const std::string& text, bool is_negative, std::vector<std::string>& all) {
  const std::vector<Summand> summands = findSummands(text);
  if (summands.empty()) {
    all.push_back(is_negative ? "-(" + trim(text) + ")" : trim(text));
  }
  for (const Summand& one : summands) {
    const std::string own = trim(one.text);
    const bool negative = one.is_negative != is_negative;
    if (isInParentheses(own)) {
      addSummands(own.substr(1, own.size() - 2), negative, all);
    } else {
      all.push_back(negative ? "-(" + own + ")" : own);
    }
  }
}

}  // namespace

std::vector<std::string> splitSum(const std::string& text) {
  std::vector<std::string> all;
  addSummands(text, false, all);
  return all;
}

}  // namespace twinmap
