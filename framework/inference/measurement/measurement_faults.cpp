#include "framework/inference/measurement/measurement_faults.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// `example` is given where the output's unit contains `unit`.
struct UnitFactor {
  double factor;
  const char *said, *example, *unit, *remedy;
};

constexpr UnitFactor kFactors[] = {
    {1000.0, "1000 times too large", ", as mm in the place of m", "m", "divide it by 1000"},
    {1e-3, "1000 times too small", "", "", "multiply it by 1000"},
    {57.29577951308232, "57.3 times too large", ", as deg in the place of rad", "rad", "divide it by 57.3"},
    {1.0 / 57.29577951308232, "57.3 times too small", "", "", "multiply it by 57.3"},
    {9.81, "9.81 times too large", ", as m/s2 in the place of g", "", "divide it by 9.81"},
    {1.0 / 9.81, "9.81 times too small", ", as g in the place of m/s2", "", "multiply it by 9.81"},
    {100.0, "100 times too large", ", as cm in the place of m", "m", "divide it by 100"},
    {0.01, "100 times too small", "", "", "multiply it by 100"},
    {-1.0, "of the other sign", "", "", "turn its sign"}};

std::string describe(const UnitFactor& factor, const std::string& output, const std::string& unit) {
  const bool applies = unit.find(factor.unit) != std::string::npos;
  return fmt::format("{} is {}{}: {}", output, factor.said, applies ? factor.example : "", factor.remedy);
}

/// The measurement without an offset of some rows.
VectorXd subtract(VectorXd measured, Index first, Index count, double offset) {
  measured.segment(first, count).array() -= offset;
  return measured;
}

/// The offset of some rows that leaves the least misfit, by parabolas through three of them, from `offset`
/// on: chi-square is quadratic in it where the features are linear, and nearly so elsewhere.
double findOffset(const VectorXd& measured, Index first, Index count, double offset, double step,
                  const MisfitOfResponse& calcMisfit) {
  constexpr int kParabolas = 3;
  for (int i = 0; i < kParabolas && step > 0.0; ++i) {
    const double below = calcMisfit(subtract(measured, first, count, offset - step));
    const double at = calcMisfit(subtract(measured, first, count, offset));
    const double above = calcMisfit(subtract(measured, first, count, offset + step));
    const double bend = below - 2.0 * at + above;
    if (!(bend > 0.0)) {
      break;
    }
    offset += 0.5 * step * (below - above) / bend;
    step *= 0.1;
  }
  return offset;
}

/// The best explanation so far.
class Search {
 public:
  Search(double most, const MisfitOfResponse& calcMisfit) : least_(most), calcMisfit_(calcMisfit) {}

  /// Whether it is the best one so far.
  bool tryOut(const VectorXd& corrected, const std::string& said) {
    const double chi_square = calcMisfit_(corrected);
    const bool better = chi_square < least_;
    if (better) {
      least_ = chi_square;
      said_ = said;
    }
    return better;
  }
  const std::string& getSaid() const { return said_; }

 private:
  double least_;
  const MisfitOfResponse& calcMisfit_;
  std::string said_;
};

struct Spike {
  Index sample = 0;
  double height = 0.0;  ///< above the cubic through the four neighbours
};

/// The sample of evenly spaced ones that is farthest off the cubic through its neighbours; of height 0 where
/// none stands out: noise and curvature put half of the samples off, and a spike that makes a gross misfit
/// is far above both.
Spike findSpike(const Eigen::Ref<const VectorXd>& samples) {
  constexpr double kStandsOut = 6.0;  // of 1000 normal numbers the largest is 5 times the median
  Spike spike;
  std::vector<double> heights;
  for (Index i = 2; i + 2 < samples.size(); ++i) {
    const double cubic = (4.0 * (samples[i - 1] + samples[i + 1]) - samples[i - 2] - samples[i + 2]) / 6.0;
    const double height = samples[i] - cubic;
    if (std::isfinite(height)) {
      heights.push_back(std::abs(height));
      spike = std::abs(height) > std::abs(spike.height) ? Spike{i, height} : spike;
    }
  }
  if (heights.empty()) {
    return spike;
  }
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  return std::abs(spike.height) > kStandsOut * *middle ? spike : Spike{};
}

