#include "framework/export/tracking/track_source.hpp"

#include <fmt/core.h>

#include <cmath>

#include "framework/estimation/estimate.hpp"
#include "framework/export/c_code/runtime_sources.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "kernels/tracking/change_bank.hpp"
#include "kernels/tracking/rate_bank.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Rotations bring even matrices of 16 rows to their eigenvalues in fewer sweeps (they converge
/// quadratically).
constexpr int kSweeps = 12;

std::vector<Index> listUnknown(const tracking::Model& model) {
  std::vector<Index> unknown;
  for (Index j = 0; j < model.countParameters(); ++j) {
    if (std::isnan(model.drifts[static_cast<std::size_t>(j)].rate)) {
      unknown.push_back(j);
    }
  }
  return unknown;
}

/// The squares of the ratios that a posterior has weights for.
VectorXd listSquares() {
  tracking::RatePosterior posterior = tracking::calcRatePosterior({0, {}, tracking::makeLogRatePrior()});
  VectorXd squares(posterior.octaves.size());
  for (Index i = 0; i < squares.size(); ++i) {
    posterior.weights = VectorXd::Unit(squares.size(), i);
    squares[i] = posterior.calcMeanSquare();
  }
  return squares;
}

void addSpace(const ExportedModel& model, const ExportedTracking& tracking, CTables& tables) {
  const Index p = tracking.space.count();
  VectorXd center(p), half_width(p), middle_unit(p);
  std::vector<int> is_logarithm;
  for (Index j = 0; j < p; ++j) {
    const ParameterSpec& parameter = model.experiment.model.parameters[static_cast<std::size_t>(j)];
    const double middle = 0.5 * (parameter.bounds.lower + parameter.bounds.upper);
    const bool is_log = parameter.prior && parameter.prior->isOfLogarithm();
    const double at_center = tracking.space.toValue(j, 0.0);
    is_logarithm.push_back(is_log ? 1 : 0);
    center[j] = is_log ? std::log(at_center) : at_center;
    half_width[j] = 1.0 / tracking.space.calcSlope(j, is_log ? 1.0 : middle);
    middle_unit[j] = 1.0 / tracking.space.calcSlope(j, middle);
  }
  tables.addInts("is_logarithm", is_logarithm, "1: the parameter is tracked by its logarithm.");
  tables.addWide("center", center, "Of the bounds.");
  tables.addWide("half_width", half_width, "Of the bounds: the unit of the belief.");
  tables.addWide("middle_unit", middle_unit, "That unit in the middle of the bounds, in the parameter's.");
}

void addPrior(const ExportedTracking& tracking, CTables& tables) {
  std::vector<int> is_uniform(static_cast<std::size_t>(tracking.space.count()), 0);
  for (const Index j : tracking.prior.uniform) {
    is_uniform[static_cast<std::size_t>(j)] = 1;
  }
  tables.addInts("is_uniform", is_uniform, "1: the prior is uniform within the bounds.");
  const MatrixXd lower = linalg::calcCholesky(tracking.prior.belief.covariance).lower;
  tables.addWide("prior_mean", tracking.prior.belief.mean, "What is known before the first measurement.");
  tables.addWide("prior_covariance", flattenRows(tracking.prior.belief.covariance),
                 "Its covariance, row by row.");
  tables.addWide("prior_lower", flattenRows(lower), "Its root L.");
  tables.addWide("prior_inverse",
                 flattenRows(linalg::solveLower(lower, MatrixXd::Identity(lower.rows(), lower.rows()))),
                 "The inverse of L.");
}

void addDrifts(const tracking::Model& model, CTables& tables) {
  const Index p = model.countParameters();
  VectorXd rates(p), stddevs(p), weights(p), shared(p);
  std::vector<int> slopes;
  for (Index j = 0; j < p; ++j) {
    const tracking::Drift& drift = model.drifts[static_cast<std::size_t>(j)];
    rates[j] = std::isnan(drift.rate) ? 0.0 : drift.rate;
    if (drift.has_slope) {
      slopes.push_back(static_cast<int>(j));
    }
    stddevs[j] = drift.change_stddev;
    weights[j] = drift.change_weight;
    shared[j] = drift.shared_error * drift.shared_error;
  }
  tables.addWide("known_rates", rates, "Variance of the other walks per second.");
  if (!slopes.empty()) {
    tables.addInts("slope_parameter", slopes, "Parameters that have a slope.");
  }
  tables.addWide("change_stddev", stddevs, "Of a sudden change; 0: three of a measurement.");
  tables.addWide("change_weight", weights, "How much likelier the parameter changes than others.");
  tables.addWide("shared_variance", shared, "Of an error that all measurements share, over one's variance.");
}

void addRates(const std::vector<Index>& unknown, CTables& tables) {
  VectorXd ratios(tracking::kRates);
  for (int g = 0; g < tracking::kRates; ++g) {
    ratios[g] = tracking::getRateRatio(g);
  }
  tables.addInts("unknown_rates", {unknown.begin(), unknown.end()}, "Parameters whose rates are learnt.");
  tables.addWide(
      "rate_ratios", ratios,
      "Standard deviations of a walk between two measurements, over that of a measurement: a filter "
      "each.");
  tables.addWide("square_ratios", listSquares(), "The squares of these and of those between them.");
  tables.addWide("log_rate_prior", tracking::makeLogRatePrior(), "Logarithms of their weights before.");
}

