#include "framework/data/reduction/response_reduction.hpp"

#include <fmt/core.h>

#include "framework/base/text/number_text.hpp"
#include "framework/data/features/layout_rows.hpp"
#include "framework/experiment/check/check_noise.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Ref;
using Eigen::VectorXd;

/// Rows of the layout that some feature reads.
std::vector<bool> findRead(const ExperimentSpec& experiment, const ResponseLayout& layout) {
  std::vector<bool> read(static_cast<std::size_t>(layout.getRowCount()), false);
  for (const FeatureSpec& feature : experiment.features) {
    for (const Name& output : getOutputs(feature)) {
      for (const Index row : findRows(layout, findOutput(layout, output.text), getWindow(feature))) {
        read[static_cast<std::size_t>(row)] = true;
      }
    }
  }
  return read;
}

/// The evenly spaced times of what is reduced, as features of samples.
SamplesFeatureSpec makeReducedSamples(Index windows, double duration) {
  SamplesFeatureSpec samples;
  samples.interval = duration / static_cast<double>(windows);
  samples.start = 0.5 * samples.interval;
  samples.count = static_cast<int>(windows);
  return samples;
}

/// A window's samples in units of their noise.
VectorXd takeWindow(const ResponseReduction& reduction, const ReductionWindow& window,
                    const Ref<const VectorXd>& response) {
  return (response(window.rows) - reduction.center(window.rows))
      .cwiseProduct(reduction.inverse_stddev(window.rows));
}

/// The sum of a_i b_(i+1) over neighbours in time of one output.
double multiplyNeighbours(const ReductionWindow& window, const VectorXd& a, const VectorXd& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < window.rows.size(); ++i) {
    if (window.rows[i + 1] == window.rows[i] + 1) {
      sum += a[static_cast<Index>(i)] * b[static_cast<Index>(i) + 1];
    }
  }
  return sum;
}

/// Half the sum of both neighbours of each sample: B v, where v' B v is the sum over neighbours.
VectorXd averageNeighbours(const ReductionWindow& window, const VectorXd& values) {
  VectorXd averaged = VectorXd::Zero(values.size());
  for (std::size_t i = 0; i + 1 < window.rows.size(); ++i) {
    if (window.rows[i + 1] == window.rows[i] + 1) {
      const auto k = static_cast<Index>(i);
      averaged[k] += 0.5 * values[k + 1];
      averaged[k + 1] += 0.5 * values[k];
    }
  }
  return averaged;
}

double calcColour(const ReductionWindow& window, const VectorXd& rest) {
  return (multiplyNeighbours(window, rest, rest) - window.colour_share * rest.squaredNorm()) /
         window.colour_scale;
}

}  // namespace

/// With P = 1 - Q Q' the sum over neighbours, r' B r, has mean tr(P B) and variance 2 tr(P B P B).
void setScales(double left, ReductionWindow& window) {
  const MatrixXd directions = window.directions.cast<double>();
  MatrixXd averaged(directions.rows(), directions.cols());
  for (Index k = 0; k < directions.cols(); ++k) {
    averaged.col(k) = averageNeighbours(window, directions.col(k));
  }
  double pairs = 0.0;
  for (std::size_t i = 0; i + 1 < window.rows.size(); ++i) {
    pairs += window.rows[i + 1] == window.rows[i] + 1 ? 1.0 : 0.0;
  }
  const MatrixXd within = directions.transpose() * averaged;
  const double degrees = window.countDegrees(), share = -within.trace() / degrees;
  const double variance =
      pairs - 4.0 * averaged.squaredNorm() + 2.0 * within.squaredNorm() - 2.0 * share * share * degrees;
  const double product = 4.0 * left;  // of noise and clean response, at most
  window.colour_share = share;
  window.rest_scale = std::sqrt(2.0 * degrees + product);
  window.colour_scale = std::sqrt(std::max(variance, 1.0) + product);
}

Index ResponseReduction::countSamples() const {
  Index count = 0;
  for (const ReductionWindow& window : windows) {
    count += static_cast<Index>(window.rows.size());
  }
  return count;
}

VectorXd ResponseReduction::reduce(const Ref<const VectorXd>& response) const {
  const Index l = countScores();
  VectorXd reduced(layout.getRowCount());
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const ReductionWindow& window = windows[w];
    const MatrixXd directions = window.directions.cast<double>();
    VectorXd rest = takeWindow(*this, window, response);
    const VectorXd scores = directions.transpose() * rest;
    rest -= directions * scores;
    const auto time = static_cast<Index>(w);
    for (Index k = 0; k < l; ++k) {
      reduced[layout.getRow(k, time)] = scores[k];
    }
    reduced[layout.getRow(l, time)] = rest.squaredNorm() / window.rest_scale;
    reduced[layout.getRow(l + 1, time)] = calcColour(window, rest);
  }
  return reduced;
}

VectorXd ResponseReduction::reduceMeasured(const VectorXd& response) const {
  const Index l = countScores();
  VectorXd reduced = reduce(response);
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const ReductionWindow& window = windows[w];
    const auto time = static_cast<Index>(w);
    reduced[layout.getRow(l, time)] -= window.countDegrees() / window.rest_scale;
  }
  return reduced;
}