/// One to three samples of an output that alone are wrong.
void trySpikes(const VectorXd& measured, const ResponseLayout& layout, Index output,
               const MisfitOfResponse& calcMisfit, Search& search) {
  constexpr int kMost = 3;
  constexpr double kStep = 0.1;  // of the height, which the cubic overestimates little
  const Index times = layout.times.size(), first = layout.getRow(output, 0);
  VectorXd corrected = measured;
  std::string places;
  for (int i = 0; i < kMost; ++i) {
    const auto [sample, height] = findSpike(corrected.segment(first, times));
    if (height == 0.0) {
      return;
    }
    const double offset =
        findOffset(corrected, first + sample, 1, height, kStep * std::abs(height), calcMisfit);
    corrected = subtract(corrected, first + sample, 1, offset);
    places += fmt::format("{}{:.4g} s", places.empty() ? "" : ", ", layout.times[sample]);
    if (search.tryOut(corrected, fmt::format("{} has {} at {}: repair the recording, or empty the cell{}",
                                             layout.output_names[static_cast<std::size_t>(output)],
                                             i == 0 ? "a spike" : "spikes", places, i == 0 ? "" : "s"))) {
      return;
    }
  }
}

/// The response without the samples of an output that stand at its largest or its least value, as a sensor
/// that clips shows it; false where neither has four of them.
bool dropClipped(VectorXd& response, Index first, Index count, Index& dropped) {
  constexpr Index kFewest = 4;  // of numbers with noise no two are the same
  const VectorXd values = response.segment(first, count);
  const VectorXd finite =
      values.array().isFinite().select(values, values.array().isFinite().select(values, 0.0).mean());
  dropped = 0;
  for (const double limit : {finite.maxCoeff(), finite.minCoeff()}) {
    const auto at_limit = values.array() == limit;
    if (at_limit.count() >= kFewest) {
      dropped += at_limit.count();
      response.segment(first, count) =
          at_limit.select(std::numeric_limits<double>::quiet_NaN(), response.segment(first, count));
    }
  }
  return dropped > 0;
}

/// Factors between units. One that makes an output small explains it only where a zero does not do as well.
void tryUnits(const VectorXd& measured, const ResponseLayout& layout, Index output,
              const MisfitOfResponse& calcMisfit, Search& search) {
  constexpr double kClearly = 0.5;  // of the chi-square of a zero
  const Index times = layout.times.size(), first = layout.getRow(output, 0);
  VectorXd silent = measured;
  silent.segment(first, times).setZero();
  const double largest = kClearly * calcMisfit(silent);
  for (const UnitFactor& unit : kFactors) {
    VectorXd corrected = measured;
    corrected.segment(first, times) /= unit.factor;
    if (unit.factor <= 1.0 || calcMisfit(corrected) < largest) {
      search.tryOut(corrected, describe(unit, layout.output_names[static_cast<std::size_t>(output)],
                                        layout.output_units[static_cast<std::size_t>(output)]));
    }
  }
}

}  // namespace

std::string explainByFault(const VectorXd& measured, const ResponseLayout& layout, double chi_square,
                           Index residuals, const MisfitOfResponse& calcMisfit) {
  constexpr double kGross =
      100.0;  // chi-square a residual: sensors and units do that, missing physics rarely
  constexpr double kLeft = 0.01;
  if (!(chi_square > kGross * static_cast<double>(residuals)) || layout.times.size() == 0) {
    return "";
  }
  Search search(kLeft * chi_square, calcMisfit);
  const Index times = layout.times.size();
  if (layout.getOutputCount() > 1) {
    search.tryOut(-measured, "all outputs are of the other sign: turn their signs");
  }
  for (Index output = 0; output < layout.getOutputCount(); ++output) {
    const std::string& name = layout.output_names[static_cast<std::size_t>(output)];
    const Index first = layout.getRow(output, 0);
    tryUnits(measured, layout, output, calcMisfit, search);
    trySpikes(measured, layout, output, calcMisfit, search);
    VectorXd unclipped = measured;
    if (Index dropped = 0; dropClipped(unclipped, first, times, dropped)) {
      search.tryOut(unclipped, fmt::format("{} is clipped in {} samples: state what it can show, "
                                           "measurement.range",
                                           name, dropped));
    }
    const auto values = measured.segment(first, times).array();
    const double offset =
        findOffset(measured, first, times, 0.0, (values - values.mean()).abs().maxCoeff(), calcMisfit);
    search.tryOut(subtract(measured, first, times, offset),
                  fmt::format("{} has an offset of {:.4g}: subtract it", name, offset));
    for (Index other = 0; other < output; ++other) {
      VectorXd corrected = measured;
      const Index second = layout.getRow(other, 0);
      corrected.segment(first, times) = measured.segment(second, times);
      corrected.segment(second, times) = measured.segment(first, times);
      search.tryOut(corrected, fmt::format("the columns of {} and {} are swapped",
                                           layout.output_names[static_cast<std::size_t>(other)], name));
    }
  }
  return search.getSaid();
}

}  // namespace twinmap
