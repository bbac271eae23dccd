#include "framework/inference/text/inference_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/base/log/notice.hpp"
#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/text_tables.hpp"
#include "framework/estimation/estimate.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/select_estimate.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

/// A status with what happened and what to do, a line each.
template <class... Arguments>
std::string explain(Notice notice, const Arguments&... arguments) {
  std::string text = describeNotice(notice, arguments...);
  text.insert(std::min(text.find('\n') + 1, text.size()), text.find('\n') == std::string::npos ? "" : "  ");
  return fmt::format("  {}: {}\n", getNotice(notice).name, text);
}

/// The first line alone, where its remedy has been tried or is another.
template <class... Arguments>
std::string explainBriefly(Notice notice, const Arguments&... arguments) {
  const std::string text = describeNotice(notice, arguments...);
  return fmt::format("  {}: {}\n", getNotice(notice).name, text.substr(0, text.find('\n')));
}

std::string listBeyondBounds(const Estimate& estimate, const std::vector<ParameterSpec>& parameters) {
  std::vector<std::string> names;
  for (std::size_t p = 0; p < parameters.size() && estimate.isGiven(); ++p) {
    const double mean = estimate.mean[static_cast<Index>(p)];
    if (mean <= parameters[p].bounds.lower || mean >= parameters[p].bounds.upper) {
      names.push_back(parameters[p].name.text);
    }
  }
  return names.empty() ? "a nuisance parameter" : listNames(names);
}

/// Names and, of the first, the reduction.
std::string explainUninformative(const Estimate& estimate, const std::vector<ParameterSpec>& parameters) {
  constexpr double kUninformative = 0.9, kPercent = 100.0;  // of the standard deviation of the bounds
  std::string text;
  for (std::size_t p = 0; p < parameters.size() && estimate.isGiven(); ++p) {
    const Bounds& bounds = parameters[p].bounds;
    const double left =
        estimate.stddev[static_cast<Index>(p)] / (kUniformStddev * (bounds.upper - bounds.lower));
    if (left > kUninformative) {
      text += explain(Notice::kUninformative, parameters[p].name.text,
                      fmt::format("{:.0f} %", kPercent * std::max(0.0, 1.0 - left)));
    }
  }
  return text;
}

std::string explainStatus(TrustStatus status, const InferredMeasurement& inferred, const Estimate& estimate,
                          const std::vector<ParameterSpec>& parameters,
                          const std::vector<FeatureInfo>& features) {
  switch (status) {
    case TrustStatus::kModelMismatch:
      return inferred.fault.empty()
                 ? explain(Notice::kModelMismatch, describeAnomaly(*inferred.trust, features))
                 : explainBriefly(Notice::kModelMismatch,
                                  inferred.fault + " (this explains 99 % of the misfit)");
    case TrustStatus::kOutsideTraining:
      return explain(Notice::kOutsideTraining, inferred.trust->distance);
    case TrustStatus::kAtBounds:
      return explain(Notice::kAtBounds, listBeyondBounds(estimate, parameters));
    case TrustStatus::kUninformative:
      return explainUninformative(estimate, parameters);
    case TrustStatus::kOk:
      break;
  }
  return "";
}

