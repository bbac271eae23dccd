#include <fmt/core.h>

#include <algorithm>

#include "framework/estimation/surrogate/score_inversion.hpp"
#include "framework/export/c_code/c_model_tables.hpp"
#include "kernels/linalg/packed_lower.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::string addWindow(const gp::SharedProcess& process, std::size_t index, CTables& tables) {
  const gp::SharedProcessParts parts = process.getParts();
  const std::string name = fmt::format("window_{}", index);
  const Index n = parts.scaled_points.rows(), terms = parts.coefficients.rows();
  tables.addWide(name + "_length_scales", parts.hyperparameters.length_scales,
                 "Length scale of each variable, in half widths of the box.");
  tables.addWide(name + "_points", flattenColumns(parts.scaled_points),
                 fmt::format("{} training points over the length scales, variable by variable.", n));
  tables.addWide(
      name + "_weights", flattenColumns(parts.weights),
      fmt::format("Weights of values, then of slopes: {} of each score, in noise standard deviations.",
                  parts.weights.rows()));
  tables.addWide(name + "_coefficients", flattenColumns(parts.coefficients),
                 fmt::format("Coefficients of the trend's {} terms, score by score.", terms));
  tables.addWide(name + "_amplitudes", parts.amplitude, "Variance of each score where the process's is 1.");
  tables.addWide(name + "_ratios", parts.left_out_ratio,
                 "Of each training point, left out: squared error over its variance.");
  const bool own = parts.slope_points == 0;
  if (own) {
    tables.addWide(name + "_factor", parts.factor_tiles, "Lower factor of the points' covariance, in tiles.");
    tables.addWide(name + "_terms", flattenColumns(parts.solved_terms),
                   "The trend's terms, whitened, term by term.");
    tables.addWide(name + "_term_factor", flattenRows(parts.term_factor),
                   "Lower factor of their information, row by row.");
  }
  const bool exponential = parts.structure.covariance == gp::SmoothCovariance::kSquaredExponential;
  const std::string smooth =
      fmt::format("{{{}, {}, {}, {}, {}, {}, {}_points}}",
                  exponential ? "SMOOTH_EXPONENTIAL" : "SMOOTH_MATERN_52", n, parts.scaled_points.cols(),
                  parts.slope_points, parts.slope_variables, toC(parts.hyperparameters.nugget), name);
  const std::string own_variance = own ? fmt::format("{{{0}, {1}, {2}_factor, {2}_terms, {2}_term_factor}}",
                                                     linalg::PackedLower::roundUp(n), terms, name)
                                       : "{0, 0, 0, 0, 0}";
  return fmt::format(
      "{0}, {1}, {2},\n   {3}, {4}_length_scales, {4}_weights, {4}_coefficients, {4}_amplitudes, {4}_ratios",
      parts.structure.trend == gp::Trend::kQuadratic ? 1 : 0, terms, smooth, own_variance, name);
}

}  // namespace

void addScores(const ExportedModel& model, CTables& tables, CSizes& sizes) {
  const ForwardSurrogate& forward = *model.findForward();
  tables.addWide("feature_center", forward.center, "Mean of the clean features, in their units.");
  tables.addWide("projection", flattenColumns(forward.projection),
                 fmt::format("Scores per unit of the features, {} x {}, feature by feature.",
                             forward.projection.rows(), forward.projection.cols()));
  tables.addWide("box_center", model.getBoxCenter(),
                 "Middle of the bounds: parameters, nuisance, known inputs.");
  tables.addWide("box_half_width", model.getBoxHalfWidth(), "Half of their width, in their units.");
  const BoxPrior& prior = *model.findPrior();
  tables.addWide("prior_mean", prior.mean, "Mean of what is known before, in half widths from the middle.");
  tables.addWide("prior_relative", flattenColumns(prior.relative),
                 "Its information over that of a uniform distribution within the bounds.");
  const Index p = model.countParameters();
  tables.addWide("prior_sd", model.getBoxHalfWidth().head(p).cwiseProduct(prior.stddev.head(p)),
                 "Its standard deviation within the bounds, in the parameters' units.");
  sizes.push_back(
      {"SCORES", static_cast<long>(forward.getScoreCount()), "numbers that stand for the features"});
  sizes.push_back(
      {"VARIABLES", static_cast<long>(forward.points.rows()), "parameters, nuisance, known inputs"});
  sizes.push_back({"UNKNOWN", static_cast<long>(model.countUnknown()), "of them, those that are not known"});
  sizes.push_back(
      {"POINTS", static_cast<long>(forward.points.cols()), "training simulations of the processes"});
}

