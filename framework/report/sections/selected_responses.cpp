#include "framework/report/sections/selected_responses.hpp"

#include <algorithm>
#include <cmath>

#include "framework/report/sections/samples_table.hpp"
#include "framework/report/vega.hpp"

namespace twinmap {
namespace {

constexpr const char* kTable = "selected-responses";
constexpr int kMostShown = 12;
constexpr Eigen::Index kMostTimes = 200;
constexpr double kSteps = 65535.0;

struct Range {
  double lower = 0.0, upper = 1.0;
};

/// The rows of an output's response that are kept.
std::vector<Eigen::Index> findKeptTimes(Eigen::Index count) {
  const Eigen::Index step = (count + kMostTimes - 1) / kMostTimes;
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < count; i += step) {
    kept.push_back(i);
  }
  return kept;
}

Range findRange(const Eigen::MatrixXd& responses, Eigen::Index first_row, Eigen::Index rows) {
  Range range{HUGE_VAL, -HUGE_VAL};
  for (Eigen::Index column = 0; column < responses.cols(); ++column) {
    for (Eigen::Index row = first_row; row < first_row + rows; ++row) {
      const double value = responses(row, column);
      if (std::isfinite(value)) {
        range = {std::min(range.lower, value), std::max(range.upper, value)};
      }
    }
  }
  return range.lower < range.upper ? range : Range{};
}

void appendFraction(double value, const Range& range, std::vector<unsigned char>& bytes) {
  const double fraction = std::clamp((value - range.lower) / (range.upper - range.lower), 0.0, 1.0);
  const auto step = static_cast<unsigned>(std::isfinite(value) ? std::lround(fraction * kSteps) : 0);
  bytes.push_back(static_cast<unsigned char>(step & 255U));
  bytes.push_back(static_cast<unsigned char>(step >> 8U));
}

/// NaN for a sample that the file does not hold.
double getResponse(const StoredResponses& stored, Eigen::Index row, double sample) {
  const auto column = static_cast<Eigen::Index>(sample);
  return column < stored.responses.cols() ? stored.responses(row, column) : NAN;
}

/// The drawn samples' responses, sample by sample, output by output.
std::vector<unsigned char> packResponses(const StoredResponses& stored, const std::vector<double>& samples,
                                         const std::vector<Range>& ranges) {
  const Eigen::Index times = stored.times.size();
  const std::vector<Eigen::Index> kept = findKeptTimes(times);
  std::vector<unsigned char> bytes;
  for (const double sample : samples) {
    for (std::size_t output = 0; output < ranges.size(); ++output) {
      for (const Eigen::Index time : kept) {
        const Eigen::Index row = static_cast<Eigen::Index>(output) * times + time;
        appendFraction(getResponse(stored, row, sample), ranges[output], bytes);
      }
    }
  }
  return bytes;
}

Json makeTimes(const Eigen::VectorXd& times) {
  Json kept = Json::array();
  for (const Eigen::Index time : findKeptTimes(times.size())) {
    kept.push_back(times[time]);
  }
  return kept;
}

std::vector<double> findDrawnSamples(const RunFolder& run) {
  std::vector<double> samples =
      collectPredictions(run.predictions, run.experiment.model.parameters[0].name.text).samples;
  samples.resize(std::min(samples.size(), kMostDrawnSamples));
  return samples;
}

Panel makePanel(const StoredResponses& stored, std::size_t output) {
  const std::string label = makeLabel(stored.output_names[output], stored.output_units[output]);
  Json spec = makePanelSpec(kTable, 140);
  spec.erase("params");
  spec["transform"] = {{{"filter", {{"field", "output"}, {"equal", stored.output_names[output]}}}}};
  spec["mark"] = {{"type", "line"}, {"strokeWidth", 1}, {"color", "var(--ink)"}, {"opacity", 0.7}};
  spec["encoding"] = {{"x", makeQuantitative("time", "time [s]")},
                      {"y", makeQuantitative("value", label, makeFreeScale())},
                      {"detail", {{"field", "sample"}, {"type", "nominal"}}},
                      {"tooltip", {makeNominal("sample", "sample")}}};
  return {"Response " + label + " of the highlighted samples over time", spec};
}

}  // namespace

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

void addSelectedResponses(const RunFolder& run, Section& section, Page& page) {
  const std::vector<double> samples = findDrawnSamples(run);
  page.extras["samples"] = samples;
  if (!run.test_responses || run.test_responses->times.size() == 0) {
    return;
  }
  const StoredResponses& stored = *run.test_responses;
  std::vector<Range> ranges;
  Json outputs = Json::array();
  Figure figure{kTable,
                "Responses of the highlighted samples",
                "Clean simulated responses, as in samples.h5; at most " + std::to_string(kMostShown) +
                    " samples are shown.",
                kTable,
                {},
                {},
                2};
  for (std::size_t i = 0; i < stored.output_names.size(); ++i) {
    const Eigen::Index times = stored.times.size();
    ranges.push_back(findRange(stored.responses, static_cast<Eigen::Index>(i) * times, times));
    outputs.push_back(
        {{"name", stored.output_names[i]}, {"lower", ranges[i].lower}, {"upper", ranges[i].upper}});
    figure.panels.push_back(makePanel(stored, i));
  }
  page.extras["responses"] = {{"times", makeTimes(stored.times)},
                              {"outputs", outputs},
                              {"samples", samples},
                              {"most", kMostShown},
                              {"data", encodeBase64(packResponses(stored, samples, ranges))}};
  addFigure(std::move(figure), section);
}

}  // namespace twinmap
