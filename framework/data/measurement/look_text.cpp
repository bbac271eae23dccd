#include <fmt/core.h>

#include <algorithm>

#include "framework/base/json/json.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/data/measurement/look.hpp"
#include "framework/data/measurement/time_series.hpp"

namespace twinmap {
namespace {

constexpr int kFewDigits = 4;

/// "2 gaps (0.49 s, 1.2 s)", "7 spikes (first at 0.3 s)"
std::string describeFirst(const FoundSamples& found, const char* what) {
  constexpr std::size_t kMostTold = 4;
  if (found.count > 1 && found.times.size() <= kMostTold && !found.times.empty()) {
    std::string places;
    for (const double time : found.times) {
      places += (places.empty() ? "" : ", ") + describeTime(time);
    }
    return fmt::format("{} {}s ({})", found.count, what, places);
  }
  return fmt::format("{} {}{} ({}{})", found.count, what, found.count == 1 ? "" : "s",
                     found.count == 1 ? "" : "first at ", describeTime(found.first));
}

/// Rows without a number and gaps, once where they are the same.
void addMissing(const ColumnLook& column, std::vector<std::string>& odd) {
  const std::string missing = fmt::format("{} missing", column.missing);
  const std::string gaps =
      column.gaps.count == 0
          ? ""
          : describeFirst(column.gaps, "gap") +
                fmt::format(", the longest {} s", toShortText(column.longest_gap, kFewDigits));
  if (column.gaps_are_missing) {
    odd.push_back(missing + " in " + gaps);
    return;
  }
  if (column.missing > 0) {
    odd.push_back(missing);
  }
  if (!gaps.empty()) {
    odd.push_back(gaps);
  }
}

/// What is worth a look, a phrase each, with what to do in a recording that is to be inferred from.
std::vector<std::string> listOddities(const ColumnLook& column) {
  constexpr double kJitter = 0.01;
  std::vector<std::string> odd;
  if (column.is_constant) {
    odd.emplace_back("the same everywhere");
  }
  addMissing(column, odd);
  if (column.short_steps.count > 0) {
    odd.push_back(describeFirst(column.short_steps, "short step") +
                  fmt::format(", the shortest {} s: double triggers?", toShortText(column.shortest_step, 2)));
  }
  if (column.step_spread > kJitter) {
    odd.push_back(fmt::format("steps jitter by {} %", toShortText(100.0 * column.step_spread, 2)));
  }
  if (column.spikes.count > 0) {
    odd.push_back(describeFirst(column.spikes, "spike"));
  }
  if (column.at_largest.count > 0) {
    odd.push_back(describeFirst(column.at_largest, "sample") + " at the largest value: clipped?");
  }
  if (column.at_least.count > 0) {
    odd.push_back(describeFirst(column.at_least, "sample") + " at the least value: clipped?");
  }
  if (column.turns.count > 0) {
    odd.push_back(describeFirst(column.turns, "jump") + " by a whole turn: unwrap?");
  }
  if (column.resolution > 0.0) {
    odd.push_back(fmt::format("steps of {}", toShortText(column.resolution, 3)));
  }
  return odd;
}

std::string joinOddities(const ColumnLook& column) {
  std::string text;
  for (const std::string& odd : listOddities(column)) {
    text += (text.empty() ? "" : "; ") + odd;
  }
  return text;
}

Json toJson(const FoundSamples& found) {
  return {{"count", found.count}, {"first", found.count > 0 ? Json(found.first) : Json()}};
}

/// With the place of each.
Json listTimes(const FoundSamples& found) {
  Json json = toJson(found);
  json["at"] = found.times;
  return json;
}

Json toJson(const ColumnLook& column) {
  return {{"name", column.name},
          {"unit", column.unit ? Json(*column.unit) : Json()},
          {"samples", column.samples},
          {"missing", column.missing},
          {"least", column.least},
          {"largest", column.largest},
          {"step", column.step},
          {"step_spread", column.step_spread},
          {"gaps", listTimes(column.gaps)},
          {"longest_gap", column.longest_gap},
          {"short_steps", toJson(column.short_steps)},
          {"shortest_step", column.shortest_step},
          {"spikes", toJson(column.spikes)},
          {"at_least", toJson(column.at_least)},
          {"at_largest", toJson(column.at_largest)},
          {"turns", toJson(column.turns)},
          {"turn", column.turn},
          {"noise", column.noise},
          {"resolution", column.resolution},
          {"constant", column.is_constant}};
}

}  // namespace

std::string makeLookText(const TableLook& look) {
  std::string text = fmt::format("{}: {} rows, {} to {}\n", look.source, look.rows, describeTime(look.first),
                                 describeTime(look.last));
  text += look.time.empty()
              ? "times: by the rate\n"
              : fmt::format("times: column {}{}\n", look.time,
                            look.time_was_guessed ? ", the first that increases (--time names another)" : "");
  for (const std::string& remark : look.remarks) {
    text += remark + "\n";
  }
  std::size_t width = 6;
  for (const ColumnLook& column : look.columns) {
    width = std::max(width, column.name.size());
  }
  text += fmt::format("\n{:<{}}  {:<8}  {:>8}  {:>9}  {:>10}  {:>10}  {:>9}  {}\n", "column", width, "unit",
                      "samples", "rate [Hz]", "least", "largest", "noise", "what stands out");
  for (const ColumnLook& column : look.columns) {
    text += fmt::format("{:<{}}  {:<8}  {:>8}  {:>9}  {:>10}  {:>10}  {:>9}  {}\n", column.name, width,
                        column.unit.value_or(""), column.samples,
                        column.step > 0.0 ? toShortText(1.0 / column.step, kFewDigits) : "",
                        toShortText(column.least, kFewDigits), toShortText(column.largest, kFewDigits),
                        toShortText(column.noise, 2), joinOddities(column));
  }
  for (const SkippedColumn& column : look.skipped) {
    text += fmt::format("not read: {}\n", column.reason.empty() ? column.name : column.reason);
  }
  return text;
}

std::string makeLookJson(const TableLook& look) {
  Json columns = Json::array(), skipped = Json::array();
  for (const ColumnLook& column : look.columns) {
    columns.push_back(toJson(column));
  }
  for (const SkippedColumn& column : look.skipped) {
    skipped.push_back({{"name", column.name}, {"reason", column.reason}});
  }
  constexpr int kIndent = 2;
  return formatJson({{"source", look.source},
                     {"time", look.time.empty() ? Json() : Json(look.time)},
                     {"rows", look.rows},
                     {"first", look.first},
                     {"last", look.last},
                     {"remarks", look.remarks},
                     {"columns", columns},
                     {"skipped", skipped}},
                    kIndent) +
         "\n";
}

}  // namespace twinmap