void addWindows(const ExportedModel& model, CTables& tables, CSizes& sizes) {
  const ForwardSurrogate& forward = *model.findForward();
  const LeadingScores leading = findLeadingScores(forward, model.countUnknown());
  const Index n = forward.points.cols();
  std::vector<std::string> windows, entries;
  for (const exact::score_window& window : leading.windows) {
    windows.push_back(fmt::format("{}, {}, {}", window.first, window.functions, window.leading));
  }
  Index slope_points = 0, terms = 0;
  for (const gp::SharedProcess& process : forward.windows) {
    entries.push_back(addWindow(process, entries.size(), tables));
    const gp::SharedProcessParts parts = process.getParts();
    slope_points = std::max(slope_points, parts.slope_points);
    terms = std::max(terms, parts.coefficients.rows());
  }
  tables.addStructs("score_window", "score_windows", windows,
                    "Windows of scores: the first, how many, how many of them the first search looks at.");
  tables.addStructs("window", "windows", entries, "Their processes.");
  tables.addWide("rough_weights", calcRoughWeights(forward).matrix(),
                 "1 / standard deviation of each score's noise and mean error.");
  tables.addWide("leading_weights", leading.weights, "The same of the scores that say most, else 0.");
  tables.addWide("score_correlation", linalg::packColumns(forward.error_correlation),
                 "Correlation of the scores' errors: lower triangle, column by column.");
  tables.addWide("training_points", flattenColumns(forward.points),
                 "Training points in half widths of the box from its middle, point by point.");
  tables.addReal("training_scores", flattenColumns(forward.scores), "Their scores, point by point.");
  sizes.push_back({"WINDOWS", static_cast<long>(entries.size()), "groups of scores"});
  const auto u = static_cast<int>(model.countUnknown()), m = static_cast<int>(forward.points.rows());
  const int search =
      exact::countSearch(static_cast<int>(forward.getScoreCount()), u, m, static_cast<int>(entries.size()));
  sizes.push_back({"SEARCH", search, "numbers of a search for the unknown"});
  sizes.push_back({"SLOPE_POINTS", static_cast<long>(slope_points), "most points with slopes"});
  sizes.push_back({"TERMS", static_cast<long>(terms), "most terms of a trend"});
  sizes.push_back(
      {"PADDED_POINTS", static_cast<long>(linalg::PackedLower::roundUp(n)), "POINTS in whole tiles"});
}

void addSurrogateMap(const Surrogate& surrogate, CTables& tables, CSizes& sizes) {
  tables.addWide("prior_within", flattenColumns(surrogate.prior.within),
                 "Information of the prior beside that of the bounds, per half width squared.");
  tables.addWide("prior_shift", surrogate.prior.shift, "That times its mean.");
  tables.addWide("prior_center", surrogate.calcPriorCenter(),
                 "Mean of the prior, within the bounds, in the parameters' units.");
  tables.addWide("stddev_scale", surrogate.validation.stddev_scale,
                 "By which standard deviations are multiplied (cross-validation).");
  tables.addWide("limit_scale", surrogate.validation.limit_scale,
                 "By which those that the noise of the scores leaves are, for what other scores would say.");
  sizes.push_back(
      {"INPUTS", static_cast<long>(surrogate.forward->getScoreCount()), "inputs of the map: scores"});
}

}  // namespace twinmap
