#pragma once

#include "framework/spec/feature_spec.hpp"
#include "framework/spec/fields/fields.hpp"

namespace twinmap {

template <>
struct EnumNames<Statistic> {
  static constexpr EnumName<Statistic> values[] = {
      {"mean", Statistic::kMean}, {"stddev", Statistic::kStddev}, {"rms", Statistic::kRms},
      {"min", Statistic::kMin},   {"max", Statistic::kMax},       {"peak_to_peak", Statistic::kPeakToPeak},
  };
};

template <>
struct EnumNames<ExtremaKind> {
  static constexpr EnumName<ExtremaKind> values[] = {
      {"maxima", ExtremaKind::kMaxima}, {"minima", ExtremaKind::kMinima}, {"both", ExtremaKind::kBoth}};
};

template <>
struct EnumNames<WindowFunction> {
  static constexpr EnumName<WindowFunction> values[] = {{"rectangular", WindowFunction::kRectangular},
                                                        {"hann", WindowFunction::kHann}};
};

template <>
struct EnumNames<ComplexParts> {
  static constexpr EnumName<ComplexParts> values[] = {{"real_imaginary", ComplexParts::kRealImaginary},
                                                      {"magnitude_phase", ComplexParts::kMagnitudePhase}};
};

template <class Fields>
void describe(Fields& f, SamplesFeatureSpec& s) {
  f.required("outputs", s.outputs, "outputs to sample");
  f.required("start", s.start, "time of the first sample; s", kNonNegative);
  f.required("interval", s.interval, "time between samples; s", kSampleInterval);
  f.required("count", s.count, "samples of each output", kSampleCount);
  f.rule(!s.outputs.empty(), "must name at least one of outputs");
}

template <class Fields>
void describe(Fields& f, WindowSpec& s) {
  constexpr int kFewest = 2;
  f.required("start", s.start, "time of the first sample; s", kNonNegative);
  f.required("interval", s.interval, "time between samples; s", kSampleInterval);
  f.required("count", s.count, "samples in the window", kSampleCount);
  f.rule(s.count >= kFewest, "must have at least 2 samples");
}

template <class Fields>
void describe(Fields& f, StatisticsFeatureSpec& s) {
  f.required("outputs", s.outputs, "outputs of which statistics are taken");
  f.required("window", s.window, "the samples they are taken over");
  f.required("quantities", s.quantities, "of mean, stddev, rms, min, max, peak_to_peak");
  f.rule(!s.outputs.empty(), "must name at least one of outputs");
  f.rule(!s.quantities.empty(), "must name at least one of quantities");
}

template <class Fields>
void describe(Fields& f, ExtremaFeatureSpec& s) {
  constexpr int kFewest = 3;
  f.required("output", s.output, "output whose peaks are taken");
  f.required("window", s.window, "the samples in which they are looked for");
  f.optional("kind", s.kind, "maxima, minima, or first the maxima and then the minima");
  f.required("peaks", s.peaks, "how many of each kind, from the first in time", kCount);
  f.optional("prominence", s.prominence,
             "least height above the surroundings, in the output's unit (default: 8 stddev of its noise)",
             kNonNegative);
  f.optional("fit_samples", s.fit_samples, "of the parabola through each peak; odd", kCount);
  f.rule(s.fit_samples >= kFewest && s.fit_samples % 2 == 1, "must give odd fit_samples, 3 or more");
  f.rule(s.peaks <= s.window.count, "must not ask for more peaks than the window has samples");
  f.rule(s.window.count >= s.fit_samples, "must give a window with at least fit_samples samples");
}

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

template <class Fields>
void describe(Fields& f, ModesFeatureSpec& s) {
  f.required("count", s.count, "how many modes, from the lowest", kThousand);
  f.optional("frequencies", s.frequencies, "natural frequencies |lambda| / (2 pi); Hz");
  f.optional("damping_ratios", s.damping_ratios, "-Re(lambda) / |lambda|");
  f.rule(s.frequencies || s.damping_ratios, "must have frequencies or damping_ratios");
}

template <class Fields>
void describe(Fields& f, FeatureSpec& s) {
  f.optional("samples", s.samples, "equidistant samples of outputs");
  f.optional("statistics", s.statistics, "mean, stddev, rms, min, max, peak_to_peak over a window");
  f.optional("extrema", s.extrema, "value and time of the first peaks");
  f.optional("spectrum", s.spectrum, "lines of the discrete Fourier transform");
  f.optional("frequency_response", s.frequency_response, "outputs over an excitation at chosen frequencies");
  f.optional("modes", s.modes, "natural frequencies and damping ratios at the equilibrium");
  const int given = s.samples.has_value() + s.statistics.has_value() + s.extrema.has_value() +
                    s.spectrum.has_value() + s.frequency_response.has_value() + s.modes.has_value();
  f.rule(given == 1,
         "must give one kind of feature: samples, statistics, extrema, spectrum, frequency_response, "
         "modes");
}

}  // namespace twinmap
