#pragma once

#include <optional>
#include <vector>

#include "framework/experiment/expression/expression.hpp"
#include "framework/experiment/fields/fields.hpp"
#include "framework/experiment/fields/one_of.hpp"

namespace twinmap {

/// The size of an output's noise, in the output's unit: a number, or unknown.
struct NoiseStddev {
  NoiseStddev(double given = 0.0) : value(given) {}  // NOLINT(google-explicit-constructor)
  operator double() const { return value; }          // NOLINT(google-explicit-constructor)

  double value;          ///< 1 where it is unknown: a unit in which residuals are counted
  bool unknown = false;  ///< inferred with the parameters, and integrated out
  SourceLocation where{};
};

struct OutputNoiseSpec {
  Name name;  ///< an output
  NoiseStddev stddev;
};

template <class Fields>
void describe(Fields& f, OutputNoiseSpec& s) {
  f.value(s.stddev, kNonNegative);
}

/// Correlation of an output's noise e_k over its samples; one of the two lists is given.
struct NoiseCorrelationSpec {
  Name name;                           ///< an output
  std::vector<double> autoregression;  ///< a_i of e_k = a_1 e_{k-1} + a_2 e_{k-2} + ... + w_k
  std::vector<double> values;          ///< autocorrelation at lags 0, 1, 2 ...; 0 beyond
  std::optional<double> sample_time;   ///< s, of a lag; default: the spacing of the output's feature times
};

template <class Fields>
void describe(Fields& f, NoiseCorrelationSpec& s) {
  f.oneOf("must give exactly one of",
          choice("autoregression", s.autoregression,
                 "a_i of e_k = a_1 e_{k-1} + a_2 e_{k-2} + ... + white noise"),
          choice("values", s.values, "autocorrelation at lags 0, 1, 2 ...: [1, r_1, r_2, ...]; 0 beyond"));
  f.optional("sample_time", s.sample_time, "of a lag; default: spacing of the output's feature times; s",
             kPositive);
  f.rule(s.values.empty() || s.values.front() == 1.0, "must give values that begin with 1");
}

/// Noise of the modes' natural frequencies and damping ratios, as identified from a measurement.
struct ModesNoiseSpec {
  double frequency = 0.0;      ///< standard deviation, Hz
  double damping_ratio = 0.0;  ///< standard deviation
};

template <class Fields>
void describe(Fields& f, ModesNoiseSpec& s) {
  f.required("frequency", s.frequency, "standard deviation of every natural frequency; Hz", kNonNegative);
  f.required("damping_ratio", s.damping_ratio, "standard deviation of every damping ratio", kNonNegative);
}

/// An output whose readings are rounded to multiples of `quantum`, in its unit.
struct RoundedOutput {
  std::string name;
  double quantum;
};

/// Normal noise on every sample of every output, independent unless correlated, in training and test alike.
struct NoiseSpec {
  double scale = 1.0;             ///< multiplies every stddev
  std::optional<int> replicates;  ///< noise draws per training simulation; default 4, fewer for many samples
  std::vector<OutputNoiseSpec> stddev;
  std::optional<ModesNoiseSpec> modes;
  std::vector<NoiseCorrelationSpec> correlation{};  ///< of the outputs whose noise is not white
  std::vector<RoundedOutput> rounded{};             ///< by their sensors (resolveDefaults)
};

template <class Fields>
void describe(Fields& f, NoiseSpec& s) {
  f.optional("scale", s.scale, "multiplies every stddev", kNonNegative);
  f.optional("replicates", s.replicates,
             "noise draws per training simulation (default: 4, fewer for more than 750 samples)", kThousand);
  f.optionalMap("stddev", s.stddev,
                "standard deviation of each output's noise, in the output's unit; unknown: inferred");
  f.optionalMap("correlation", s.correlation, "of outputs whose noise is not white");
  f.optional("modes", s.modes, "of natural frequencies and damping ratios, where modes are features");
}

}  // namespace twinmap
