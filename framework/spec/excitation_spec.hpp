#pragma once

#include <optional>
#include <vector>

#include "framework/spec/expression/expression.hpp"

namespace twinmap {

/// `amplitude` for start <= t < end, 0 elsewhere.
struct PulseSpec {
  Expression amplitude, start, end;
};

/// amplitude * sin(2 pi frequency t' + phase) with t' = t - start, for start <= t < end, 0 elsewhere.
struct SineSpec {
  Expression amplitude, frequency, phase, start;
  Expression end{"", {}};
};

enum class SweepKind { kLinear, kLogarithmic };

/// A sine whose frequency sweeps from start_frequency at `start` to end_frequency at `end`, 0 elsewhere.
struct ChirpSpec {
  Expression amplitude, start_frequency, end_frequency, start, end;
  SweepKind sweep = SweepKind::kLinear;
};

/// Sum over k of amplitude * sin(2 pi frequencies[k] t' + phases[k]); without phases, Schroeder's
/// phi_k = -pi k (k - 1) / N, k = 1..N (low crest factor).
struct MultisineSpec {
  Expression amplitude;
  std::vector<Expression> frequencies, phases;
  Expression start;
  Expression end{"", {}};
};

/// kCubic: the spline with continuous second derivative, not-a-knot at both ends.
enum class TableInterpolation { kLinear, kHold, kCubic };

/// A signal in a file of measurements; exactly one of `time` and `sample_rate` is given.
struct MeasuredSignalSpec {
  Name file;                          ///< relative to the experiment file
  Name column;                        ///< "V1", "force [kN]"
  std::optional<Name> time;           ///< the column of times, s
  std::optional<double> sample_rate;  ///< Hz
  double start = 0.0;                 ///< s; the time in the file that becomes t = 0 of the simulation
  std::optional<double> duration;     ///< s, of the excerpt; default: to the end of the file
};

/// A table; 0 before the first and after the last time (hold: the last value ends there).
struct TableSpec {
  std::vector<double> times, values;  ///< empty until what was measured is read
  TableInterpolation interpolation = TableInterpolation::kLinear;
  std::optional<MeasuredSignalSpec> measured{};  ///< where times and values come from
};

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
};

}  // namespace twinmap