/// "p = 0.61", or "p < 0.002" where simulated measurements can tell no more.
std::string describePValue(const Trust& trust) {
  return trust.p_value <= trust.smallest_p_value ? fmt::format("p < {:.2g}", trust.smallest_p_value)
                                                 : fmt::format("p = {:.2g}", trust.p_value);
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

/// "y(0.1 s)", "y between 0.1 s and 0.4 s", "y(0.1 s) to theta(0.2 s)".
std::string describeStretch(const std::string& first, const std::string& last) {
  const std::size_t open = first.find('(');
  if (first == last) {
    return first;
  }
  if (open == std::string::npos || last.compare(0, open + 1, first, 0, open + 1) != 0) {
    return first + " to " + last;
  }
  const auto take = [open](const std::string& name) { return name.substr(open + 1, name.size() - open - 2); };
  return first.substr(0, open) + " between " + take(first) + " and " + take(last);
}

/// How the refinement went; the table of its estimate follows where it was accepted.
std::string describeRefined(const Refined& refined) {
  if (!refined.isAccepted()) {
    return fmt::format("  refinement rejected ({}): {}; unconfirmed quick estimate:\n",
                       toString(refined.status), refined.message);
  }
  constexpr double kFar = 5.0;
  return fmt::format(
      "  refined in {} step{} ({} simulations), moved {:.2g} sd from the starting estimate{}:\n",
      refined.iterations, refined.iterations == 1 ? "" : "s", refined.simulations, refined.distance,
      refined.distance > kFar ? " (the quick estimate was poor; this is normal)" : "");
}

/// The components of a mixture.
std::string describeMixture(const Mixture& mixture, const std::vector<ParameterSpec>& parameters) {
  constexpr int kDigits = 5, kStddevDigits = 3;
  std::string text = "  multimodal, several parameter values may fit:\n";
  for (Index c = 0; c < mixture.countComponents(); ++c) {
    std::string values;
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      const auto i = static_cast<Index>(p);
      values += fmt::format("{}{} = {} +- {}", p == 0 ? "" : ", ", parameters[p].name.text,
                            toShortText(mixture.means(i, c), kDigits),
                            toShortText(mixture.stddevs(i, c), kStddevDigits));
    }
    text += fmt::format("    {:4.1f} %: {}\n", 100.0 * mixture.weights[c], values);
  }
  return text;
}

std::string describeDiagnostics(const PosteriorEstimate& posterior) {
  return fmt::format("effective sample size {:.0f} of {}, Pareto shape {:.2f}",
                     posterior.effective_sample_size, posterior.evaluations, posterior.pareto_shape);
}

/// How the simulator's posterior was found.
std::string describeSearches(const PosteriorEstimate& posterior) {
  const SimulatorFit& fit = *posterior.fit;
  return fmt::format(
      "  sampled on the simulator: best fit found by {} of {} searches, {} draws worth {:.0f} independent "
      "ones, {} simulations\n",
      fit.found_best, fit.searches, posterior.evaluations, posterior.effective_sample_size, fit.simulations);
}

/// The simulator's: how it was found, or why it is not the estimate. The surrogate's: its own table.
std::string describePosterior(const PosteriorEstimate& posterior,
                              const std::vector<ParameterSpec>& parameters) {
  if (!posterior.isReliable()) {
    const std::string advice = posterior.fit && posterior.fit->isSimulated()
                                   ? "; give narrower bounds, or more draws (--posterior=2000)"
                                   : "";
    return fmt::format("  no posterior: {} ({}){}\n", posterior.message, describeDiagnostics(posterior),
                       advice);
  }
  if (posterior.fit) {
    return describeSearches(posterior);
  }
  return fmt::format("  posterior under the surrogate ({}), for its shape:\n",
                     describeDiagnostics(posterior)) +
         makeTable(posterior.estimate, parameters);
}

/// What a mismatch shows itself by, and what to look at.
std::string explainMismatch(const SimulatorFit& fit, const std::vector<FeatureInfo>& features) {
  const ResidualTest& test = fit.test;
  if (test.largest_p <= std::min(test.chi_square_p, test.whiteness_p)) {
    return fmt::format(
        "  No parameter values within the bounds fit {}: it is {:.3g} noise sd off. Is it a spike?\n",
        features[static_cast<std::size_t>(test.largest)].name, std::abs(fit.residual[test.largest]));
  }
  if (test.whiteness_p < test.chi_square_p) {
    return "  The residuals of neighbouring samples agree more than the stated noise allows: the noise is "
           "coloured, or the model lacks something small.\n";
  }
  return "  No parameter values within the bounds fit the measurement: look at the residuals (a sensor "
         "fault, a wrong trigger, larger noise, physics that the model lacks).\n";
}

