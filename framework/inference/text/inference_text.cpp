#include "framework/inference/text/inference_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "framework/base/log/notice.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/text_tables.hpp"
#include "framework/estimation/estimate.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/inference/stated_values.hpp"
#include "framework/inference/text/explain_notice.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

using Row = std::vector<std::string>;

constexpr const char* kIndent = "  ";

std::string describeIntervals(const Intervals& intervals) {
  std::string text;
  for (const auto& [lower, upper] : intervals) {
    text += fmt::format("{}{} .. {}", text.empty() ? "" : ", ", toShortText(lower, kEstimateDigits),
                        toShortText(upper, kEstimateDigits));
  }
  return text;
}

Row makeRow(const ParameterSpec& parameter, double mean, double stddev, const Intervals& intervals95) {
  return {parameter.name.text, parameter.unit, toShortText(mean, kEstimateDigits),
          toShortText(stddev, kStddevDigits), describeIntervals(intervals95)};
}

std::string makeTable(std::vector<Row> rows) {
  rows.insert(rows.begin(), {"parameter", "unit", "mean", "sd", "95 % interval"});
  return alignRows(rows, rows.front().size(), kIndent);
}

void addRows(const std::vector<DerivedValue>& values, const char* kind, std::vector<Row>& rows) {
  for (const DerivedValue& value : values) {
    if (value.isStated()) {
      ParameterSpec shown;
      shown.name.text = value.name + kind;
      shown.unit = value.unit;
      rows.push_back(makeRow(shown, value.mean, value.stddev, {{value.lower95, value.upper95}}));
    }
  }
}

/// The combinations that the experiment does not derive anyway.
std::vector<DerivedValue> dropDerived(const StatedValues& stated) {
  std::vector<DerivedValue> others;
  std::copy_if(stated.identified.begin(), stated.identified.end(), std::back_inserter(others),
               [&](const DerivedValue& one) {
                 return std::none_of(stated.derived.begin(), stated.derived.end(),
                                     [&](const DerivedValue& derived) {
                                       return std::abs(one.mean - derived.mean) <= kSameNumber * one.stddev;
                                     });
               });
  return others;
}

/// "" where nothing is stated.
std::string makeTable(const StatedValues& stated, const std::vector<ParameterSpec>& parameters) {
  std::vector<Row> rows;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const auto i = static_cast<Index>(p);
    if (isStated(stated.estimate, i)) {
      rows.push_back(makeRow(parameters[p], stated.estimate.mean[i], stated.estimate.stddev[i],
                             stated.estimate.findIntervals(i, Coverage::k95)));
    }
  }
  addRows(stated.derived, "", rows);
  addRows(dropDerived(stated), "", rows);
  addRows(stated.nuisance, " (nuisance)", rows);
  return rows.empty() ? "" : makeTable(std::move(rows));
}

/// `quantities`: null where nothing is derived.
std::string makeTable(const Estimate& estimate, const std::vector<ParameterSpec>& parameters,
                      const DerivedQuantities* quantities) {
  return makeTable({estimate, deriveFrom(quantities, estimate), {}, {}}, parameters);
}

/// How the refinement went; the table of its estimate follows where it was accepted.
std::string describeRefined(const Refined& refined) {
  if (!refined.isAccepted()) {
    return fmt::format("  refinement rejected ({}): {}; unconfirmed quick estimate:\n",
                       toString(refined.status), refined.message);
  }
  return fmt::format("  refined in {} step{} ({} simulations), moved {:.2g} sd from the starting estimate:\n",
                     refined.iterations, refined.iterations == 1 ? "" : "s", refined.simulations,
                     refined.distance);
}

/// The components of a mixture, with what would tell them apart where nothing else comes first.
std::string describeMixture(const Mixture& mixture, const std::vector<ParameterSpec>& parameters,
                            bool misfits) {
  std::string text = "  multimodal, several parameter values may fit:\n";
  for (Index c = 0; c < mixture.countComponents(); ++c) {
    std::string values;
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      const auto i = static_cast<Index>(p);
      values += fmt::format("{}{} = {} +- {}", p == 0 ? "" : ", ", parameters[p].name.text,
                            toShortText(mixture.means(i, c), kEstimateDigits),
                            toShortText(mixture.stddevs(i, c), kStddevDigits));
    }
    if (std::round(100.0 * mixture.weights[c]) > 0.0) {
      text += fmt::format("    {:3.0f} %: {}\n", 100.0 * mixture.weights[c], values);
    }
  }
  return text + (misfits ? "" : fmt::format("    {}\n", getNotice(Notice::kMultimodal).remedy));
}

std::string describeDiagnostics(const PosteriorEstimate& posterior) {
  return fmt::format("effective sample size {:.0f}{}, Pareto shape {:.2f}", posterior.effective_sample_size,
                     posterior.evaluations > 0 ? fmt::format(" of {}", posterior.evaluations) : "",
                     posterior.pareto_shape);
}

/// How the simulator's posterior was found, where that limits it: the best fit by one search alone, or draws
/// so few (kMinPosteriorDraws) that the ends of 95 % intervals scatter by a fifth of an sd.
std::string describeSearches(const PosteriorEstimate& posterior) {
  const SimulatorFit& fit = *posterior.fit;
  std::string limits;
  if (fit.found_best < std::min(fit.searches, 2)) {
    limits += fmt::format(": best fit found by {} of {} searches", fit.found_best, fit.searches);
  }
  if (posterior.effective_sample_size < kMinPosteriorDraws) {
    limits += fmt::format("{} {} draws worth {:.0f} independent ones", limits.empty() ? ":" : ",",
                          posterior.evaluations, posterior.effective_sample_size);
  }
  return "  sampled on the simulator" + limits + "\n";
}

