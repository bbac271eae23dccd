#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "framework/spec/expression/expression.hpp"

namespace twinmap {

/// Equidistant samples of outputs.
struct SamplesFeatureSpec {
  std::vector<Name> outputs;
  double start = 0.0;
  double interval = 0.0;
  int count = 0;
};

/// The equidistant samples, `count` of them, that a feature is computed from.
struct WindowSpec {
  double start = 0.0;     ///< s
  double interval = 0.0;  ///< s
  int count = 0;
};

/// Time of sample i = 0 .. count - 1: start + i * interval in whole picoseconds (s), so that 3 * 0.05 is 0.15
/// and a last sample at the end of the simulation is not beyond it.
template <class Samples>
double calcSampleTime(const Samples& samples, int i) {
  constexpr double kPicosecond = 1e12;
  return std::round((samples.start + i * samples.interval) * kPicosecond) / kPicosecond;
}

enum class Statistic { kMean, kStddev, kRms, kMin, kMax, kPeakToPeak };

/// Statistics of outputs over a window.
struct StatisticsFeatureSpec {
  std::vector<Name> outputs;
  WindowSpec window;
  std::vector<Statistic> quantities;
};

enum class ExtremaKind { kMaxima, kMinima, kBoth };

/// Value and time of the first peaks of an output within a window.
struct ExtremaFeatureSpec {
  Name output;
  WindowSpec window;
  ExtremaKind kind = ExtremaKind::kBoth;
  int peaks = 0;                     ///< of each kind
  std::optional<double> prominence;  ///< least, in the output's unit; default: 8 stddev of its noise
  int fit_samples = 5;               ///< of the parabola through a peak; odd
};

/// A frequency as written, above 0.
struct Frequency {
  double hertz = 0.0;
  SourceLocation where;
};

enum class WindowFunction { kRectangular, kHann };

/// How a complex number becomes features. The phase is given by its cosine and sine, which never jump.
enum class ComplexParts { kRealImaginary, kMagnitudePhase };

/// Lines of the discrete Fourier transform of outputs over a window, scaled so that a sine of amplitude A
/// on a line has magnitude A.
struct SpectrumFeatureSpec {
  std::vector<Name> outputs;
  WindowSpec window;
  std::vector<Frequency> frequencies;  ///< multiples of 1 / (count * interval), below half the sample rate
  WindowFunction window_function = WindowFunction::kRectangular;
  ComplexParts parts = ComplexParts::kRealImaginary;
};

/// Frequency response functions: lines of the outputs' spectrum over those of an excitation signal.
struct FrequencyResponseFeatureSpec {
  Name excitation;
  std::vector<Name> outputs;
  WindowSpec window;
  std::vector<Frequency> frequencies;  ///< as those of a spectrum
  ComplexParts parts = ComplexParts::kRealImaginary;
};

/// Natural frequencies and damping ratios of the lowest modes of the system linearised at its equilibrium.
struct ModesFeatureSpec {
  int count = 0;
  bool frequencies = true;
  bool damping_ratios = true;
};

/// One kind of feature; exactly one member is set.
struct FeatureSpec {
  std::optional<SamplesFeatureSpec> samples;
  std::optional<StatisticsFeatureSpec> statistics;
  std::optional<ExtremaFeatureSpec> extrema;
  std::optional<SpectrumFeatureSpec> spectrum;
  std::optional<FrequencyResponseFeatureSpec> frequency_response;
  std::optional<ModesFeatureSpec> modes;
};

/// Calls visit(kind) with the member of the feature that is set.
template <class Visitor>
void visitKind(const FeatureSpec& feature, const Visitor& visit) {
  const auto visitIfSet = [&visit](const auto& kind) {
    if (kind) {
      visit(*kind);
    }
  };
  visitIfSet(feature.samples);
  visitIfSet(feature.statistics);
  visitIfSet(feature.extrema);
  visitIfSet(feature.spectrum);
  visitIfSet(feature.frequency_response);
  visitIfSet(feature.modes);
}

/// The number of a frequency's line in a window, count * interval * frequency, rounded.
inline int calcLine(const WindowSpec& window, const Frequency& frequency) {
  return static_cast<int>(std::lround(frequency.hertz * window.interval * window.count));
}

/// How many of the lowest modes the features need; 0 for none.
int countModes(const std::vector<FeatureSpec>& features);

/// The outputs that the features are made of, as often as they are named.
std::vector<Name> collectOutputs(const std::vector<FeatureSpec>& features);

}  // namespace twinmap
