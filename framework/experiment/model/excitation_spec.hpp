#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"
#include "framework/experiment/fields/one_of.hpp"

namespace twinmap {

/// `amplitude` for start <= t < end, 0 elsewhere.
struct PulseSpec {
  Expression amplitude, start, end;
};

template <class Fields>
void describe(Fields& f, PulseSpec& s) {
  f.required("amplitude", s.amplitude, "value for start <= t < end, 0 elsewhere", kOwnUnit);
  f.required("start", s.start, "", Unit{"s"});
  f.required("end", s.end, "", Unit{"s"});
}

/// amplitude * sin(2 pi frequency t' + phase) with t' = t - start, for start <= t < end, 0 elsewhere.
struct SineSpec {
  Expression amplitude, frequency, phase, start;
  Expression end{"", {}};
};

template <class Fields>
void describe(Fields& f, SineSpec& s) {
  f.required("amplitude", s.amplitude, "amplitude * sin(2 pi frequency (t - start) + phase)", kOwnUnit);
  f.required("frequency", s.frequency, "", Unit{"Hz"});
  f.optional("phase", s.phase, "", Unit{"rad"});
  f.optional("start", s.start, "0 before", Unit{"s"});
  f.optional("end", s.end, "0 after; without it, to the end of the simulation", Unit{"s"});
}

enum class SweepKind { kLinear, kLogarithmic };

template <>
struct EnumNames<SweepKind> {
  static constexpr EnumName<SweepKind> values[] = {{"linear", SweepKind::kLinear},
                                                   {"logarithmic", SweepKind::kLogarithmic}};
};

/// A sine whose frequency sweeps from start_frequency at `start` to end_frequency at `end`, 0 elsewhere.
struct ChirpSpec {
  Expression amplitude, start_frequency, end_frequency, start, end;
  SweepKind sweep = SweepKind::kLinear;
};

template <class Fields>
void describe(Fields& f, ChirpSpec& s) {
  f.required("amplitude", s.amplitude, "of a sine with a sweeping frequency", kOwnUnit);
  f.required("start_frequency", s.start_frequency, "at start", Unit{"Hz"});
  f.required("end_frequency", s.end_frequency, "at end", Unit{"Hz"});
  f.optional("start", s.start, "0 before", Unit{"s"});
  f.required("end", s.end, "0 after", Unit{"s"});
  f.optional("sweep", s.sweep, "how the frequency grows");
}

/// Sum over k of a_k * sin(2 pi frequencies[k] t' + phases[k]), a_k one amplitude for all or each its own;
/// without phases, Schroeder's phi_k = -pi k (k - 1) / N, k = 1..N (low crest factor).
struct MultisineSpec {
  Expression amplitude{"", {}};
  std::vector<Expression> amplitudes, frequencies, phases;  ///< amplitudes: empty where `amplitude` is given
  Expression start;
  Expression end{"", {}};
};

template <class Fields>
void describe(Fields& f, MultisineSpec& s) {
  f.oneOf("must give exactly one of", choice("amplitude", s.amplitude, "the same of each sine", kOwnUnit),
          choice("amplitudes", s.amplitudes, "one for each of frequencies", kOwnUnit));
  f.required("frequencies", s.frequencies, "", Unit{"Hz"});
  f.optional("phases", s.phases, "Schroeder's phases if absent", kNotEmpty, Unit{"rad"});
  f.optional("start", s.start, "0 before", Unit{"s"});
  f.optional("end", s.end, "0 after; without it, to the end of the simulation", Unit{"s"});
  f.rule(!s.frequencies.empty(), "must list at least one of frequencies");
  f.rule(s.phases.empty() || s.phases.size() == s.frequencies.size(),
         "must give as many phases as frequencies, or none");
  f.rule(s.amplitudes.empty() || s.amplitudes.size() == s.frequencies.size(),
         "must give as many amplitudes as frequencies");
}

/// kCubic: the spline with continuous second derivative, not-a-knot at both ends.
enum class TableInterpolation { kLinear, kHold, kCubic };

template <>
struct EnumNames<TableInterpolation> {
  static constexpr EnumName<TableInterpolation> values[] = {{"linear", TableInterpolation::kLinear},
                                                            {"hold", TableInterpolation::kHold},
                                                            {"cubic", TableInterpolation::kCubic}};
};

/// A signal in a file of measurements; exactly one of `time` and `sample_rate` is given.
struct MeasuredSignalSpec {
  Name file;                          ///< relative to the experiment file
  Name column;                        ///< "V1", "force [kN]"
  std::optional<Name> time;           ///< the column of times, s
  std::optional<double> sample_rate;  ///< Hz
  double start = 0.0;                 ///< s; the time in the file that becomes t = 0 of the simulation
  std::optional<double> duration;     ///< s, of the excerpt; default: to the end of the file
  Expression delay{};                 ///< s, of the recorder's clock: file time = start + t + delay
  std::optional<double> max_gap{};    ///< s; gaps up to this are bridged, whatever is known of what they hide
  double noise = 0.0;  ///< standard deviation of each sample's white noise, in the signal's unit
};

template <class Fields>
void describe(Fields& f, MeasuredSignalSpec& s) {
  f.required("file", s.file, "CSV, MATLAB or HDF5; relative to the experiment file");
  f.required("column", s.column, "the signal's column, such as V1 or 'force [kN]'");
  f.oneOf("must give exactly one of", choice("time", s.time, "the column of times"),
          choice("sample_rate", s.sample_rate, "instead of a column of times; Hz", kPositive));
  f.optional("start", s.start, "the time in the file that becomes t = 0 of the simulation; s");
  f.optional("duration", s.duration, "how much of it; default: to the end of the file; s", kPositive);
  f.optional("delay", s.delay,
             "by which the file's clock is late: its time is start + t + delay; perhaps a nuisance",
             Unit{"s"});
  f.optional("max_gap", s.max_gap,
             "gaps up to this are interpolated; default: those of which the signal tells what they hide; s",
             kPositive);
  f.optional("noise", s.noise,
             "standard deviation of the white noise of its samples, in the signal's unit; infer counts it",
             kNonNegative);
}

/// Something of a table that is not known: what one standard deviation of it changes.
struct TableUnknown {
  std::size_t first = 0;  ///< value
  std::vector<double> changes;
};

/// A table; 0 before the first and after the last time (hold: the last value ends there).
struct TableSpec {
  std::vector<double> times, values;  ///< empty until what was measured is read
  TableInterpolation interpolation = TableInterpolation::kLinear;
  std::optional<MeasuredSignalSpec> measured{};  ///< where times and values come from
  std::vector<TableUnknown> unknown{};           ///< independent of each other; of values that were lost
  std::string bridged{};                         ///< what was lost of the measured, a phrase; "": nothing

