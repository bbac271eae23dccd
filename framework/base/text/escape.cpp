#include "framework/base/text/escape.hpp"

#include <map>

namespace twinmap {
namespace {

std::string replaceEach(const std::string& text, const std::map<char, std::string>& replacements) {
  std::string escaped;
  for (const char c : text) {
    const auto found = replacements.find(c);
    escaped += found == replacements.end() ? std::string(1, c) : found->second;
  }
  return escaped;
}

}  // namespace

std::string escapeCsv(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    return text;
  }
  return "\"" + replaceEach(text, {{'"', "\"\""}}) + "\"";
}

std::string quoteForShell(const std::string& text) {
  if (text.find_first_of(" '\"\\$`!*?[]{}()<>|&;~#") == std::string::npos) {
    return text;
  }
  std::string quoted = "'";
  for (const char c : text) {
    quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return quoted + "'";
}

std::string escapeMarkdown(const std::string& text) {
  return replaceEach(
      text,
      {{'|', "\\|"}, {'\\', "\\\\"}, {'`', "\\`"}, {'*', "\\*"}, {'<', "&lt;"}, {'\n', " "}, {'\r', " "}});
}

std::string escapeLatex(const std::string& text) {
  return replaceEach(text, {{'\\', "\\textbackslash{}"},
                            {'~', "\\textasciitilde{}"},
                            {'^', "\\textasciicircum{}"},
                            {'_', "\\_"},
                            {'%', "\\%"},
                            {'&', "\\&"},
                            {'#', "\\#"},
                            {'$', "\\$"},
                            {'{', "\\{"},
                            {'}', "\\}"}});
}

std::string escapeHtml(const std::string& text) {
  return replaceEach(text, {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}});
}

}  // namespace twinmap
