#include "framework/inference/measurement/measurement_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "framework/base/text/number_text.hpp"
#include "framework/data/measurement/time_series.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/inference/measurement/spikes.hpp"
#include "framework/inference/measurement/wrap_modulus.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kFewestEqual = 4;  // of numbers with noise no two are the same

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

std::string describe(const UnitFactor& factor, const std::vector<std::string>& outputs,
                     const std::string& unit) {
  const bool applies = unit.find(factor.unit) != std::string::npos, one = outputs.size() == 1;
  std::string remedy = factor.remedy;
  if (const std::size_t it = remedy.find(" it "); it != std::string::npos && !one) {
    remedy.replace(it, 4, " each ");
  }
  return fmt::format("{} {} {}{}: {}", fmt::join(outputs, " and "), one ? "is" : "are", factor.said,
                     applies ? factor.example : "", remedy);
}

/// The measurement without what is added to some rows: so much of `shape`.
VectorXd subtract(VectorXd measured, Index first, const VectorXd& shape, double amount) {
  measured.segment(first, shape.size()) -= amount * shape;
  return measured;
}

/// The amount of a shape in some rows that leaves the least misfit, by parabolas through three of them, from
/// `amount` on. Chi-square is quadratic in it for linear features, and nearly so elsewhere.
double findAmount(const VectorXd& measured, Index first, const VectorXd& shape, double amount, double step,
                  const MisfitOfResponse& calcMisfit) {
  constexpr int kParabolas = 3;
  for (int i = 0; i < kParabolas && step > 0.0; ++i) {
    const double below = calcMisfit(subtract(measured, first, shape, amount - step));
    const double at = calcMisfit(subtract(measured, first, shape, amount));
    const double above = calcMisfit(subtract(measured, first, shape, amount + step));
    const double bend = below - 2.0 * at + above;
    if (!(bend > 0.0)) {
      break;
    }
    amount += 0.5 * step * (below - above) / bend;
    step *= 0.1;
  }
  return amount;
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

/// Samples of an output that alone are wrong, the highest first.
void trySpikes(const VectorXd& measured, const ResponseLayout& layout, Index output, Search& search) {
  const Index times = layout.times.size(), first = layout.getRow(output, 0);
  VectorXd without = measured;
  std::string places;
  for (const SpikedSample& spike : findSpikes(measured, layout)) {
    if (spike.row < first || spike.row >= first + times) {
      continue;
    }
    const bool is_one = places.empty();
    without[spike.row] = std::numeric_limits<double>::quiet_NaN();
    places += fmt::format("{}{:.4g} s", is_one ? "" : ", ", layout.times[spike.row - first]);
    if (search.tryOut(without, fmt::format("{} has {} at {}: repair the recording, or empty the cell{}",
                                           layout.output_names[static_cast<std::size_t>(output)],
                                           is_one ? "a spike" : "spikes", places, is_one ? "" : "s"))) {
      return;
    }
  }
}

/// The response without the samples of an output that stand at its largest or its least value, as a sensor
/// that clips shows it; false where neither has four of them.
bool dropClipped(VectorXd& response, Index first, Index count, Index& dropped) {
  const VectorXd values = response.segment(first, count);
  const VectorXd finite =
      values.array().isFinite().select(values, values.array().isFinite().select(values, 0.0).mean());
  dropped = 0;
  for (const double limit : {finite.maxCoeff(), finite.minCoeff()}) {
    const auto at_limit = values.array() == limit;
    if (at_limit.count() >= kFewestEqual) {
      dropped += at_limit.count();
      response.segment(first, count) =
          at_limit.select(std::numeric_limits<double>::quiet_NaN(), response.segment(first, count));
    }
  }
  return dropped > 0;
}

/// The longest stretch of an output in which it holds one value.
struct Stretch {
  Index first = 0, count = 0;
};

Stretch findHeld(const Eigen::Ref<const VectorXd>& samples) {
  Stretch longest, now;
  for (Index i = 0; i < samples.size(); ++i) {
    now = i > 0 && samples[i] == samples[i - 1] ? Stretch{now.first, now.count + 1} : Stretch{i, 1};
    longest = now.count > longest.count ? now : longest;
  }
  return longest;
}

/// Samples at the largest or the least value, and those of the longest stretch that holds another.
void tryStandstill(const VectorXd& measured, const ResponseLayout& layout, Index output, Search& search) {
  const std::string& name = layout.output_names[static_cast<std::size_t>(output)];
  const Index times = layout.times.size(), first = layout.getRow(output, 0);
  VectorXd unclipped = measured;
  if (Index dropped = 0; dropClipped(unclipped, first, times, dropped)) {
    search.tryOut(unclipped, fmt::format("{} is clipped in {} samples: state what it can show, "
                                         "measurement.range",
                                         name, dropped));
  }
  const Stretch held = findHeld(measured.segment(first, times));
  if (held.count >= kFewestEqual) {
    VectorXd without = measured;
    without.segment(first + held.first, held.count).setConstant(std::numeric_limits<double>::quiet_NaN());
    search.tryOut(without, fmt::format("{} holds {:.4g} from {:.4g} s to {:.4g} s: empty these cells", name,
                                       measured[first + held.first], layout.times[held.first],
                                       layout.times[held.first + held.count - 1]));
  }
}

/// An offset, and one that grows with time.
void tryDrift(const VectorXd& measured, const ResponseLayout& layout, Index output,
              const MisfitOfResponse& calcMisfit, Search& search) {
  const std::string& name = layout.output_names[static_cast<std::size_t>(output)];
  const std::string& unit = layout.output_units[static_cast<std::size_t>(output)];
  const Index times = layout.times.size(), first = layout.getRow(output, 0);
  const auto values = measured.segment(first, times).array();
  const double range = (values - values.mean()).abs().maxCoeff();
  const VectorXd ones = VectorXd::Ones(times);
  const double offset = findAmount(measured, first, ones, 0.0, range, calcMisfit);
  search.tryOut(subtract(measured, first, ones, offset),
                fmt::format("{} has an offset of {:.4g}: subtract it", name, offset));
  const double length = layout.times[times - 1] - layout.times[0];
  const VectorXd ramp = (layout.times.array() - layout.times[0]) / length;
  const double growth = findAmount(measured, first, ramp, 0.0, range, calcMisfit);
  search.tryOut(subtract(measured, first, ramp, growth),
                fmt::format("{} drifts by {:.4g}{} a second: subtract the drift", name, growth / length,
                            unit.empty() ? "" : " " + unit));
}

/// A counter that wraps: by a modulus of few digits, or by what it jumps.
void tryWrap(const VectorXd& measured, const ResponseLayout& layout, Index output, Search& search) {
  const std::string& name = layout.output_names[static_cast<std::size_t>(output)];
  const Index times = layout.times.size(), first = layout.getRow(output, 0);
  const VectorXd values = measured.segment(first, times);
  const double modulus = findModulus(layout.times, values);
  constexpr double kSame = 1e-4;  // more digits would follow the noise
  bool is_said = false;
  for (const int digits : {1, 2, 3, 6}) {
    const std::string text = toShortText(modulus, digits);
    const double rounded = std::stod(text);
    if (rounded <= 0.0 || is_said) {
      continue;
    }
    is_said = std::abs(rounded - modulus) < kSame * modulus;
    const VectorXd whole = unwrap(layout.times, values, rounded);
    const double lowest = values.minCoeff() >= 0.0 ? 0.0 : -0.5 * rounded;
    const std::string said = fmt::format(
        "{} jumps by {} {} again and again, as a counter that wraps: give "
        "measurement.unwrap: [{}] and measurement.range: {{{}: [{}, {}]}}",
        name, text, layout.output_units[static_cast<std::size_t>(output)], name, name, toShortText(lowest, 6),
        toShortText(lowest + rounded, 6));
    for (const double turns : {0.0, -1.0, 1.0}) {  // one that begins beside its limit may be a turn off
      VectorXd corrected = measured;
      corrected.segment(first, times) = whole.array() + turns * rounded;
      search.tryOut(corrected, said);
    }
  }
}

using Outputs = std::vector<Index>;

/// All outputs, and those of which a unit is usual.
std::vector<Outputs> listTogether(const ResponseLayout& layout, const std::string& unit) {
  Outputs all, usual;
  for (Index o = 0; o < layout.getOutputCount(); ++o) {
    all.push_back(o);
    if (layout.output_units[static_cast<std::size_t>(o)].find(unit) != std::string::npos) {
      usual.push_back(o);
    }
  }
  return usual.size() < 2 || usual.size() == all.size() ? std::vector<Outputs>{all}
                                                        : std::vector<Outputs>{all, usual};
}

/// What else may be wrong where all outputs are by a factor.
std::string describeExcitation(const UnitFactor& unit, const std::vector<std::string>& signals) {
  const bool large = unit.factor > 1.0;
  return signals.empty() ? ""
                         : fmt::format(
                               "; in a linear machine the recording does not tell that from {} being {:.4g} "
                               "times too {}: look which it is",
                               fmt::join(signals, " and "), large ? unit.factor : 1.0 / unit.factor,
                               large ? "small" : "large");
}

/// Several outputs by one factor.
void tryCommonUnit(const VectorXd& measured, const ResponseLayout& layout, const UnitFactor& unit,
                   const std::vector<std::string>& signals, double largest,
                   const MisfitOfResponse& calcMisfit, Search& search) {
  for (const Outputs& together : listTogether(layout, unit.unit)) {
    VectorXd corrected = measured;
    std::vector<std::string> names;
    for (const Index o : together) {
      corrected.segment(layout.getRow(o, 0), layout.times.size()) /= unit.factor;
      names.push_back(layout.output_names[static_cast<std::size_t>(o)]);
    }
    const bool all = static_cast<Index>(together.size()) == layout.getOutputCount();
    const std::string excitation = all ? describeExcitation(unit, signals) : "";
    if ((together.size() > 1 || !excitation.empty()) &&
        (unit.factor <= 1.0 || calcMisfit(corrected) < largest)) {
      const std::string& own = layout.output_units[static_cast<std::size_t>(together.front())];
      search.tryOut(corrected, describe(unit, names, own) + excitation);
    }
  }
}

void tryCommonUnits(const VectorXd& measured, const ResponseLayout& layout,
                    const std::vector<std::string>& signals, const MisfitOfResponse& calcMisfit,
                    Search& search) {
  const double largest = kClearlyLess * calcMisfit(VectorXd::Zero(measured.size()));
  for (const UnitFactor& unit : kFactors) {
    if (unit.factor > 0.0) {
      tryCommonUnit(measured, layout, unit, signals, largest, calcMisfit, search);
    }
  }
}

/// Factors between units. One that makes an output small explains it only where a zero does not do as well.
void tryUnits(const VectorXd& measured, const ResponseLayout& layout, Index output,
              const MisfitOfResponse& calcMisfit, Search& search) {
  const Index times = layout.times.size(), first = layout.getRow(output, 0);
  VectorXd silent = measured;
  silent.segment(first, times).setZero();
  const double largest = kClearlyLess * calcMisfit(silent);
  for (const UnitFactor& unit : kFactors) {
    VectorXd corrected = measured;
    corrected.segment(first, times) /= unit.factor;
    if (unit.factor <= 1.0 || calcMisfit(corrected) < largest) {
      search.tryOut(corrected, describe(unit, {layout.output_names[static_cast<std::size_t>(output)]},
                                        layout.output_units[static_cast<std::size_t>(output)]));
    }
  }
}

}  // namespace

std::string explainByFault(const VectorXd& measured, const ResponseLayout& layout, double chi_square,
                           Index residuals, const MisfitOfResponse& calcMisfit,
                           const std::vector<std::string>& signals) {
  if (!isGross(chi_square, static_cast<double>(residuals)) || layout.times.size() == 0) {
    return "";
  }
  Search search(kRestOfGross * chi_square, calcMisfit);
  const Index times = layout.times.size();
  if (layout.getOutputCount() > 1) {
    search.tryOut(-measured, "all outputs are of the other sign: turn their signs");
  }
  tryCommonUnits(measured, layout, signals, calcMisfit, search);
  for (Index output = 0; output < layout.getOutputCount(); ++output) {
    const std::string& name = layout.output_names[static_cast<std::size_t>(output)];
    const Index first = layout.getRow(output, 0);
    tryWrap(measured, layout, output, search);
    tryUnits(measured, layout, output, calcMisfit, search);
    trySpikes(measured, layout, output, search);
    tryStandstill(measured, layout, output, search);
    tryDrift(measured, layout, output, calcMisfit, search);
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
