#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "framework/base/log/notice.hpp"
#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/estimation/estimate.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/estimation/posterior/noise/residual_test.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/inference/text/explain_notice.hpp"
#include "framework/inference/text/inference_text.hpp"
#include "kernels/linalg/autocorrelation.hpp"

namespace twinmap {

using Eigen::Index;

namespace {

constexpr std::size_t kShown = 4;  // by name, before what stands for the others
constexpr const char* kNoValuesFit = "no parameter values within the bounds fit";

std::string listBeyondBounds(const InferredMeasurement& inferred, const Estimate& estimate,
                             const std::vector<ParameterSpec>& parameters) {
  if (inferred.posterior && inferred.posterior->fit && !inferred.posterior->fit->beyond.empty()) {
    return listNames(inferred.posterior->fit->beyond);
  }
  std::vector<std::string> names;
  for (std::size_t p = 0; p < parameters.size() && estimate.isGiven(); ++p) {
    const double mean = estimate.mean[static_cast<Index>(p)];
    if (mean <= parameters[p].bounds.lower || mean >= parameters[p].bounds.upper) {
      names.push_back(parameters[p].name.text);
    }
  }
  return names.empty() ? "a nuisance parameter" : listNames(names);
}

/// "; so does r, which is derived from it": quantities that change with what lies at its bounds.
std::string describeDerivedAtBounds(const InferredMeasurement& inferred,
                                    const std::vector<ParameterSpec>& parameters) {
  const bool is_known = inferred.quantities && inferred.posterior && inferred.posterior->fit &&
                        inferred.posterior->fit->isSimulated();
  if (!is_known) {
    return "";
  }
  const SimulatorFit& fit = *inferred.posterior->fit;
  const auto p = static_cast<Index>(parameters.size());
  const Eigen::MatrixXd gradients = inferred.quantities->calcGradients(fit.best.head(p));
  std::vector<std::string> names;
  for (Index q = 0; q < gradients.rows(); ++q) {
    for (Index i = 0; i < p; ++i) {
      const std::string& name = parameters[static_cast<std::size_t>(i)].name.text;
      if (gradients(q, i) != 0.0 &&
          std::find(fit.beyond.begin(), fit.beyond.end(), name) != fit.beyond.end()) {
        names.push_back(inferred.quantities->getSpecs()[static_cast<std::size_t>(q)].name.text);
        break;
      }
    }
  }
  return names.empty() ? "" : "; it decides " + listNames(names) + " as well, derived from it";
}

std::string explainAtBounds(const InferredMeasurement& inferred, const Estimate& estimate,
                            const std::vector<ParameterSpec>& parameters) {
  std::string text = explainNotice(Notice::kAtBounds, listBeyondBounds(inferred, estimate, parameters));
  return text.insert(text.find('\n'), describeDerivedAtBounds(inferred, parameters));
}

/// Whether the best fit lies at the bounds of all parameters: these say nothing then.
bool areAllAtBounds(const InferredMeasurement& inferred, const std::vector<ParameterSpec>& parameters) {
  const auto lies_there = [&](const ParameterSpec& parameter) {
    const std::vector<std::string>& beyond = inferred.posterior->fit->beyond;
    return std::find(beyond.begin(), beyond.end(), parameter.name.text) != beyond.end();
  };
  return inferred.posterior && inferred.posterior->fit &&
         std::all_of(parameters.begin(), parameters.end(), lies_there);
}

/// Whether more excitation is not what helps a parameter. A ridge says what is determined of it, or its sd is
/// the estimator's, not what the measurement allows.
bool isForOthers(const InferredMeasurement& inferred, Index parameter) {
  const bool in_ridge = std::any_of(inferred.ridges.begin(), inferred.ridges.end(), [&](const Ridge& ridge) {
    return std::find(ridge.parameters.begin(), ridge.parameters.end(), parameter) != ridge.parameters.end();
  });
  const Eigen::VectorXd ratio = inferred.by_estimator.calcRatioToLimit();
  return in_ridge || (isEstimatorLimited(inferred) && ratio.size() > parameter &&
                      ratio[parameter] > kEstimatorLimitedRatio);
}

/// One explanation a parameter that is hardly better known than before.
std::string explainUninformative(const InferredMeasurement& inferred, const Estimate& estimate,
                                 const std::vector<ParameterSpec>& parameters) {
  const std::vector<std::string>& unused = inferred.unused;
  std::string text;
  for (std::size_t p = 0; p < parameters.size() && estimate.isGiven(); ++p) {
    const Bounds& bounds = parameters[p].bounds;
    const auto i = static_cast<Index>(p);
    const double before = estimate.prior_stddev.size() > 0 ? estimate.prior_stddev[i]
                                                           : kUniformStddev * (bounds.upper - bounds.lower);
    const double left = estimate.stddev[i] / before;
    const std::string& name = parameters[p].name.text;
    if (std::find(unused.begin(), unused.end(), name) != unused.end()) {
      text +=
          fmt::format("  {}: nothing uses {}\n    Name it in an expression of the system, or take it out.\n",
                      getNotice(Notice::kUninformative).name, name);
    } else if (left > kUninformativeShare) {
      const std::string reduced = fmt::format("{:.0f} %", 100.0 * std::max(0.0, 1.0 - left));
      text += isForOthers(inferred, i) ? explainBriefly(Notice::kUninformative, name, reduced)
                                       : explainNotice(Notice::kUninformative, name, reduced);
    }
  }
  return text;
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

/// "p = 0.61", or "p < 0.002" where no more can be told.
std::string describePValue(double p, double smallest) {
  return p <= smallest ? fmt::format("p < {:.2g}", smallest) : fmt::format("p = {:.2g}", p);
}

/// "x", of features named as x(0.1 s).
std::string nameOutput(int output, const std::vector<FeatureInfo>& features) {
  for (const FeatureInfo& feature : features) {
    if (feature.output == output) {
      return feature.name.substr(0, feature.name.find('('));
    }
  }
  return "";
}

/// Of residuals that are not independent.
std::string describeDependence(const ResidualTest& test, const std::vector<FeatureInfo>& features) {
  const bool alike = test.correlation > 0.0;
  const std::string name = nameOutput(test.output, features);
  const std::string of = name.empty() ? "" : " of " + name;
  if (test.lag > 1) {
    return fmt::format(
        "residuals{} that are {} samples apart {} (correlation {:.2f}): the noise swings, or the model lacks "
        "something small",
        of, test.lag, alike ? "are alike" : "are opposite", test.correlation);
  }
  return fmt::format("neighbouring residuals{} {} (correlation {:.2f}): {}", of,
                     alike ? "are alike" : "alternate", test.correlation,
                     alike ? "the noise is coloured, or the model lacks something small"
                           : "the signal was differentiated, or noise.correlation states more than there is");
}

/// Where the simulator's best point leaves more than noise, or how much.
std::string describeResidual(const SimulatorFit& fit, const std::vector<FeatureInfo>& features) {
  const ResidualTest& test = fit.test;
  const double largest = std::abs(fit.residual[test.largest]);
  const std::string& where = fit.largest_feature;
  if (test.largest_p <= std::min(test.chi_square_p, test.whiteness_p) &&
      largest * largest > kMostOfMisfit * fit.chi_square) {
    return fmt::format("{} is {:.3g} noise sd off, perhaps a spike", where, largest);
  }
  if (isGross(fit.chi_square, fit.degrees)) {
    return fmt::format("{}, the largest misfit is {:.3g} noise sd, in {}", kNoValuesFit, largest, where);
  }
  if (test.whiteness_p < test.chi_square_p) {
    return describeDependence(test, features);
  }
  if (test.largest_p < test.chi_square_p) {
    return fmt::format("{} is {:.3g} noise sd off, more than any of {} samples of noise would be", where,
                       largest, fit.residual.size());
  }
  return fmt::format("{}, chi-square is {:.2g} times what the stated noise leaves", kNoValuesFit,
                     fit.chi_square / fit.degrees);
}

/// How many times larger than stated the noise is, where the simulator's residuals look like noise; else 0.
double findNoiseFactor(const InferredMeasurement& inferred) {
  constexpr double kLargest = 5.0;  // of thousands of normal numbers none is beyond 5
  if (!inferred.posterior || !inferred.posterior->fit ||
      inferred.posterior->fit->residual.size() < kFewestTested) {
    return 0.0;
  }
  const SimulatorFit& fit = *inferred.posterior->fit;
  const double factor = std::sqrt(fit.residual.squaredNorm() / fit.degrees);
  const bool is_noise =
      fit.test.whiteness_p > kMismatchLevel && fit.residual.lpNorm<Eigen::Infinity>() < kLargest * factor;
  return is_noise && factor > 1.0 ? factor : 0.0;
}

/// "; coulomb.x would explain 93 % of it (dry friction: ...)"
std::string describeMissing(const InferredMeasurement& inferred) {
  const MissingTerm* missing = inferred.findMissing();
  return missing != nullptr ? fmt::format("; {} would explain {:.0f} % of it ({})", missing->term,
                                          100.0 * missing->share, missing->meaning)
                            : "";
}

bool isMismatch(const std::optional<Trust>& trust) {
  return trust && std::find(trust->statuses.begin(), trust->statuses.end(), TrustStatus::kModelMismatch) !=
                      trust->statuses.end();
}

/// The place of what a trust model finds beyond noise: all over, or in one stretch beside which the rest
/// fits.
std::string describeTrusted(const Trust& trust, const std::vector<FeatureInfo>& features) {
  const bool fits_beside = trust.chi_square_p_value >= kMismatchLevel;
  return fmt::format("{}, {}", fits_beside ? "all but one stretch of the recording fits" : kNoValuesFit,
                     describeAnomaly(trust, features));
}

std::string explainMismatch(const InferredMeasurement& inferred, const std::vector<ParameterSpec>& parameters,
                            const std::vector<FeatureInfo>& features) {
  if (!inferred.fault.empty()) {
    return explainBriefly(Notice::kModelMismatch, inferred.fault + " (this explains 99 % of the misfit)");
  }
  if (const double factor = findNoiseFactor(inferred); factor > 0.0) {
    return explainBriefly(
        Notice::kModelMismatch,
        fmt::format(
            "the residuals look like noise {:.3g} times as large as stated; measure it (twinmap noise)",
            factor));
  }
  const std::string where = isMismatch(inferred.trust) ? describeTrusted(*inferred.trust, features)
                                                       : describeResidual(*inferred.posterior->fit, features);
  const bool all = areAllAtBounds(inferred, parameters);
  const std::string happened =
      (all ? "the best fit lies at the bounds of all parameters: " : "") + where + describeMissing(inferred);
  return inferred.asked.diagnoses ? explainBriefly(Notice::kModelMismatch, happened)
                                  : explainNotice(Notice::kModelMismatch, happened);
}

/// The samples that are left out, the first of them by name.
std::string explainOutliers(const std::vector<std::string>& outliers) {
  const std::size_t shown = std::min(kShown, outliers.size());
  return explainNotice(
      Notice::kOutliers,
      outliers.size() == 1 ? "1 sample is" : fmt::format("{} samples are", outliers.size()),
      fmt::format("{}{}", fmt::join(outliers.begin(), outliers.begin() + static_cast<Index>(shown), ", "),
                  outliers.size() > kShown ? " ..." : ""));
}

/// With the term of the model that would explain the recording as well.
std::string explainNuisance(const InferredMeasurement& inferred) {
  const RecordingNuisance& nuisance = *inferred.nuisance;
  const MissingTerm* term = inferred.findMissing();
  const bool other = term != nullptr && term->share > kMostOfMisfit && !nuisance.isAlike(term->term);
  return explainNotice(
      nuisance.notice,
      fmt::format("{}{}", nuisance.text,
                  other ? fmt::format(", or the model lacks {} ({}), which explains {:.0f} % of the misfit",
                                      term->term, term->meaning, 100.0 * term->share)
                        : ""));
}

/// "neighbouring samples have a correlation of 0.61", of the lag where it is largest.
std::string describeColour(const Eigen::VectorXd& autoregression) {
  const std::vector<double> coefficients(autoregression.begin(), autoregression.end());
  const auto correlation = calcAutocorrelation(coefficients, kMostLags);
  Index lag = 1;
  for (Index k = 2; k <= kMostLags; ++k) {
    lag = std::abs(correlation[k]) > std::abs(correlation[lag]) ? k : lag;
  }
  return fmt::format("{} have a correlation of {:.2f}",
                     lag == 1 ? "neighbouring samples" : fmt::format("samples {} apart", lag),
                     correlation[lag]);
}

/// Of each output whose noise is coloured, or has an offset.
std::string explainNoise(const std::vector<NoiseReport>& noise, bool offsets) {
  std::string text;
  for (const NoiseReport& report : noise) {
    const FoundNoise& found = report.found;
    const std::string unit = report.unit.empty() ? "" : " " + report.unit;
    if (offsets && found.has_offset) {
      text +=
          explainNotice(Notice::kSensorOffset, report.output, toShortText(found.offset, kStddevDigits) + unit,
                        toShortText(found.offset_stddev, kStddevDigits) + unit);
    }
    if (!offsets && found.autoregression.size() > 0) {
      text += explainNotice(Notice::kNoiseColoured, report.output, describeColour(found.autoregression));
    }
  }
  return text;
}

/// The posterior is not advised that is there already.
std::string explainUncalibrated(const InferredMeasurement& inferred) {
  if (!inferred.posterior) {
    return explainNotice(Notice::kUncalibrated);
  }
  const std::string other =
      inferred.posterior->fit ? "" : "    Sample the simulator's posterior: --posterior-from simulator.\n";
  return explainBriefly(Notice::kUncalibrated) + other;
}

/// By the parameter that scatters most.
std::string explainDisagreement(const std::vector<ScatterEstimate>& scatter,
                                const std::vector<ParameterSpec>& parameters) {
  const auto most = std::max_element(scatter.begin(), scatter.end(),
                                     [](const auto& a, const auto& b) { return a.ratio < b.ratio; });
  const std::string& name = parameters[static_cast<std::size_t>(most - scatter.begin())].name.text;
  return explainNotice(
      Notice::kTrialsDisagree, most->degrees + 1, describePValue(calcScatterPValue(*most), kSameNumber),
      fmt::format("{} scatters by {:.3g} of its sds, which the interval covers", name, most->ratio));
}

/// "" of those that are explained with the numbers they concern: makeInferenceTable().
std::string explainStatus(const std::string& status, const InferredMeasurement& inferred,
                          const Estimate& estimate, const std::vector<ParameterSpec>& parameters,
                          const std::vector<FeatureInfo>& features) {
  const NoticeText& said = getStatus(status);
  if (said.concern == Concern::kNuisance) {
    return explainNuisance(inferred);
  }
  switch (said.notice) {
    case Notice::kModelMismatch:
      return explainMismatch(inferred, parameters, features);
    case Notice::kMissingTerm:
      return explainMissingTerm(*inferred.findMissing(), parameters);
    case Notice::kOutsideTraining:
      return explainNotice(Notice::kOutsideTraining, inferred.trust->distance);
    case Notice::kAtBounds:
      return explainAtBounds(inferred, estimate, parameters);
    case Notice::kUninformative:
      return explainUninformative(inferred, estimate, parameters);
    case Notice::kOutliers:
      return explainOutliers(inferred.posterior->fit->outliers);
    case Notice::kNoiseLarger:
    case Notice::kNoiseSmaller:
      return explainNotice(said.notice, inferred.posterior->fit->getNoiseFactor());
    case Notice::kNoiseColoured:
    case Notice::kSensorOffset:
      return explainNoise(inferred.posterior->fit->noise, said.notice == Notice::kSensorOffset);
    case Notice::kUncalibrated:
      return explainUncalibrated(inferred);
    case Notice::kTrialsDisagree:
      return explainDisagreement(inferred.scatter, parameters);
    case Notice::kPosteriorUncalibrated:
      return explainNotice(Notice::kPosteriorUncalibrated, inferred.posterior->doubt);
    case Notice::kNotSimulated:
      return explainNotice(Notice::kNotSimulated, inferred.posterior->message);
    default:
      return "";
  }
}

/// The lines that say what happened alone: what follows from a misfit is not mended by itself.
std::string dropRemedies(const std::string& explained) {
  std::istringstream lines(explained);
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    text += line.rfind("    ", 0) == 0 ? "" : line + "\n";
  }
  return text;
}

/// Whether the residual is tested with noise, spikes or a nuisance other than stated.
bool isOtherThanStated(const InferredMeasurement& inferred, const SimulatorFit& fit) {
  return !fit.outliers.empty() || fit.getNoiseFactor() != 1.0 || fit.isColoured() || fit.hasOffset() ||
         inferred.nuisance.has_value();
}

/// "with that " of what the statuses say of the noise, or that it is another.
const char* describeCondition(const InferredMeasurement& inferred, const std::vector<std::string>& statuses) {
  if (!isOtherThanStated(inferred, *inferred.posterior->fit)) {
    return "";
  }
  return std::any_of(statuses.begin(), statuses.end(),
                     [](const std::string& status) { return getStatus(status).concern != Concern::kOther; })
             ? "with that "
             : "with other noise than stated ";
}

/// The statuses with the numbers that they follow from.
std::string describeJudgement(const InferredMeasurement& inferred, const std::vector<std::string>& listed) {
  const std::string statuses = joinStatuses(listed, ", ");
  if (inferred.trust) {
    const Trust& trust = *inferred.trust;
    return fmt::format("{} (chi-square {:.4g} of {} residuals, {})", statuses, trust.chi_square,
                       trust.residuals, describePValue(trust.p_value, trust.smallest_p_value));
  }
  if (!inferred.posterior || !inferred.posterior->fit) {
    return statuses + (statuses.empty() ? "" : "; ") + "not judged (the run has no trust model)";
  }
  const SimulatorFit& fit = *inferred.posterior->fit;
  return fit.isSimulated() ? fmt::format("{} ({}chi-square {:.4g} of {:.4g} degrees of freedom, {})",
                                         statuses, describeCondition(inferred, listed), fit.chi_square,
                                         fit.degrees, describePValue(fit.test.calcPValue(), kSameNumber))
                           : statuses;
}

}  // namespace

std::string describeTrust(const InferredMeasurement& inferred, const std::vector<ParameterSpec>& parameters,
                          const std::vector<FeatureInfo>& features) {
  const Estimate estimate = selectEstimate(inferred);
  const std::string window = inferred.asked.starts.empty() ? "" : " from " + toText(inferred.start) + " s";
  std::string text = inferred.source + window + ": " + describeJudgement(inferred, estimate.statuses) + "\n";
  for (const std::string& against : inferred.against) {
    text += "  " + against + "\n";
  }
  return text + explainStatuses(inferred, estimate, parameters, features);
}

std::string explainStatuses(const InferredMeasurement& inferred, const Estimate& estimate,
                            const std::vector<ParameterSpec>& parameters,
                            const std::vector<FeatureInfo>& features,
                            const std::map<std::string, std::string>& own) {
  std::string text;
  const bool misfits = isMismatch(estimate.statuses);
  if (estimate.statuses == std::vector<std::string>{getNotice(Notice::kOk).name}) {
    text += describeUnnoticed(inferred.model_test, parameters);
  }
  for (const std::string& status : estimate.statuses) {
    const auto found = own.find(status);
    const std::string explained =
        found != own.end() ? found->second : explainStatus(status, inferred, estimate, parameters, features);
    const bool is_first = status == getNotice(Notice::kModelMismatch).name ||
                          (status == getNotice(Notice::kAtBounds).name && inferred.fault.empty() &&
                           areAllAtBounds(inferred, parameters));
    if ((!misfits || is_first) && !isAdvisedElse(status, estimate.statuses)) {
      text += explained;
    } else if (inferred.fault.empty() || status == getNotice(Notice::kAtBounds).name) {
      text += dropRemedies(explained);
    }
  }
  return fillCommands(std::move(text), inferred.asked);
}

std::string explainFaults(const std::string& status, const LabelledMeasurements& recordings) {
  std::string text, remedy;
  std::size_t found = 0;
  for (const auto& [label, inferred] : recordings) {
    const Estimate estimate = selectEstimate(*inferred);
    if (std::count(estimate.statuses.begin(), estimate.statuses.end(), status) == 0 || ++found > kShown) {
      continue;
    }
    const std::string explained = explainStatus(status, *inferred, estimate, {}, {});
    const std::string happened = dropRemedies(explained), name = "  " + status + ": ";
    text += name + label + ": " + happened.substr(name.size());
    remedy = remedy.empty() ? explained.substr(explained.find('\n') + 1) : remedy;
  }
  if (found > kShown) {
    text += fmt::format("  {}: and so {} of the {} recordings\n", status, found, recordings.size());
  }
  return text + remedy;
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
                            : explainNotice(Notice::kEstimatorLimited, listNames(far));
  }
  return fmt::format(
      "  estimator_limited: the error estimate of the fast model is unreliable "
      "(cross-validation)\n{}",
      inferred.refined ? "" : "    Refine the estimate: --refine.\n");
}

}  // namespace twinmap
