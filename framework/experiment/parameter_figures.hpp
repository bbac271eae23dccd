#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace twinmap {

/// How well one parameter is inferred over a set of samples. Relative errors are e = (inferred - true) /
/// true, or relative to upper - lower where the parameter says so; z = (inferred - true) / stddev. Where the
/// predictions are mixtures, coverage is of their smallest highest-density sets, and z the normal quantile of
/// the probability above the truth. Where intervals are not those of these distributions
/// (Estimates::interval_factors), coverage is theirs.
struct ParameterFigures {
  double bias_pct = 0.0;    ///< 100 mean(e)
  double sd_pct = 0.0;      ///< 100 sd(e), with 1/(n-1)
  double mare_pct = 0.0;    ///< 100 mean|e|
  double coverage95 = 0.0;  ///< fraction of samples with |z| below the normal 95 % quantile (two-sided)
  double coverage90 = 0.0;
  double coverage50 = 0.0;
  double stddev_pct = 0.0;  ///< 100 times the root mean square of stddev / |true|: the sd the map claims
  double z_mean = 0.0;
  double z_sd = 0.0;      ///< 1 where the claimed sd is calibrated
  double nlpd = 0.0;      ///< mean negative log predictive density, in the parameter's unit
  double crps_pct = 0.0;  ///< 100 times the mean of CRPS / |true|: mare_pct of a map that claims no spread
  /// 100 times the root mean square of limit_stddev / |true|: the sd that the data allow. NaN where the limit
  /// is not known.
  double limit_pct = std::numeric_limits<double>::quiet_NaN();
  double ratio_to_limit = std::numeric_limits<double>::quiet_NaN();  ///< sd_pct / limit_pct
  /// nlpd less that of normal distributions with the limit's standard deviations, mean(log(limit_stddev)) +
  /// log(2 pi e) / 2: what is lost by errors that are larger, and by standard deviations that do not tell
  /// them.
  double nats_above_limit = std::numeric_limits<double>::quiet_NaN();
};

/// How a printed table (Markdown, LaTeX, of a sweep) shows a figure; the report's and all files have them
/// all.
enum class InPrint { kOmitted, kValue, kWithError };

/// A figure as files, tables, the report and gates name and show it. Another one is a line here, and its
/// value in calcFigures.
struct FigureColumn {
  const char* name;     ///< of its column in files, and in gates; NAME_se: its standard error
  const char* heading;  ///< in tables
  double ParameterFigures::*value;
  int decimals = 4;  ///< in print, where there is no standard error
  InPrint in_print = InPrint::kOmitted;
  bool left_out = false;     ///< known of the training samples too: column loo_NAME
  bool needs_limit = false;  ///< known only where the information limit is
};

/// All of them, in the order of metrics.csv.
inline constexpr std::array<FigureColumn, 14> kFigureColumns{
    {{"bias_pct", "bias %", &ParameterFigures::bias_pct, 4, InPrint::kWithError},
     {"sd_pct", "sd %", &ParameterFigures::sd_pct, 4, InPrint::kWithError, true},
     {"mare_pct", "MARE %", &ParameterFigures::mare_pct, 4, InPrint::kValue},
     {"coverage95", "cov. 95 %", &ParameterFigures::coverage95, 3, InPrint::kWithError, true},
     {"coverage90", "cov. 90 %", &ParameterFigures::coverage90, 3},
     {"coverage50", "cov. 50 %", &ParameterFigures::coverage50, 3},
     {"stddev_pct", "claimed sd %", &ParameterFigures::stddev_pct},
     {"z_mean", "mean of z", &ParameterFigures::z_mean, 3},
     {"z_sd", "sd of z", &ParameterFigures::z_sd, 3},
     {"nlpd", "NLPD", &ParameterFigures::nlpd, 4, InPrint::kOmitted, true},
     {"crps_pct", "CRPS %", &ParameterFigures::crps_pct},
     {"limit_pct", "limit %", &ParameterFigures::limit_pct, 4, InPrint::kValue, false, true},
     {"ratio_to_limit", "ratio", &ParameterFigures::ratio_to_limit, 3, InPrint::kWithError, false, true},
     {"nats_above_limit", "nats above limit", &ParameterFigures::nats_above_limit, 4, InPrint::kOmitted,
      false, true}}};

/// The columns of metrics.csv that a gate may hold: the figures, those of left-out training samples, nlml and
/// test_samples.
inline std::vector<std::string> listGateMetrics() {
  std::vector<std::string> names, left_out;
  for (const FigureColumn& column : kFigureColumns) {
    names.emplace_back(column.name);
    if (column.left_out) {
      left_out.push_back("loo_" + names.back());
    }
  }
  names.insert(names.end(), left_out.begin(), left_out.end());
  names.insert(names.end(), {"nlml", "test_samples"});
  return names;
}

}  // namespace twinmap
