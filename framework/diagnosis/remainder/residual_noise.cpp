#include "framework/diagnosis/remainder/residual_noise.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "framework/base/text/number_text.hpp"
#include "framework/base/text/source_location.hpp"

namespace twinmap {
namespace {

/// Of the residuals of an output; 0 where it has none.
double calcMeanSquare(const WhitenedResidual& fit, const std::vector<std::string>& outputs,
                      const std::string& name) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < fit.infos.size(); ++i) {
    const int output = fit.infos[i].output;
    if (output >= 0 && outputs[static_cast<std::size_t>(output)] == name) {
      const double residual = fit.residual[static_cast<Eigen::Index>(i)];
      sum += residual * residual;
      ++count;
    }
  }
  return count > 0 ? sum / count : 0.0;
}

}  // namespace

std::vector<std::string> listUnknownNoise(const NoiseSpec& noise) {
  std::vector<std::string> outputs;
  for (const OutputNoiseSpec& one : noise.stddev) {
    if (one.stddev.unknown) {
      outputs.push_back(one.name.text);
    }
  }
  return outputs;
}

bool hasUnknownNoise(const NoiseSpec& noise) {
  return !listUnknownNoise(noise).empty();
}

void requireKnownNoise(const ExperimentSpec& experiment, const std::string& question) {
  if (hasUnknownNoise(experiment.noise)) {
    throw ExperimentError(experiment.name.where, experiment.name.text,
                          "has noise of unknown size, without which nobody knows " + question +
                              "; give 'noise.stddev' a number");
  }
}

NoiseSpec sizeNoise(const NoiseSpec& stated, const WhitenedResidual& fit,
                    const std::vector<std::string>& outputs) {
  NoiseSpec sized = stated;
  const double taken_up = static_cast<double>(fit.infos.size()) / std::max(1.0, fit.degrees);
  for (std::size_t i = 0; i < sized.stddev.size(); ++i) {
    NoiseStddev& stddev = sized.stddev[i].stddev;
    const double mean_square = calcMeanSquare(fit, outputs, sized.stddev[i].name.text);
    if (stddev.unknown && mean_square > 0.0) {
      stddev.value = fit.used.stddev[i].stddev.value * std::sqrt(taken_up * mean_square);
      stddev.unknown = false;
    }
  }
  return sized;
}

std::string describeSizes(const NoiseSpec& stated, const NoiseSpec& sized) {
  std::string text;
  for (std::size_t i = 0; i < stated.stddev.size(); ++i) {
    if (stated.stddev[i].stddev.unknown) {
      text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", toShortText(sized.stddev[i].stddev, 3),
                          stated.stddev[i].name.text);
    }
  }
  return text;
}

std::size_t findLeastNoise(const std::vector<NoiseSpec>& sized) {
  std::vector<double> sizes;  // logarithms
  for (const NoiseSpec& noise : sized) {
    sizes.push_back(std::accumulate(
        noise.stddev.begin(), noise.stddev.end(), 0.0,
        [](double sum, const OutputNoiseSpec& one) { return sum + std::log(one.stddev.value); }));
  }
  return static_cast<std::size_t>(std::min_element(sizes.begin(), sizes.end()) - sizes.begin());
}

void copyNoise(const ExperimentSpec& from, ExperimentSpec& to) {
  to.noise = from.noise;
  for (std::size_t t = 0; t < to.trials.size(); ++t) {
    to.trials[t].experiment.noise = from.trials[t].experiment.noise;
  }
}

}  // namespace twinmap