  /// Of the recorder's clock, s; nullptr where there is none.
  const Expression* findDelay() const {
    return measured && measured->delay.text != Expression{}.text ? &measured->delay : nullptr;
  }
};

inline bool isStrictlyIncreasing(const std::vector<double>& values) {
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i - 1] >= values[i]) {
      return false;
    }
  }
  return true;
}

template <class Fields>
void describe(Fields& f, TableSpec& s) {
  f.optional("measured", s.measured, "takes times and values from a file of measurements");
  f.optional("times", s.times, "s, strictly increasing");
  f.optional("values", s.values, "one for each time; the signal is 0 outside the table");
  f.optional("interpolation", s.interpolation, "between the times; cubic: a smooth spline");
  f.rule(s.times.size() >= 2 || (s.measured && s.times.empty()), "must give at least 2 times, or measured");
  f.rule(s.times.size() == s.values.size(), "must give as many values as times");
  f.rule(isStrictlyIncreasing(s.times), "must give strictly increasing times");
}

/// A named excitation signal: the sum of its terms. Frequencies in Hz, phases in rad, times in s.
/// Terms without `end` go on to the end of the simulation (an empty Expression text).
struct SignalSpec {
  Name name;
  std::string unit;
  std::vector<PulseSpec> pulses;
  std::vector<SineSpec> sines;
  std::vector<ChirpSpec> chirps;
  std::vector<MultisineSpec> multisines;
  std::vector<TableSpec> tables;
  std::optional<Name> variable{};  ///< an input of a model from elsewhere; default: the name

  // compiled once (experiment_spec.cpp)
  SignalSpec();
  SignalSpec(const SignalSpec&);
  SignalSpec(SignalSpec&&) noexcept;
  SignalSpec& operator=(const SignalSpec&);
  SignalSpec& operator=(SignalSpec&&) noexcept;
  ~SignalSpec();
};

template <class Fields>
void describe(Fields& f, SignalSpec& s) {
  f.optional("unit", s.unit, "unit of the signal");
  f.optional("variable", s.variable, "the input of the FMU or program that it drives; default: its own name");
  f.optional("pulses", s.pulses, "constant within an interval");
  f.optional("sines", s.sines, "single frequencies");
  f.optional("chirps", s.chirps, "sweeping frequencies");
  f.optional("multisines", s.multisines, "sums of sines");
  f.optional("tables", s.tables, "values at times, or a measured signal");
  f.rule(s.pulses.size() + s.sines.size() + s.chirps.size() + s.multisines.size() + s.tables.size() > 0,
         "must have at least one of pulses, sines, chirps, multisines, tables");
}

}  // namespace twinmap