void addFollows(const tracking::Model& model, CTables& tables) {
  std::vector<int> parameters, conditions;
  for (const tracking::Follow& follow : model.follows) {
    parameters.push_back(static_cast<int>(follow.parameter));
    conditions.push_back(static_cast<int>(follow.condition));
  }
  tables.addInts("follow_parameter", parameters, "The parameter that follows, of each coefficient.");
  tables.addInts("follow_condition", conditions, "The condition that it follows.");
}

/// Of each parameter, at the ratios that lives were simulated for, at the model's own false alarms.
void addThresholds(const tracking::Model& model, CTables& tables) {
  const Index p = model.countParameters(), places = tracking::kRatioPlaces.size();
  MatrixXd logs(p, places);
  for (Index j = 0; j < p; ++j) {
    tracking::Model alone = model;
    alone.drifts = {model.drifts[static_cast<std::size_t>(j)]};
    alone.drifts.front().change_weight = 1.0;
    for (Index i = 0; i < places; ++i) {
      const double place = tracking::kRatioPlaces[static_cast<std::size_t>(i)];
      const double ratio = tracking::kSlowRatio * place / (1.0 - place);
      logs(j, i) = std::log(calcThreshold(alone, VectorXd::Constant(1, ratio)));
    }
  }
  VectorXd log_gammas(p + 1);
  log_gammas[0] = 0.0;
  for (Index k = 1; k < log_gammas.size(); ++k) {
    log_gammas[k] = std::lgamma(0.5 * static_cast<double>(k));
  }
  tables.addWide("log_thresholds", flattenRows(logs),
                 "Of each parameter, at places of the ratio of its walk.");
  tables.addWide("threshold_places", Eigen::Map<const VectorXd>(tracking::kRatioPlaces.data(), places),
                 "ratio / (ratio + threshold_ratio).");
  tables.addNumber("threshold_ratio", tracking::kSlowRatio, "Of a slow walk.");
  tables.addNumber("hardly_informative", 1.0 / (kUninformativeShare * kUninformativeShare) - 1.0,
                   "Information, over the prior's, below which a direction says nothing.");
  tables.addWide("log_gamma_half", log_gammas, "log Gamma(k / 2).");
}

CSizes listSizes(const tracking::Model& model, std::size_t unknown) {
  const auto size = [](Index value) { return static_cast<long>(value); };
  return {{"TRACK_STATES", size(model.countStates()), "levels, slopes, coefficients"},
          {"TRACK_SLOPES", size(model.countSlopes()), "parameters that have one"},
          {"TRACK_FOLLOWS", static_cast<long>(model.follows.size()), "coefficients of conditions"},
          {"TRACK_CONDITIONS", size(model.conditions), "that parameters follow"},
          {"TRACK_UNKNOWN", static_cast<long>(unknown), "rates that are learnt"},
          {"TRACK_RATES", tracking::kRates, "filters of each"},
          {"TRACK_OCTAVES", size(listSquares().size()), "rates that are weighed, of each"},
          {"TRACK_WINDOW", static_cast<long>(tracking::kChangeWindow),
           "measurements back that changes are supposed"},
          {"TRACK_PLACES", static_cast<long>(tracking::kRatioPlaces.size()), "of thresholds"},
          {"TRACK_SWEEPS", kSweeps, "of rotations, at most"}};
}

}  // namespace

CTrackSource makeTrackSource(const ExportedModel& model, const ExportedTracking& tracking,
                             const std::string& prefix) {
  const std::vector<Index> unknown = listUnknown(tracking.model);
  CTables tables(CNumber::kDouble);
  addSpace(model, tracking, tables);
  addPrior(tracking, tables);
  addDrifts(tracking.model, tables);
  if (!unknown.empty()) {
    addRates(unknown, tables);
  }
  if (!tracking.model.follows.empty()) {
    addFollows(tracking.model, tables);
  }
  addThresholds(tracking.model, tables);
  CTrackSource source;
  source.sizes = listSizes(tracking.model, unknown.size());
  source.bytes = tables.getBytes();
  source.header = renameC(std::string(getRuntimeSource("twinmap_track.h")), prefix);
  source.header = fillSlot(std::move(source.header), "@TRACK_SIZES@", writeSizes(source.sizes, prefix));
  source.header = fillSlot(std::move(source.header), "@TITLE@", model.experiment.name.text);
  source.source = fmt::format(
      "/* Generated by `twinmap export --track`. */\n#include \"{}_track.h\"\n\n#include <math.h>\n#include "
      "<string.h>\n\n{}",
      prefix,
      fillSlot(renameC(std::string(getRuntimeSource("track.c")), prefix), "@TABLES@\n", tables.getText()));
  return source;
}

}  // namespace twinmap
