#include <fmt/core.h>

#include <algorithm>
#include <cctype>

#include "framework/base/json/json.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/data/noise/signal_noise.hpp"

namespace twinmap {
namespace {

std::string joinNumbers(const std::vector<double>& numbers, int digits) {
  std::string text;
  for (const double number : numbers) {
    text += (text.empty() ? "" : ", ") + toShortText(number, digits);
  }
  return text;
}

std::string makeLabel(const SignalNoise& signal) {
  return signal.name + (signal.unit.empty() ? "" : " [" + signal.unit + "]");
}

/// A key of a YAML map: plain if it is an identifier, else quoted.
std::string makeKey(const std::string& name) {
  const bool plain =
      std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
  return plain ? name : formatJson(name);
}

}  // namespace

std::string makeNoiseTable(const std::vector<SignalNoise>& signals) {
  constexpr int kShownDigits = 5, kDigits = 6, kErrorDigits = 2;
  std::size_t width = 6;
  for (const SignalNoise& signal : signals) {
    width = std::max(width, makeLabel(signal).size());
  }
  std::string text = fmt::format("{:<{}}  {:>9}  {:>12}  {:>12}  {:>8}  {:>9}  {}\n", "column", width,
                                 "samples", "mean", "stddev", "+-", "whiteness", "autoregression");
  for (const SignalNoise& signal : signals) {
    const std::vector<double>& coefficients = signal.noise.model.coefficients;
    text += fmt::format("{:<{}}  {:>9}  {:>12}  {:>12}  {:>8}  {:>9}  {}\n", makeLabel(signal), width,
                        signal.samples, toShortText(signal.noise.mean, kDigits),
                        toShortText(signal.noise.stddev, kDigits),
                        toShortText(signal.noise.stddev_error, kErrorDigits),
                        toShortText(signal.noise.whiteness, kErrorDigits),
                        coefficients.empty() ? "none, white" : joinNumbers(coefficients, kShownDigits));
  }
  return text;
}

std::string makeNoiseJson(const std::vector<SignalNoise>& signals, const std::string& source) {
  Json columns = Json::array();
  for (const SignalNoise& signal : signals) {
    Json column{{"name", signal.name},
                {"unit", signal.unit},
                {"samples", signal.samples},
                {"mean", signal.noise.mean},
                {"stddev", signal.noise.stddev},
                {"stddev_error", signal.noise.stddev_error},
                {"autoregression", signal.noise.model.coefficients},
                {"innovation_stddev", signal.noise.model.innovation_stddev},
                {"whiteness", signal.noise.whiteness}};
    column["sample_time"] = signal.sample_time ? Json(*signal.sample_time) : Json();
    columns.push_back(std::move(column));
  }
  constexpr int kIndent = 2;
  return formatJson({{"source", source}, {"columns", columns}}, kIndent) + "\n";
}

std::string makeNoiseYaml(const std::vector<SignalNoise>& signals) {
  constexpr int kDigits = 5, kTimeDigits = 10;
  constexpr int kCoefficientDigits = 10;  // few digits may make a model unstable
  std::string stddev, correlation;
  for (const SignalNoise& signal : signals) {
    stddev += (stddev.empty() ? "" : ", ") + makeKey(signal.name) + ": " +
              toShortText(signal.noise.stddev, kDigits);
    if (!signal.noise.model.coefficients.empty()) {
      correlation +=
          "    " + makeKey(signal.name) + ": {autoregression: [" +
          joinNumbers(signal.noise.model.coefficients, kCoefficientDigits) + "]" +
          (signal.sample_time ? ", sample_time: " + toShortText(*signal.sample_time, kTimeDigits) : "") +
          "}\n";
    }
  }
  return "noise:\n  stddev: {" + stddev + "}\n" +
         (correlation.empty() ? "" : "  correlation:\n" + correlation);
}

}  // namespace twinmap
