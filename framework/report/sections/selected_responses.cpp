#include "framework/report/sections/selected_responses.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/base/text/base64.hpp"
#include "framework/report/sections/samples_table.hpp"
#include "framework/store/samples_file.hpp"

namespace twinmap {
namespace {

constexpr const char* kSelectedResponses = "selected-responses";
constexpr int kMaxShown = 12;
constexpr Eigen::Index kMaxTimes = 200;
constexpr double kSteps = 65535.0;

/// The rows of an output's response that are kept.
std::vector<Eigen::Index> findKeptTimes(Eigen::Index count) {
  const Eigen::Index step = (count + kMaxTimes - 1) / kMaxTimes;
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < count; i += step) {
    kept.push_back(i);
  }
  return kept;
}

OutputRange findRange(const StoredResponses& stored, std::size_t output) {
  const Eigen::MatrixXd& responses = stored.responses;
  const Eigen::Index rows = stored.times.size();
  const Eigen::Index first_row = static_cast<Eigen::Index>(output) * rows;
  OutputRange range{stored.output_names[output], HUGE_VAL, -HUGE_VAL};
  for (Eigen::Index column = 0; column < responses.cols(); ++column) {
    for (Eigen::Index row = first_row; row < first_row + rows; ++row) {
      const double value = responses(row, column);
      if (std::isfinite(value)) {
        range.lower = std::min(range.lower, value);
        range.upper = std::max(range.upper, value);
      }
    }
  }
  return range.lower < range.upper ? range : OutputRange{range.name};
}

void appendFraction(double value, const OutputRange& range, std::vector<unsigned char>& bytes) {
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
                                         const std::vector<OutputRange>& ranges) {
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

std::vector<double> takeKeptTimes(const Eigen::VectorXd& times) {
  std::vector<double> kept;
  for (const Eigen::Index time : findKeptTimes(times.size())) {
    kept.push_back(times[time]);
  }
  return kept;
}

std::vector<double> findDrawnSamples(const RunFolder& run) {
  std::vector<double> samples = collectPredictions(run, run.experiment.model.parameters[0].name.text).samples;
  samples.resize(std::min(samples.size(), kMaxDrawnSamples));
  return samples;
}

Panel makeOutputPanel(const StoredResponses& stored, std::size_t output) {
  const std::string& name = stored.output_names[output];
  return {"selected-responses", {{"output", name}, {"label", makeLabel(name, stored.output_units[output])}}};
}

}  // namespace

void addSelectedResponses(const RunFolder& run, Section& section, Page& page) {
  const std::vector<double> samples = findDrawnSamples(run);
  page.samples = samples;
  if (!run.test_responses || run.test_responses->times.size() == 0) {
    return;
  }
  const StoredResponses& stored = *run.test_responses;
  std::vector<OutputRange> ranges;
  Figure figure{
      kSelectedResponses,
      "Responses of the highlighted samples",
      fmt::format("Clean simulated responses, as in samples.h5; at most {} samples are shown.", kMaxShown),
      kSelectedResponses,
      {},
      {},
      2};
  for (std::size_t i = 0; i < stored.output_names.size(); ++i) {
    ranges.push_back(findRange(stored, i));
    figure.panels.push_back(makeOutputPanel(stored, i));
  }
  const std::string data = encodeBase64(packResponses(stored, samples, ranges));
  page.responses = PackedResponses{takeKeptTimes(stored.times), ranges, samples, kMaxShown, data};
  addFigure(std::move(figure), section);
}

}  // namespace twinmap
