#pragma once

#include <algorithm>

#include "framework/spec/excitation_spec.hpp"
#include "framework/spec/fields/fields.hpp"

namespace twinmap {

template <>
struct EnumNames<SweepKind> {
  static constexpr EnumName<SweepKind> values[] = {{"linear", SweepKind::kLinear},
                                                   {"logarithmic", SweepKind::kLogarithmic}};
};

template <>
struct EnumNames<TableInterpolation> {
  static constexpr EnumName<TableInterpolation> values[] = {{"linear", TableInterpolation::kLinear},
                                                            {"hold", TableInterpolation::kHold},
                                                            {"cubic", TableInterpolation::kCubic}};
};

template <class Fields>
void describe(Fields& f, PulseSpec& s) {
  f.required("amplitude", s.amplitude, "value for start <= t < end, 0 elsewhere");
  f.required("start", s.start, "s");
  f.required("end", s.end, "s");
}

template <class Fields>
void describe(Fields& f, SineSpec& s) {
  f.required("amplitude", s.amplitude, "amplitude * sin(2 pi frequency (t - start) + phase)");
  f.required("frequency", s.frequency, "Hz");
  f.optional("phase", s.phase, "rad");
  f.optional("start", s.start, "s; 0 before");
  f.optional("end", s.end, "s; 0 after; without it, to the end of the simulation");
}

template <class Fields>
void describe(Fields& f, ChirpSpec& s) {
  f.required("amplitude", s.amplitude, "of a sine with a sweeping frequency");
  f.required("start_frequency", s.start_frequency, "Hz, at start");
  f.required("end_frequency", s.end_frequency, "Hz, at end");
  f.optional("start", s.start, "s; 0 before");
  f.required("end", s.end, "s; 0 after");
  f.optional("sweep", s.sweep, "how the frequency grows");
}

template <class Fields>
void describe(Fields& f, MultisineSpec& s) {
  f.required("amplitude", s.amplitude, "of each sine");
  f.required("frequencies", s.frequencies, "Hz");
  f.optional("phases", s.phases, "rad; Schroeder's phases if absent", kNotEmpty);
  f.optional("start", s.start, "s; 0 before");
  f.optional("end", s.end, "s; 0 after; without it, to the end of the simulation");
  f.rule(!s.frequencies.empty(), "must list at least one of frequencies");
  f.rule(s.phases.empty() || s.phases.size() == s.frequencies.size(),
         "must give as many phases as frequencies, or none");
}

template <class Fields>
void describe(Fields& f, MeasuredSignalSpec& s) {
  f.required("file", s.file, "CSV, MATLAB or HDF5; relative to the experiment file");
  f.required("column", s.column, "the signal's column, such as V1 or 'force [kN]'");
  f.optional("time", s.time, "the column of times");
  f.optional("sample_rate", s.sample_rate, "instead of a column of times; Hz", kPositive);
  f.optional("start", s.start, "the time in the file that becomes t = 0 of the simulation; s");
  f.optional("duration", s.duration, "how much of it; default: to the end of the file; s", kPositive);
  f.rule(s.time.has_value() != s.sample_rate.has_value(), "must give exactly one of time, sample_rate");
}

template <class Fields>
void describe(Fields& f, TableSpec& s) {
  f.optional("measured", s.measured, "takes times and values from a file of measurements");
  f.optional("times", s.times, "s, strictly increasing");
  f.optional("values", s.values, "one for each time; the signal is 0 outside the table");
  f.optional("interpolation", s.interpolation, "between the times; cubic: a smooth spline");
  f.rule(s.times.size() >= 2 || (s.measured && s.times.empty()), "must give at least 2 times, or measured");
  f.rule(s.times.size() == s.values.size(), "must give as many values as times");
  f.rule(std::is_sorted(s.times.begin(), s.times.end(), std::less_equal<>()),
         "must give strictly increasing times");
}

template <class Fields>
void describe(Fields& f, SignalSpec& s) {
  f.optional("unit", s.unit, "unit of the signal");
  f.optional("pulses", s.pulses, "constant within an interval");
  f.optional("sines", s.sines, "single frequencies");
  f.optional("chirps", s.chirps, "sweeping frequencies");
  f.optional("multisines", s.multisines, "sums of sines");
  f.optional("tables", s.tables, "values at times, or a measured signal");
  f.rule(s.pulses.size() + s.sines.size() + s.chirps.size() + s.multisines.size() + s.tables.size() > 0,
         "must have at least one of pulses, sines, chirps, multisines, tables");
}

}  // namespace twinmap