MatrixXd ResponseReduction::reduceDerivatives(const Ref<const VectorXd>& response,
                                              const Ref<const MatrixXd>& derivatives) const {
  const Index l = countScores();
  MatrixXd reduced(layout.getRowCount(), derivatives.cols());
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const ReductionWindow& window = windows[w];
    const MatrixXd directions = window.directions.cast<double>();
    const auto time = static_cast<Index>(w);
    VectorXd rest = takeWindow(*this, window, response);
    rest -= directions * VectorXd(directions.transpose() * rest);
    for (Index p = 0; p < derivatives.cols(); ++p) {
      VectorXd slope = derivatives.col(p)(window.rows).cwiseProduct(inverse_stddev(window.rows));
      const VectorXd scores = directions.transpose() * slope;
      slope -= directions * scores;
      for (Index k = 0; k < l; ++k) {
        reduced(layout.getRow(k, time), p) = scores[k];
      }
      reduced(layout.getRow(l, time), p) = 2.0 * rest.dot(slope) / window.rest_scale;
      reduced(layout.getRow(l + 1, time), p) =
          2.0 * (averageNeighbours(window, rest) - window.colour_share * rest).dot(slope) /
          window.colour_scale;
    }
  }
  return reduced;
}

std::uint64_t ResponseReduction::calcDigest() const {
  constexpr std::uint64_t kOffset = 14695981039346656037ULL, kPrime = 1099511628211ULL;  // FNV-1a
  std::uint64_t digest = kOffset;
  const auto add = [&](const void* data, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i) {
      digest = (digest ^ static_cast<const unsigned char*>(data)[i]) * kPrime;
    }
  };
  add(center.data(), sizeof(double) * static_cast<std::size_t>(center.size()));
  add(inverse_stddev.data(), sizeof(double) * static_cast<std::size_t>(inverse_stddev.size()));
  for (const ReductionWindow& window : windows) {
    add(&window.rest_scale, sizeof(double));
    add(&window.colour_scale, sizeof(double));
    add(window.directions.data(), sizeof(float) * static_cast<std::size_t>(window.directions.size()));
  }
  return digest;
}

std::string ResponseReduction::describe(const std::vector<ParameterSpec>& parameters) const {
  Index worst = 0;
  const double ratio = stddev_ratio.maxCoeff(&worst);
  const Index spans = layout.times.size();
  const std::string each =
      spans > 1 ? fmt::format(", {} in each of {} spans of time", countScores(), spans) : "";
  return fmt::format(
      "{} samples are reduced to {} scores{}: standard deviations are {} times those that all samples allow, "
      "at most ({}); 'reduce: none' keeps all",
      countSamples(), countScores() * spans, each, toShortText(ratio, 5),
      parameters[static_cast<std::size_t>(worst)].name.text);
}

bool isReduced(const ExperimentSpec& experiment) {
  return std::any_of(experiment.features.begin(), experiment.features.end(), [](const FeatureSpec& feature) {
    const auto* samples = std::get_if<SamplesFeatureSpec>(&feature);
    return samples != nullptr && samples->isReduced();
  });
}

ExperimentSpec reduceLongRecord(const ExperimentSpec& experiment) {
  constexpr Index kLong =
      10000;  // a run of the cart takes 705 MB with all samples, 280 MB reduced; of 1000 as much
  ExperimentSpec reduced = experiment;
  Index count = 0;
  for (FeatureSpec& feature : reduced.features) {
    auto* samples = std::get_if<SamplesFeatureSpec>(&feature);
    if (samples != nullptr && samples->reduce) {
      return experiment;
    }
    if (samples != nullptr) {
      samples->reduce = SampleReduction::kAutomatic;
      count += static_cast<Index>(samples->outputs.size()) * samples->count;
    }
  }
  const bool may_be = experiment.trials.empty() && !experiment.inverse_map.isNone() &&
                      !experiment.model.source && findReductionFault(reduced).empty();
  return count >= kLong && may_be ? reduced : experiment;
}

void requireAllSamples(const ExperimentSpec& experiment, const std::string& what) {
  if (isReduced(experiment)) {
    throw ExperimentError({experiment.name.where.file, 0, 0, "features"}, "",
                          "are reduced, but " + what + " needs all samples; give them 'reduce: none'");
  }
}

ExperimentSpec reduceExperiment(ExperimentSpec experiment, const ResponseReduction& reduction) {
  SamplesFeatureSpec samples =
      makeReducedSamples(static_cast<Index>(reduction.windows.size()), experiment.model.simulation.duration);
  NoiseSpec noise;
  noise.replicates = experiment.noise.replicates;
  for (const std::string& name : reduction.layout.output_names) {
    samples.outputs.push_back({name, {}});
    noise.stddev.push_back({{name, {}}, 1.0});
  }
  experiment.features = {samples};
  experiment.noise = noise;
  return experiment;
}

std::vector<ReductionWindow> partResponse(const ExperimentSpec& experiment, const ResponseLayout& layout) {
  const std::vector<bool> read = findRead(experiment, layout);
  const Index samples = std::count(read.begin(), read.end(), true), times = layout.times.size();
  const Index count = std::min(static_cast<Index>(countReducedWindows(static_cast<double>(samples))), times);
  std::vector<ReductionWindow> windows(static_cast<std::size_t>(count));
  for (Index row = 0; row < layout.getOutputCount() * times; ++row) {
    if (read[static_cast<std::size_t>(row)]) {
      windows[static_cast<std::size_t>(row % times * count / times)].rows.push_back(row);
    }
  }
  return windows;
}

ResponseLayout makeReducedLayout(Index windows, Index scores, double duration) {
  ResponseLayout layout;
  for (Index k = 1; k <= scores; ++k) {
    layout.output_names.push_back("score_" + std::to_string(k));
  }
  layout.output_names.insert(layout.output_names.end(), {"rest", "colour"});
  layout.output_units.assign(layout.output_names.size(), "1");
  const SamplesFeatureSpec samples = makeReducedSamples(windows, duration);
  layout.times.resize(windows);
  for (Index w = 0; w < windows; ++w) {
    layout.times[w] = calcSampleTime(samples, static_cast<int>(w));
  }
  return layout;
}

}  // namespace twinmap
