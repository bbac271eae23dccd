#include "framework/inference/segments/segment_faults.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/text/number_text.hpp"
#include "framework/data/noise/noise_estimate.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/estimation/posterior/noise/colour_fit.hpp"
#include "framework/estimation/posterior/noise/noise_candidates.hpp"
#include "framework/inference/measurement/spikes.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr const char* kOffset = "segment_offset_";  // of an output: no name of a user's has a part of it

VectorXd takeOutput(const SegmentResidual& fitted, int output) {
  std::vector<double> own;
  for (std::size_t i = 0; i < fitted.infos.size(); ++i) {
    const double residual = fitted.residual[static_cast<Index>(i)];
    if (fitted.infos[i].output == output && std::isfinite(residual)) {
      own.push_back(residual);
    }
  }
  return VectorXd::Map(own.data(), static_cast<Index>(own.size()));
}

/// With its size, and the rest of FoundNoise still to be filled in.
NoiseReport makeReport(const SegmentResidual& fitted, int output, const OutputNoiseSpec& stated, double scale,
                       const VectorXd& residual) {
  const auto i = static_cast<std::size_t>(output);
  NoiseReport report{
      fitted.layout.output_names[i], fitted.layout.output_units[i], scale * stated.stddev, 0.0, {}};
  report.found.output = output;
  report.found.factor = std::sqrt(residual.squaredNorm() / static_cast<double>(residual.size()));
  report.found.effective_samples = static_cast<double>(residual.size());
  report.stddev = report.found.factor * report.stated;
  return report;
}

OutputNoiseSpec* findNoise(const std::string& output, NoiseSpec& noise) {
  const auto found = std::find_if(noise.stddev.begin(), noise.stddev.end(),
                                  [&](const OutputNoiseSpec& one) { return one.name.text == output; });
  return found == noise.stddev.end() ? nullptr : &*found;
}

void addOffset(const std::string& output, double reach, ExperimentSpec& experiment) {
  ParameterSpec offset;
  offset.name.text = kOffset + output;
  offset.bounds = {-reach, reach, {}};
  for (OutputSpec& one : experiment.model.outputs) {
    if (one.name.text == output) {
      one.offset.text =
          one.offset.text.empty() ? offset.name.text : "(" + one.offset.text + ") + " + offset.name.text;
      experiment.model.nuisance.push_back(offset);
    }
  }
}

double findReach(const SupposedSegments& from, int output) {
  double reach = 0.0;
  for (const auto& segment : from.samples) {
    for (const double value : segment.col(output)) {
      reach = std::isfinite(value) ? std::max(reach, std::abs(value)) : reach;
    }
  }
  return reach;
}

bool lacksSamples(const SupposedSegments& from) {
  return std::any_of(from.samples.begin(), from.samples.end(),
                     [](const auto& segment) { return segment.hasNaN(); });
}

}  // namespace

std::optional<SupposedSegments> leaveSpikes(const SupposedSegments& from, const ResponseLayout& layout,
                                            const VectorXd& starts) {
  SupposedSegments without = from;
  for (std::size_t k = 0; k < from.samples.size(); ++k) {
    for (const SpikedSample& spike : findSpikes(from.samples[k].reshaped(), layout)) {
      const Index times = layout.times.size(), output = spike.row / times, time = spike.row % times;
      without.samples[k](time, output) = std::numeric_limits<double>::quiet_NaN();
      without.outliers.push_back(
          fmt::format("{}({} s) (off by {} {})", layout.output_names[static_cast<std::size_t>(output)],
                      toShortText(starts[static_cast<Index>(k)] + layout.times[time], 6),
                      toShortText(spike.height, 3), layout.output_units[static_cast<std::size_t>(output)]));
    }
  }
  return without.outliers.size() > from.outliers.size() ? std::make_optional(std::move(without))
                                                        : std::nullopt;
}

std::vector<SupposedSegments> supposeNoise(const SupposedSegments& from, const SegmentResidual& fitted) {
  SupposedSegments sizes = from, offsets = from, colours = from;
  for (int output = 0; output < static_cast<int>(fitted.layout.output_names.size()); ++output) {
    const std::string& name = fitted.layout.output_names[static_cast<std::size_t>(output)];
    const VectorXd residual = takeOutput(fitted, output);
    OutputNoiseSpec* own = findNoise(name, sizes.experiment.noise);
    if (own == nullptr || residual.size() < kFewestTested || !(residual.squaredNorm() > 0.0)) {
      continue;
    }
    NoiseReport report = makeReport(fitted, output, *own, from.experiment.noise.scale, residual);
    own->stddev.value *= report.found.factor;
    report.found.size_was_inferred = true;
    sizes.noise.push_back(report);
    report.found.size_was_inferred = false;
    addOffset(name, findReach(from, output), offsets.experiment);
    offsets.noise.push_back(report);
    offsets.noise.back().found.has_offset = true;
    const AutoregressiveModel model = fitAutoregression(residual, kMaxOrder);
    if (!model.coefficients.empty() && !isLargerThanStated(report.found)) {
      report.found.autoregression =
          VectorXd::Map(model.coefficients.data(), static_cast<Index>(model.coefficients.size()));
      // of the size that goes with it: what changes slowly is in the states
      findNoise(name, colours.experiment.noise)->stddev.value *= report.found.factor;
      colours.experiment.noise.correlation.push_back(
          {{name, {}}, model.coefficients, {}, fitted.layout.times[1] - fitted.layout.times[0]});
      colours.noise.push_back(report);
    }
  }
  std::vector<SupposedSegments> supposed{std::move(sizes), std::move(offsets)};
  if (colours.noise.size() > from.noise.size() && from.experiment.noise.correlation.empty() &&
      !lacksSamples(from)) {
    supposed.push_back(std::move(colours));
  }
  return supposed;
}

bool takeOffsets(PosteriorEstimate& estimate, SupposedSegments& supposed) {
  const BoundedDraws& draws = estimate.estimate.draws;
  const auto p = static_cast<std::size_t>(estimate.estimate.mean.size());
  for (NoiseReport& report : supposed.noise) {
    for (std::size_t i = 0; report.found.has_offset && i < estimate.nuisance.size(); ++i) {
      if (estimate.nuisance[i].name.text == kOffset + report.output) {
        const VectorXd own = draws.points.row(static_cast<Index>(p + i)).transpose();
        const double sum = draws.weights.sum(), mean = draws.weights.dot(own) / sum;
        report.found.offset = mean;
        report.found.offset_stddev =
            std::sqrt(draws.weights.dot((own.array() - mean).square().matrix()) / sum);
      }
    }
    report.found.has_offset = report.found.has_offset &&
                              std::abs(report.found.offset) > kRareDeviations * report.found.offset_stddev;
  }
  std::vector<ParameterSpec>& nuisance = estimate.nuisance;  // offsets are the last
  nuisance.erase(
      std::remove_if(nuisance.begin(), nuisance.end(),
                     [](const ParameterSpec& one) { return one.name.text.rfind(kOffset, 0) == 0; }),
      nuisance.end());
  supposed.noise.erase(std::remove_if(supposed.noise.begin(), supposed.noise.end(),
                                      [](const NoiseReport& one) {
                                        return !one.found.has_offset && !one.found.size_was_inferred &&
                                               one.found.autoregression.size() == 0;
                                      }),
                       supposed.noise.end());
  return !supposed.noise.empty();
}

}  // namespace twinmap