/// Whether an unreliable posterior says what happened alone: bounds that are to be widened are not to be
/// narrowed, nor is that said twice, and what disagrees comes first.
bool isBrief(const std::vector<std::string>& statuses) {
  constexpr Notice kOthers[] = {Notice::kAtBounds, Notice::kOutsideTraining, Notice::kMultimodal,
                                Notice::kTrialsDisagree};
  return isMismatch(statuses) || std::any_of(std::begin(kOthers), std::end(kOthers),
                                             [&](Notice notice) { return hasStatus(statuses, notice); });
}

/// "1 of m, L", of each ridge: so many that it does not determine.
std::string listUndetermined(const std::vector<Ridge>& ridges, const std::vector<ParameterSpec>& parameters) {
  std::string text;
  for (const Ridge& ridge : ridges) {
    text += fmt::format("{}{} of {}", text.empty() ? "" : " and ", ridge.dimension,
                        listParameters(ridge, parameters));
  }
  return text;
}

/// The simulator's: how it was found, or why it is not the estimate. The surrogate's: its own table.
std::string describePosterior(const InferredMeasurement& inferred, const Estimate& estimate, bool has_values,
                              const std::vector<ParameterSpec>& parameters) {
  const PosteriorEstimate& posterior = *inferred.posterior;
  const std::string diagnostics = describeDiagnostics(posterior);
  if (!posterior.isReliable() && posterior.fit) {
    const std::string why = fmt::format("{} ({}){}", posterior.message, diagnostics,
                                        has_values ? "; the values above do not rest on the draws" : "");
    return !posterior.fit->isSimulated() ? ""  // not_simulated says it
           : isBrief(estimate.statuses)
               ? explainBriefly(Notice::kUnreliable, why)
               : explainUnreliable(why, inferred.asked, listUndetermined(inferred.ridges, parameters));
  }
  if (!posterior.isReliable()) {
    return fmt::format("  no posterior: {} ({})\n", posterior.message, diagnostics);
  }
  if (posterior.fit) {
    return describeSearches(posterior);
  }
  return fmt::format(
             "  posterior under the surrogate ({}){}:\n", diagnostics,
             estimate.isRefined() ? ", for its shape; the refined estimate is the more accurate one" : "") +
         makeTable(posterior.estimate, parameters, inferred.quantities.get());
}

/// misfits: whether they are not explained, not by a fault of the recording either.
std::string describeSegments(const SegmentReport& segments, bool misfits) {
  std::string text =
      fmt::format("  {} segments of {} s, each with its own initial state ({} numbers, eliminated)\n",
                  segments.count, toShortText(segments.length, kFigureDigits), segments.states);
  if (misfits) {
    text += "    Of what is unstable or chaotic shorter segments may fit: --segments " +
            toShortText(0.5 * segments.length, kFigureDigits) + "\n";
  }
  return text;
}

/// The noise of outputs of which the file says that it is unknown.
std::string describeInferredNoise(const SimulatorFit& fit) {
  std::string text;
  for (const NoiseReport& report : fit.noise) {
    if (!report.isStated()) {
      text += fmt::format("  noise of {}: {}{}, inferred; the size of its residual is not tested\n",
                          report.output, toShortText(report.stddev, kStddevDigits),
                          report.unit.empty() ? "" : " " + report.unit);
    }
  }
  return text;
}

}  // namespace

std::string describeReading(const InferredMeasurement& inferred, const std::string& begin) {
  std::string text;
  for (const std::string& remark : inferred.remarks) {
    text += begin + remark + "\n";
  }
  for (const std::string& missing : inferred.left_out) {
    text += begin + "left out: " + missing + "\n";
  }
  return text;
}

std::string makeInferenceTable(const InferredMeasurement& inferred,
                               const std::vector<ParameterSpec>& parameters,
                               const std::vector<FeatureInfo>& features) {
  return describeTrust(inferred, parameters, features) + describeMapLimit(inferred, parameters) +
         describeEstimate(inferred, selectEstimate(inferred), parameters);
}

std::string describeEstimate(const InferredMeasurement& inferred, const Estimate& estimate,
                             const std::vector<ParameterSpec>& parameters) {
  const bool sampled = estimate.method == EstimationMethod::kPosterior;
  const DerivedQuantities* quantities = inferred.quantities.get();
  std::string text;
  if (inferred.posterior && inferred.posterior->fit) {
    text += describeInferredNoise(*inferred.posterior->fit);
  }
  if (inferred.segments) {
    text += describeSegments(*inferred.segments, isMismatch(estimate.statuses) && inferred.fault.empty());
  }
  if (inferred.prior) {
    text += "  prior: " + inferred.prior->text + "\n";
  }
  text += describeReading(inferred, "  ");
  if (inferred.refined && !sampled) {
    text += describeRefined(*inferred.refined);
  }
  const std::string table = makeTable(stateValues(inferred, estimate, parameters), parameters);
  text += table;
  for (const Ridge& ridge : inferred.ridges) {
    text += kIndent + describeRidge(ridge, parameters) + "\n";
  }
  if (estimate.isMultimodal()) {
    text += describeMixture(estimate.mixture, parameters, isMismatch(estimate.statuses));
  }
  if (inferred.by_estimator.isGiven() && (estimate.isRefined() || sampled)) {
    text += "  starting estimate (quick, not refined):\n" +
            makeTable(inferred.by_estimator, parameters, quantities);
  }
  if (inferred.posterior) {
    text += describePosterior(inferred, estimate, !table.empty(), parameters);
  }
  return text;
}

}  // namespace twinmap
