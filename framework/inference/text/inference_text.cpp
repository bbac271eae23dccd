#include "framework/inference/text/inference_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/text_tables.hpp"
#include "framework/estimation/estimate.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/derived_values.hpp"
#include "framework/inference/select_estimate.hpp"
#include "kernels/linalg/autocorrelation.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

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

void addRows(const std::vector<DerivedValue>& derived, std::vector<Row>& rows) {
  for (const DerivedValue& value : derived) {
    ParameterSpec shown;
    shown.name.text = value.name;
    shown.unit = value.unit;
    rows.push_back(makeRow(shown, value.mean, value.stddev, {{value.lower95, value.upper95}}));
  }
}

/// `quantities`: null where nothing is derived.
std::string makeTable(const Estimate& estimate, const std::vector<ParameterSpec>& parameters,
                      const DerivedQuantities* quantities) {
  std::vector<Row> rows;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const auto i = static_cast<Index>(p);
    rows.push_back(makeRow(parameters[p], estimate.mean[i], estimate.stddev[i],
                           estimate.findIntervals(i, Coverage::k95)));
  }
  addRows(deriveFrom(quantities, estimate), rows);
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
                              const std::vector<ParameterSpec>& parameters,
                              const DerivedQuantities* quantities) {
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
  return fmt::format("  the posterior ({}):\n", describeDiagnostics(posterior)) +
         makeTable(posterior.estimate, parameters, quantities);
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

/// "  The noise of x is 0.0015 m, 3 times what the file states."
std::string describeFound(const NoiseReport& report) {
  constexpr int kDigits = 3;
  const std::string unit = report.unit.empty() ? "" : " " + report.unit;
  const FoundNoise& found = report.found;
  std::string text;
  if (report.differs() || !report.isStated()) {
    text = fmt::format("  The noise of {} is {}{}", report.output, toShortText(report.stddev, kDigits), unit);
    text += report.isStated()
                ? fmt::format(
                      ", {:.3g} times what the file states. The intervals are those of the noise found.\n",
                      found.factor)
                : ". As it is inferred, the size of the residual is not tested.\n";
  }
  if (found.autoregression.size() > 0) {
    text += fmt::format(
        "  The noise of {} is coloured: neighbouring samples have a correlation of {:.2f}. The intervals "
        "follow it.\n",
        report.output,
        calcAutocorrelation(std::vector<double>(found.autoregression.begin(), found.autoregression.end()),
                            1)[1]);
  }
  if (found.has_offset) {
    text += fmt::format("  {} has an offset of {}{} (sd {}{}), which is left out of the estimate.\n",
                        report.output, toShortText(found.offset, kDigits), unit,
                        toShortText(found.offset_stddev, kDigits), unit);
  }
  return text;
}

/// What the recording has other than the stated noise.
std::string describeNoise(const SimulatorFit& fit) {
  constexpr std::size_t kShown = 8;
  std::string text;
  if (!fit.outliers.empty()) {
    for (std::size_t i = 0; i < std::min(kShown, fit.outliers.size()); ++i) {
      text += (i == 0 ? "" : ", ") + fit.outliers[i];
    }
    text = fmt::format("  {} samples are not noise and are left out: {}{}\n", fit.outliers.size(), text,
                       fit.outliers.size() > kShown ? " ..." : "");
  }
  for (const NoiseReport& report : fit.noise) {
    text += describeFound(report);
  }
  return text;
}

bool contains(const std::vector<std::string>& statuses, const std::string& status) {
  return std::find(statuses.begin(), statuses.end(), status) != statuses.end();
}

}  // namespace

std::string describeTrust(const InferredMeasurement& inferred, const std::vector<FeatureInfo>& features) {
  const std::vector<std::string> statuses = listStatuses(inferred);
  const std::string joined = joinStatuses(statuses, ", ");
  if (!inferred.trust) {
    return describeUntrained(inferred, joined, features);
  }
  const Trust& trust = *inferred.trust;
  std::string text = fmt::format("{}: {} (p = {:.2g}, chi-square {:.1f} of {} residuals)\n", inferred.source,
                                 joined, trust.p_value, trust.chi_square, trust.residuals);
  for (const TrustStatus status : trust.statuses) {
    if (contains(statuses, toString(status))) {
      text += explainStatus(status, trust, features);
    }
  }
  if (isUncalibrated(inferred)) {
    text += "  95 % intervals of the run's own refined test samples held less than 92 % of the truths.\n";
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
    text += fmt::format(
        "  The map's standard deviations are not calibrated (cross-validation, test samples): {}.\n", advice);
  }
  return text;
}

std::string makeInferenceTable(const InferredMeasurement& inferred,
                               const std::vector<ParameterSpec>& parameters,
                               const std::vector<FeatureInfo>& features) {
  const Estimate estimate = selectEstimate(inferred);
  const bool sampled = estimate.method == EstimationMethod::kPosterior;
  std::string text = describeTrust(inferred, features) + describeMapLimit(inferred, parameters);
  if (inferred.posterior && inferred.posterior->fit) {
    text += describeNoise(*inferred.posterior->fit);
  }
  for (const std::string& missing : inferred.left_out) {
    text += "  left out: " + missing + "\n";
  }
  if (inferred.refined && !sampled) {
    text += describeRefined(*inferred.refined);
  }
  if (estimate.isGiven()) {
    text += makeTable(estimate, parameters, inferred.quantities.get());
  }
  for (const std::string& advice : adviseOnRidges(inferred.ridges, parameters)) {
    text += "  " + advice + "\n";
  }
  if (estimate.isMultimodal()) {
    text += describeMixture(estimate.mixture, parameters);
  }
  if (inferred.posterior) {
    text += describePosterior(*inferred.posterior, parameters, inferred.quantities.get());
  }
  if (inferred.by_estimator.isGiven() && (estimate.isRefined() || sampled)) {
    text += "  the map's:\n" + makeTable(inferred.by_estimator, parameters, inferred.quantities.get());
  }
  return text;
}

}  // namespace twinmap
