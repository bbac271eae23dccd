#include "framework/inference/inference_text.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/base/text/escape.hpp"
#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/text_tables.hpp"
#include "framework/estimation/estimate.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/select_estimate.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

std::string joinStatuses(const std::vector<std::string>& statuses, const char* separator) {
  std::string joined;
  for (const std::string& status : statuses) {
    joined += (joined.empty() ? "" : separator) + status;
  }
  return joined;
}

/// What is wrong, in words; one line each.
std::string explainStatus(TrustStatus status, const Trust& trust, const std::vector<FeatureInfo>& features) {
  switch (status) {
    case TrustStatus::kModelMismatch:
      return fmt::format("  No parameter values within the bounds fit the measurement: {}.\n",
                         describeAnomaly(trust, features));
    case TrustStatus::kOutsideTraining:
      return fmt::format(
          "  The features are {:.2g} times as far from the training samples as simulated "
          "measurements are at most.\n",
          trust.distance);
    case TrustStatus::kAtBounds:
      return "  A parameter lies beyond its bounds: widen them and train again.\n";
    case TrustStatus::kUninformative:
      return "  A parameter's sd is close to that of its bounds: this measurement says little about it.\n";
    case TrustStatus::kOk:
      break;
  }
  return "";
}

using Row = std::vector<std::string>;

constexpr const char* kIndent = "  ";

std::string describeIntervals(const Intervals& intervals) {
  constexpr int kDigits = 6;
  std::string text;
  for (const auto& [lower, upper] : intervals) {
    text += fmt::format("{}{} .. {}", text.empty() ? "" : ", ", toShortText(lower, kDigits),
                        toShortText(upper, kDigits));
  }
  return text;
}

Row makeRow(const ParameterSpec& parameter, double mean, double stddev, const Intervals& intervals95) {
  constexpr int kDigits = 6, kStddevDigits = 3;
  return {parameter.name.text, parameter.unit, toShortText(mean, kDigits), toShortText(stddev, kStddevDigits),
          describeIntervals(intervals95)};
}

std::string makeTable(std::vector<Row> rows) {
  rows.insert(rows.begin(), {"parameter", "unit", "mean", "sd", "95 % interval"});
  return alignRows(rows, rows.front().size(), kIndent);
}

std::string makeTable(const Estimate& estimate, const std::vector<ParameterSpec>& parameters) {
  std::vector<Row> rows;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const auto i = static_cast<Index>(p);
    rows.push_back(makeRow(parameters[p], estimate.mean[i], estimate.stddev[i],
                           estimate.findIntervals(i, Coverage::k95)));
  }
  return makeTable(std::move(rows));
}

/// How the refinement went; the table of its estimate follows where it was accepted.
std::string describeRefined(const Refined& refined) {
  if (!refined.isAccepted()) {
    return fmt::format("  not refined ({}): {}; the map's unconfirmed estimate:\n", toString(refined.status),
                       refined.message);
  }
  return fmt::format("  refined by {} steps ({} simulations), {:.2g} sd from the map's estimate:\n",
                     refined.iterations, refined.simulations, refined.distance);
}

/// The components of a mixture.
std::string describeMixture(const Mixture& mixture, const std::vector<ParameterSpec>& parameters) {
  constexpr int kDigits = 5, kStddevDigits = 3;
  constexpr double kMin = 0.01;  // a lighter one is not worth a line
  std::string text = "  multimodal, several parameter values may fit:\n";
  for (Index c = 0; c < mixture.countComponents(); ++c) {
    std::string values;
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      const auto i = static_cast<Index>(p);
      values += fmt::format("{}{} = {} +- {}", p == 0 ? "" : ", ", parameters[p].name.text,
                            toShortText(mixture.means(i, c), kDigits),
                            toShortText(mixture.stddevs(i, c), kStddevDigits));
    }
    if (mixture.weights[c] > kMin) {
      text += fmt::format("    {:3.0f} %: {}\n", 100.0 * mixture.weights[c], values);
    }
  }
  return text;
}

std::string describePosterior(const SurrogatePosterior& posterior,
                              const std::vector<ParameterSpec>& parameters) {
  const std::string diagnostics =
      fmt::format("effective sample size {:.0f} of {}, Pareto shape {:.2f}", posterior.effective_sample_size,
                  posterior.evaluations, posterior.pareto_shape);
  if (!posterior.isReliable()) {
    return fmt::format("  no posterior: {} ({})\n", posterior.message, diagnostics);
  }
  std::vector<Row> rows;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const auto i = static_cast<Index>(p);
    rows.push_back(makeRow(parameters[p], posterior.mean[i], posterior.stddev[i],
                           {{posterior.getLower95()[i], posterior.getUpper95()[i]}}));
  }
  return fmt::format("  the posterior ({}):\n", diagnostics) + makeTable(std::move(rows));
}

/// Empty but for the diagnostics where it is not reliable.
std::string makePosteriorCells(const SurrogatePosterior& posterior, Index parameter) {
  std::string text = ",,";
  if (posterior.isReliable()) {
    text = "," + toText(posterior.mean[parameter]) + "," + toText(posterior.stddev[parameter]);
  }
  for (Index k = 0; k < static_cast<Index>(kPosteriorProbabilities.size()); ++k) {
    text += posterior.isReliable() ? "," + toText(posterior.quantiles(parameter, k)) : ",";
  }
  return text + "," + toText(posterior.effective_sample_size) + "," + toText(posterior.pareto_shape);
}

}  // namespace

