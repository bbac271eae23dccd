#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"
#include "framework/experiment/fields/one_of.hpp"

namespace twinmap {

/// How samples are made fewer.
enum class SampleReduction { kAutomatic, kNone };

template <>
struct EnumNames<SampleReduction> {
  static constexpr EnumName<SampleReduction> values[] = {{"automatic", SampleReduction::kAutomatic},
                                                         {"none", SampleReduction::kNone}};
};

/// Equidistant samples of outputs.
struct SamplesFeatureSpec {
  std::vector<Name> outputs;
  double start = 0.0;
  double interval = 0.0;
  int count = 0;
  std::optional<SampleReduction> reduce{};  ///< for a run; none: as its size asks for (reduceLongRecord)

  bool isReduced() const { return reduce == SampleReduction::kAutomatic; }
};

template <class Fields>
void describe(Fields& f, SamplesFeatureSpec& s) {
  f.required("outputs", s.outputs, "outputs to sample");
  f.required("start", s.start, "time of the first sample; s", kNonNegative);
  f.required("interval", s.interval, "time between samples; s", kSampleInterval);
  f.required("count", s.count, "samples of each output", kSampleCount);
  f.optional("reduce", s.reduce,
             "automatic: a run keeps what tells about the parameters; none: all (default: automatic for "
             "10000 samples and more)");
  f.rule(!s.outputs.empty(), "must name at least one of outputs");
}

/// The equidistant samples, `count` of them, that a feature is computed from.
struct WindowSpec {
  double start = 0.0;     ///< s
  double interval = 0.0;  ///< s
  int count = 0;
};

template <class Fields>
void describe(Fields& f, WindowSpec& s) {
  constexpr int kMin = 2;
  f.required("start", s.start, "time of the first sample; s", kNonNegative);
  f.required("interval", s.interval, "time between samples; s", kSampleInterval);
  f.required("count", s.count, "samples in the window", kSampleCount);
  f.rule(s.count >= kMin, "must have at least 2 samples");
}

/// Time of sample i = 0 .. count - 1: start + i * interval in whole picoseconds (s), so that 3 * 0.05 is 0.15
/// and a last sample at the end of the simulation is not beyond it. The product is added unrounded,
/// explicitly: times are looked up by their bits, and a compiler that may contract the two operations does so
/// in one unit and not in another.
template <class Samples>
double calcSampleTime(const Samples& samples, int i) {
  constexpr double kPicosecond = 1e12;
  return std::round(std::fma(i, samples.interval, samples.start) * kPicosecond) / kPicosecond;
}

enum class Statistic { kMean, kStddev, kRms, kMin, kMax, kPeakToPeak };

template <>
struct EnumNames<Statistic> {
  static constexpr EnumName<Statistic> values[] = {
      {"mean", Statistic::kMean}, {"stddev", Statistic::kStddev}, {"rms", Statistic::kRms},
      {"min", Statistic::kMin},   {"max", Statistic::kMax},       {"peak_to_peak", Statistic::kPeakToPeak},
  };
};

/// Statistics of outputs over a window.
struct StatisticsFeatureSpec {
  std::vector<Name> outputs;
  WindowSpec window;
  std::vector<Statistic> quantities;
};

template <class Fields>
void describe(Fields& f, StatisticsFeatureSpec& s) {
  f.required("outputs", s.outputs, "outputs of which statistics are taken");
  f.required("window", s.window, "the samples they are taken over");
  f.required("quantities", s.quantities, "of mean, stddev, rms, min, max, peak_to_peak");
  f.rule(!s.outputs.empty(), "must name at least one of outputs");
  f.rule(!s.quantities.empty(), "must name at least one of quantities");
}

enum class ExtremaKind { kMaxima, kMinima, kBoth };

template <>
struct EnumNames<ExtremaKind> {
  static constexpr EnumName<ExtremaKind> values[] = {
      {"maxima", ExtremaKind::kMaxima}, {"minima", ExtremaKind::kMinima}, {"both", ExtremaKind::kBoth}};
};

/// Value and time of the first peaks of an output within a window.
struct ExtremaFeatureSpec {
  Name output;
  WindowSpec window;
  ExtremaKind kind = ExtremaKind::kBoth;
  int peaks = 0;                     ///< of each kind
  std::optional<double> prominence;  ///< least, in the output's unit; default: 8 stddev of its noise
  int fit_samples = 5;               ///< of the parabola through a peak; odd
};

template <class Fields>
void describe(Fields& f, ExtremaFeatureSpec& s) {
  constexpr int kMin = 3;
  f.required("output", s.output, "output whose peaks are taken");
  f.required("window", s.window, "the samples in which they are looked for");
  f.optional("kind", s.kind, "maxima, minima, or first the maxima and then the minima");
  f.required("peaks", s.peaks, "how many of each kind, from the first in time", kCount);
  f.optional("prominence", s.prominence,
             "least height above the surroundings, in the output's unit (default: 8 stddev of its noise)",
             kNonNegative);
  f.optional("fit_samples", s.fit_samples, "of the parabola through each peak; odd", kCount);
  f.rule(s.fit_samples >= kMin && s.fit_samples % 2 == 1, "must give odd fit_samples, 3 or more");
  f.rule(s.peaks <= s.window.count, "must not ask for more peaks than the window has samples");
  f.rule(s.window.count >= s.fit_samples, "must give a window with at least fit_samples samples");
}

/// A frequency as written, above 0.
struct Frequency {
  double hertz = 0.0;
  SourceLocation where;
};

template <class Fields>
void describe(Fields& f, Frequency& s) {
  f.location(s.where);
  f.value(s.hertz, kPositive);
}

enum class WindowFunction { kRectangular, kHann };

template <>
struct EnumNames<WindowFunction> {
  static constexpr EnumName<WindowFunction> values[] = {{"rectangular", WindowFunction::kRectangular},
                                                        {"hann", WindowFunction::kHann}};
};

/// How a complex number becomes features. The phase is given by its cosine and sine, which never jump.
enum class ComplexParts { kRealImaginary, kMagnitudePhase };

template <>
struct EnumNames<ComplexParts> {
  static constexpr EnumName<ComplexParts> values[] = {{"real_imaginary", ComplexParts::kRealImaginary},
                                                      {"magnitude_phase", ComplexParts::kMagnitudePhase}};
};

/// Lines of the discrete Fourier transform of outputs over a window, scaled so that a sine of amplitude A
/// on a line has magnitude A.
struct SpectrumFeatureSpec {
  std::vector<Name> outputs;
  WindowSpec window;
  std::vector<Frequency> frequencies;  ///< multiples of 1 / (count * interval), below half the sample rate
  WindowFunction window_function = WindowFunction::kRectangular;
  ComplexParts parts = ComplexParts::kRealImaginary;
};

template <class Fields>
void describe(Fields& f, SpectrumFeatureSpec& s) {
  f.required("outputs", s.outputs, "outputs to transform");
  f.required("window", s.window, "the samples to transform");
  f.required("frequencies", s.frequencies, "multiples of 1 / (count * interval) of the window; Hz");
  f.optional("window_function", s.window_function, "what the samples are multiplied by");
  f.optional("parts", s.parts, "real and imaginary part, or magnitude with cosine and sine of the phase");
  f.rule(!s.outputs.empty(), "must name at least one of outputs");
  f.rule(!s.frequencies.empty(), "must list at least one of frequencies");
}

/// Frequency response functions: lines of the outputs' spectrum over those of an excitation signal.
struct FrequencyResponseFeatureSpec {
  Name excitation;
  std::vector<Name> outputs;
  WindowSpec window;
  std::vector<Frequency> frequencies;  ///< as those of a spectrum
  ComplexParts parts = ComplexParts::kRealImaginary;
};

template <class Fields>
void describe(Fields& f, FrequencyResponseFeatureSpec& s) {
  f.required("excitation", s.excitation, "signal that the outputs respond to; known without noise");
  f.required("outputs", s.outputs, "outputs to transform");
  f.required("window", s.window, "whole periods of a periodic excitation, in steady state");
  f.required("frequencies", s.frequencies, "multiples of 1 / (count * interval) of the window; Hz");
  f.optional("parts", s.parts, "real and imaginary part, or magnitude with cosine and sine of the phase");
  f.rule(!s.outputs.empty(), "must name at least one of outputs");
  f.rule(!s.frequencies.empty(), "must list at least one of frequencies");
}

/// Natural frequencies and damping ratios of the lowest modes of the system linearised at its equilibrium.
struct ModesFeatureSpec {
  int count = 0;
  bool frequencies = true;
  bool damping_ratios = true;
};

template <class Fields>
void describe(Fields& f, ModesFeatureSpec& s) {
  f.required("count", s.count, "how many modes, from the lowest", kThousand);
  f.optional("frequencies", s.frequencies, "natural frequencies |lambda| / (2 pi); Hz");
  f.optional("damping_ratios", s.damping_ratios, "-Re(lambda) / |lambda|");
  f.rule(s.frequencies || s.damping_ratios, "must have frequencies or damping_ratios");
}

/// One kind of feature.
using FeatureSpec = std::variant<SamplesFeatureSpec, StatisticsFeatureSpec, ExtremaFeatureSpec,
                                 SpectrumFeatureSpec, FrequencyResponseFeatureSpec, ModesFeatureSpec>;

template <class Fields>
void describe(Fields& f, FeatureSpec& s) {
  f.oneOf("must give one kind of feature:",
          choice<SamplesFeatureSpec>("samples", s, "equidistant samples of outputs"),
          choice<StatisticsFeatureSpec>("statistics", s,
                                        "mean, stddev, rms, min, max, peak_to_peak over a window"),
          choice<ExtremaFeatureSpec>("extrema", s, "value and time of the first peaks"),
          choice<SpectrumFeatureSpec>("spectrum", s, "lines of the discrete Fourier transform"),
          choice<FrequencyResponseFeatureSpec>("frequency_response", s,
                                               "outputs over an excitation at chosen frequencies"),
          choice<ModesFeatureSpec>("modes", s, "natural frequencies and damping ratios at the equilibrium"));
}

/// The number of a frequency's line in a window, count * interval * frequency, rounded.
inline int calcLine(const WindowSpec& window, const Frequency& frequency) {
  return static_cast<int>(std::lround(frequency.hertz * window.interval * window.count));
}

/// The outputs that a feature is made of; none for modes.
std::vector<Name> getOutputs(const FeatureSpec& feature);

/// The samples that a feature is computed from; none for modes.
WindowSpec getWindow(const FeatureSpec& feature);

/// Appends the times (s) of a window's samples.
void appendSampleTimes(const WindowSpec& window, std::vector<double>& times);

/// Sorts times and keeps each once.
void sortUnique(std::vector<double>& times);

/// How many of the lowest modes the features need; 0 for none.
int countModes(const std::vector<FeatureSpec>& features);

/// The outputs that the features are made of, as often as they are named.
std::vector<Name> collectOutputs(const std::vector<FeatureSpec>& features);

/// The times (s) at which the features need an output: sorted, each once.
std::vector<double> collectTimesOf(const std::string& output, const std::vector<FeatureSpec>& features);

}  // namespace twinmap
