#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <vector>

#include "framework/estimation/estimate.hpp"
#include "framework/experiment/model/model_spec.hpp"

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

struct FigureColumn {
  const char* name;
  double ParameterFigures::*value;
};

/// All of them by name, in the order of metrics.csv.
constexpr std::array<FigureColumn, 14> kFigureColumns{
    {{"bias_pct", &ParameterFigures::bias_pct},
     {"sd_pct", &ParameterFigures::sd_pct},
     {"mare_pct", &ParameterFigures::mare_pct},
     {"coverage95", &ParameterFigures::coverage95},
     {"coverage90", &ParameterFigures::coverage90},
     {"coverage50", &ParameterFigures::coverage50},
     {"stddev_pct", &ParameterFigures::stddev_pct},
     {"z_mean", &ParameterFigures::z_mean},
     {"z_sd", &ParameterFigures::z_sd},
     {"nlpd", &ParameterFigures::nlpd},
     {"crps_pct", &ParameterFigures::crps_pct},
     {"limit_pct", &ParameterFigures::limit_pct},
     {"ratio_to_limit", &ParameterFigures::ratio_to_limit},
     {"nats_above_limit", &ParameterFigures::nats_above_limit}}};

/// Whether a figure is known only where the information limit is.
constexpr bool needsLimit(const FigureColumn& column) {
  return column.value == &ParameterFigures::limit_pct || column.value == &ParameterFigures::ratio_to_limit ||
         column.value == &ParameterFigures::nats_above_limit;
}

struct ParameterMetrics : ParameterFigures {
  ParameterFigures se;  ///< Monte Carlo standard error of each figure, by the jackknife over the samples
  int samples = 0;      ///< behind the figures
};

/// Metrics of each parameter, in order. `truth` is p x n, n >= 2 (3 for standard errors). `limit_stddev` is
/// p x n, in the parameters' units, or empty where the limit is switched off; a NaN in a row makes the
/// parameter's limit NaN. `draws`: columns j + i n / draws are draws of one sample, which standard errors
/// leave out together. O(p n).
std::vector<ParameterMetrics> calcMetrics(const std::vector<ParameterSpec>& parameters,
                                          const Eigen::MatrixXd& truth, const Estimates& predictions,
                                          const Eigen::MatrixXd& limit_stddev = {}, int draws = 1);

}  // namespace twinmap
