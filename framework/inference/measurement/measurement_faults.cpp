#include "framework/inference/measurement/measurement_faults.hpp"

#include <fmt/core.h>

#include <limits>

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

struct UnitFactor {
  double factor;
  const char* said;
};

constexpr UnitFactor kFactors[] = {
    {1000.0, "1000 times too large, as mm in the place of m: divide it by 1000"},
    {1e-3, "1000 times too small: multiply it by 1000"},
    {57.29577951308232, "57.3 times too large, as deg in the place of rad: divide it by 57.3"},
    {1.0 / 57.29577951308232, "57.3 times too small, as rad in the place of deg: multiply it by 57.3"},
    {9.81, "9.81 times too large, as m/s2 in the place of g: divide it by 9.81"},
    {1.0 / 9.81, "9.81 times too small, as g in the place of m/s2: multiply it by 9.81"},
    {-1.0, "of the other sign: turn its sign"}};

/// The measurement without an offset of one output.
VectorXd subtract(VectorXd measured, Index first, Index times, double offset) {
  measured.segment(first, times).array() -= offset;
  return measured;
}

/// The offset that leaves the least misfit, by parabolas through three of them: chi-square is quadratic in it
/// where the features are linear, and nearly so elsewhere.
double findOffset(const VectorXd& measured, Index first, Index times, const MisfitOfResponse& calcMisfit) {
  constexpr int kParabolas = 3;
  const auto values = measured.segment(first, times).array();
  double offset = 0.0, step = (values - values.mean()).abs().maxCoeff();
  for (int i = 0; i < kParabolas && step > 0.0; ++i) {
    const double below = calcMisfit(subtract(measured, first, times, offset - step));
    const double at = calcMisfit(subtract(measured, first, times, offset));
    const double above = calcMisfit(subtract(measured, first, times, offset + step));
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

  void tryOut(const VectorXd& corrected, const std::string& said) {
    const double chi_square = calcMisfit_(corrected);
    if (chi_square < least_) {
      least_ = chi_square;
      said_ = said;
    }
  }
  const std::string& getSaid() const { return said_; }

 private:
  double least_;
  const MisfitOfResponse& calcMisfit_;
  std::string said_;
};

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
  for (Index output = 0; output < layout.getOutputCount(); ++output) {
    const std::string& name = layout.output_names[static_cast<std::size_t>(output)];
    const Index first = layout.getRow(output, 0);
    for (const auto& [factor, said] : kFactors) {
      VectorXd corrected = measured;
      corrected.segment(first, times) /= factor;
      search.tryOut(corrected, name + " is " + said);
    }
    const double offset = findOffset(measured, first, times, calcMisfit);
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