std::string describeTrust(const InferredMeasurement& inferred, const std::vector<FeatureInfo>& features) {
  if (!inferred.trust) {
    const std::string statuses = joinStatuses(listStatuses(inferred), ", ");
    return inferred.source + ": " + statuses + (statuses.empty() ? "" : "; ") +
           "not judged (the run has no trust model)\n";
  }
  const Trust& trust = *inferred.trust;
  std::string text = fmt::format("{}: {} (p = {:.2g}, chi-square {:.1f} of {} residuals)\n", inferred.source,
                                 joinStatuses(listStatuses(inferred), ", "), trust.p_value, trust.chi_square,
                                 trust.residuals);
  for (const TrustStatus status : trust.statuses) {
    text += explainStatus(status, trust, features);
  }
  return text;
}

std::string describeAnomaly(const Trust& trust, const std::vector<FeatureInfo>& features) {
  const Anomaly& anomaly = trust.anomaly;
  if (anomaly.first + anomaly.count > static_cast<Index>(features.size())) {
    return "";
  }
  const std::string& first = features[static_cast<std::size_t>(anomaly.first)].name;
  const std::string& last = features[static_cast<std::size_t>(anomaly.first + anomaly.count - 1)].name;
  return "it is worst at " + (anomaly.count == 1 ? first : first + " to " + last);
}

std::string describeMapLimit(const InferredMeasurement& inferred,
                             const std::vector<ParameterSpec>& parameters) {
  if (!isEstimatorLimited(inferred)) {
    return "";
  }
  const char* advice = inferred.refined ? "add simulations" : "refine, or add simulations";
  const Eigen::VectorXd ratio = inferred.by_estimator.calcRatioToLimit();
  std::vector<std::string> far;
  for (Index p = 0; p < ratio.size(); ++p) {
    if (ratio[p] > kEstimatorLimitedRatio) {
      far.push_back(
          fmt::format("{} is {:.2g} times", parameters[static_cast<std::size_t>(p)].name.text, ratio[p]));
    }
  }
  std::string text =
      far.empty() ? "" : fmt::format("  {} above what the measurement allows: {}.\n", listNames(far), advice);
  if (!inferred.estimator_is_calibrated) {
    text +=
        fmt::format("  The map's standard deviations are not calibrated (cross-validation): {}.\n", advice);
  }
  return text;
}

std::string makeInferenceTable(const InferredMeasurement& inferred,
                               const std::vector<ParameterSpec>& parameters,
                               const std::vector<FeatureInfo>& features) {
  const Estimate estimate = selectEstimate(inferred);
  std::string text = describeTrust(inferred, features) + describeMapLimit(inferred, parameters);
  if (inferred.refined) {
    text += describeRefined(*inferred.refined);
  }
  text += makeTable(estimate, parameters);
  if (estimate.isRefined()) {
    text += "  the map's:\n" + makeTable(inferred.by_estimator, parameters);
  }
  if (isMultimodal(estimate.mixture)) {
    text += describeMixture(estimate.mixture, parameters);
  }
  if (inferred.posterior) {
    text += describePosterior(*inferred.posterior, parameters);
  }
  return text;
}

std::string makeInferenceCsvHeader(bool refined, bool posterior) {
  return std::string("source,start,parameter,unit,mean,sd,lower,upper,status,p_value,method") +
         (refined ? ",refined_mean,refined_sd,map_mean,map_sd" : "") +
         (posterior ? ",posterior_mean,posterior_sd,posterior_q2.5,posterior_q16,posterior_q50,posterior_q84,"
                      "posterior_q97.5,effective_sample_size,pareto_shape"
                    : "") +
         "\n";
}

std::string makeDrawsCsvHeader(const std::vector<ParameterSpec>& unknown) {
  std::string text = "source,start,draw";
  for (const ParameterSpec& parameter : unknown) {
    text += "," + escapeCsv(parameter.name.text);
  }
  return text + "\n";
}

std::string makeDrawsCsvRows(const InferredMeasurement& inferred) {
  std::string text;
  const Eigen::MatrixXd& draws = inferred.posterior->draws;
  const std::string measurement = escapeCsv(inferred.source) + "," + toText(inferred.start);
  for (Index i = 0; i < draws.cols(); ++i) {
    text += measurement + "," + std::to_string(i);
    for (const double value : draws.col(i)) {
      text += "," + toText(value);
    }
    text += "\n";
  }
  return text;
}

std::string makeInferenceCsvRows(const InferredMeasurement& inferred,
                                 const std::vector<ParameterSpec>& parameters) {
  const Estimate estimate = selectEstimate(inferred);
  const Bounds95 bounds = estimate.calcBounds95();
  const Estimate& by_estimator = inferred.by_estimator;
  std::string text;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const auto i = static_cast<Index>(p);
    const double mean = estimate.mean[i], stddev = estimate.stddev[i];
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{}", escapeCsv(inferred.source),
                        toText(inferred.start), escapeCsv(parameters[p].name.text),
                        escapeCsv(parameters[p].unit), toText(mean), toText(stddev), toText(bounds.lower[i]),
                        toText(bounds.upper[i]), joinStatuses(estimate.statuses, " "),
                        inferred.trust ? toText(inferred.trust->p_value) : "", toString(estimate.method));
    if (inferred.refined) {
      text += estimate.isRefined() ? fmt::format(",{},{}", toText(mean), toText(stddev)) : ",,";
      text += fmt::format(",{},{}", toText(by_estimator.mean[i]), toText(by_estimator.stddev[i]));
    }
    if (inferred.posterior) {
      text += makePosteriorCells(*inferred.posterior, i);
    }
    text += "\n";
  }
  return text;
}

}  // namespace twinmap
