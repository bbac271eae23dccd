#include <fmt/core.h>

#include <iostream>
#include <regex>
#include <string>
#include <vector>

#include "framework/base/json/json.hpp"
#include "framework/base/log/notice.hpp"
#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/cli/commands/commands.hpp"

namespace twinmap::cli {
namespace {

const char* toString(Severity severity) {
  return severity == Severity::kMisleading ? "misleading"
         : severity == Severity::kDegraded ? "degraded"
                                           : "info";
}

const char* describeKind(const NoticeText& text) {
  return text.is_status ? "status" : "warning";
}

/// With "..." for the numbers and names that a message gets.
std::string hidePlaceholders(const char* text) {
  static const std::regex kPlaceholder(R"(\{[^}]*\})");
  return std::regex_replace(text, kPlaceholder, "...");
}

void print(const NoticeText& text) {
  std::cout << fmt::format("{} ({}, {})\n  says:   {}\n  cause:  {}\n", text.name, describeKind(text),
                           toString(text.severity), hidePlaceholders(text.happened), text.cause);
  if (*text.remedy != '\0') {
    std::cout << fmt::format("  remedy: {}\n", hidePlaceholders(text.remedy));
  }
}

void printJson() {
  Json json = Json::array();
  for (const NoticeText& text : listNotices()) {
    json.push_back({{"name", text.name},
                    {"kind", describeKind(text)},
                    {"severity", toString(text.severity)},
                    {"says", text.happened},
                    {"cause", text.cause},
                    {"remedy", text.remedy}});
  }
  std::cout << json.dump(1) << '\n';
}

const NoticeText& find(const std::string& name) {
  std::vector<std::string> names;
  for (const NoticeText& text : listNotices()) {
    if (name == text.name) {
      return text;
    }
    names.emplace_back(text.name);
  }
  throw ExperimentError("command line: no status or warning is called '" + name + "'" +
                        suggestName(name, names));
}

}  // namespace

void explain(const ExplainArguments& arguments) {
  if (arguments.json) {
    printJson();
  } else if (!arguments.name.empty()) {
    print(find(arguments.name));
  } else {
    for (const NoticeText& text : listNotices()) {
      std::cout << fmt::format("{:<26}{:<9}{}\n", text.name, describeKind(text),
                               hidePlaceholders(text.happened));
    }
  }
}

}  // namespace twinmap::cli
