#include "framework/inference/measurement/alternation.hpp"

#include <fmt/core.h>

#include <cmath>

#include "framework/base/text/number_text.hpp"
#include "framework/data/measurement/lagrange.hpp"
#include "framework/estimation/levels.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// What the second, fourth ... samples are above the cubic through their odd neighbours.
std::vector<double> listHeights(const VectorXd& times, const VectorXd& values) {
  std::vector<double> heights;
  for (Index i = 3; i + 3 < values.size(); i += 2) {
    VectorXd at(4), odd(4);
    at << times[i - 3], times[i - 1], times[i + 1], times[i + 3];
    odd << values[i - 3], values[i - 1], values[i + 1], values[i + 3];
    heights.push_back(values[i] - apply(makeLagrange(at, 0, 4, times[i]), odd));
  }
  return heights;
}

/// By how much each second sample is off; 0 where that is not what it is.
double calcAlternation(const VectorXd& times, const VectorXd& values) {
  const std::vector<double> heights = listHeights(times, values);
  const Eigen::Map<const VectorXd> all(heights.data(), static_cast<Index>(heights.size()));
  if (all.size() < 2 * kPerUnknown) {  // a mean and how they scatter
    return 0.0;
  }
  const double mean = all.mean();
  const double stddev = std::sqrt((all.array() - mean).square().mean());
  return std::abs(mean) > kBasinReach * stddev && mean != 0.0 ? mean : 0.0;
}

}  // namespace

Alternation findAlternation(const VectorXd& measured, const ResponseLayout& layout) {
  Alternation found{VectorXd::Zero(measured.size()), {}};
  for (Index output = 0; output < layout.getOutputCount(); ++output) {
    std::vector<Index> there;
    for (Index i = 0; i < layout.times.size(); ++i) {
      if (std::isfinite(measured[layout.getRow(output, i)])) {
        there.push_back(i);
      }
    }
    const VectorXd own = measured.segment(layout.getRow(output, 0), layout.times.size());
    const double off = calcAlternation(layout.times(there), own(there));
    if (off == 0.0) {
      continue;
    }
    for (std::size_t k = 0; k < there.size(); ++k) {
      found.shift[layout.getRow(output, there[k])] = (k % 2 == 0 ? 0.5 : -0.5) * off;
    }
    const auto o = static_cast<std::size_t>(output);
    found.said.push_back(fmt::format(
        "{} is off by {} {} in every other sample, as of marks that are not evenly spaced: half of it "
        "is taken off each; which of them is right, the recording does not tell",
        layout.output_names[o], toShortText(off, 3), layout.output_units[o]));
  }
  return found;
}

}  // namespace twinmap