/// Of what no trust model has judged.
std::string describeUntrained(const InferredMeasurement& inferred, const std::string& statuses,
                              const std::vector<FeatureInfo>& features) {
  if (!inferred.posterior || !inferred.posterior->fit) {
    return inferred.source + ": " + statuses + (statuses.empty() ? "" : "; ") +
           "not judged (the run has no trust model)\n";
  }
  const SimulatorFit& fit = *inferred.posterior->fit;
  if (!fit.isSimulated()) {
    return fmt::format("{}: {}\n", inferred.source, statuses);
  }
  const double p_value = fit.test.calcPValue();
  return fmt::format("{}: {} (p = {:.2g}, chi-square {:.4g} of {:.4g} degrees of freedom)\n", inferred.source,
                     statuses, p_value, fit.chi_square, fit.degrees) +
         (p_value < kMismatchLevel ? explainMismatch(fit, features) : "");
}

bool contains(const std::vector<std::string>& statuses, const std::string& status) {
  return std::find(statuses.begin(), statuses.end(), status) != statuses.end();
}

}  // namespace

std::string describeTrust(const InferredMeasurement& inferred, const std::vector<ParameterSpec>& parameters,
                          const std::vector<FeatureInfo>& features) {
  const std::vector<std::string> statuses = listStatuses(inferred);
  const std::string joined = joinStatuses(statuses, ", ");
  if (!inferred.trust) {
    return describeUntrained(inferred, joined, features);
  }
  const Trust& trust = *inferred.trust;
  std::string text = fmt::format("{}: {} ({}, chi-square {:.1f} of {} residuals)\n", inferred.source, joined,
                                 describePValue(trust), trust.chi_square, trust.residuals);
  const Estimate estimate = selectEstimate(inferred);
  for (const TrustStatus status : trust.statuses) {
    if (contains(statuses, toString(status))) {
      text += explainStatus(status, inferred, estimate, parameters, features);
    }
  }
  if (isUncalibrated(inferred)) {
    text += explain(Notice::kUncalibrated);
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
  return "the largest misfit is in " + describeStretch(first, last);
}

std::string describeMapLimit(const InferredMeasurement& inferred,
                             const std::vector<ParameterSpec>& parameters) {
  if (!isEstimatorLimited(inferred)) {
    return "";
  }
  const bool misfits = inferred.trust && inferred.trust->statuses.front() == TrustStatus::kModelMismatch;
  if (misfits) {
    return "";  // no standard deviation means anything then
  }
  const Eigen::VectorXd ratio = inferred.by_estimator.calcRatioToLimit();
  std::vector<std::string> far;
  for (Index p = 0; p < ratio.size(); ++p) {
    if (ratio[p] > kEstimatorLimitedRatio) {
      far.push_back(
          fmt::format("{} is {:.2g} times", parameters[static_cast<std::size_t>(p)].name.text, ratio[p]));
    }
  }
  if (!far.empty()) {
    return inferred.refined ? explainBriefly(Notice::kEstimatorLimited, listNames(far))
                            : explain(Notice::kEstimatorLimited, listNames(far));
  }
  return fmt::format(
      "  estimator_limited: the error estimate of the fast model is unreliable "
      "(cross-validation)\n{}",
      inferred.refined ? "" : "    Refine the estimate: --refine.\n");
}

std::string makeInferenceTable(const InferredMeasurement& inferred,
                               const std::vector<ParameterSpec>& parameters,
                               const std::vector<FeatureInfo>& features) {
  const Estimate estimate = selectEstimate(inferred);
  const bool sampled = estimate.method == EstimationMethod::kPosterior;
  std::string text = describeTrust(inferred, parameters, features) + describeMapLimit(inferred, parameters);
  if (inferred.refined && !sampled) {
    text += describeRefined(*inferred.refined);
  }
  if (estimate.isGiven()) {
    text += makeTable(estimate, parameters);
  }
  if (estimate.isMultimodal()) {
    text += describeMixture(estimate.mixture, parameters);
  }
  if (inferred.posterior) {
    text += describePosterior(*inferred.posterior, parameters);
  }
  if (inferred.by_estimator.isGiven() && (estimate.isRefined() || sampled)) {
    text += "  starting estimate (quick, not refined):\n" + makeTable(inferred.by_estimator, parameters);
  }
  return text;
}

}  // namespace twinmap
