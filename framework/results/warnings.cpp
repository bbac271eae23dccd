#include "framework/results/warnings.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "framework/base/log/notice.hpp"
#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

constexpr const char* kDone = "Nothing need be done: the estimates are refined.";

/// A remedy that is not given beside a notice.
struct Beside {
  const char* remedy;
  Notice notice;
};

constexpr Beside kBeside[] = {
    // it cannot be done, or was, and did not help
    {"Refine the estimates", Notice::kCannotRefine},
    {"Refine the estimates", Notice::kNoLimit},  // without noise
    {"Refine the estimates", Notice::kFewRefined},
    {kDone, Notice::kIntervalsTooNarrow},
    {kDone, Notice::kAboveLimit},
    {kDone, Notice::kPosteriorDiffers},
    // the test samples have said that they do not hold
    {"Nothing need be done; the run's test samples say", Notice::kIntervalsTooNarrow},
    // a surrogate is not advised whose errors are large or not known
    {"Use the surrogate itself", Notice::kSurrogateUncalibrated},
    {"Use the surrogate itself", Notice::kTeacherFar},
    // many more samples than the few hundred that hardly help
    {"Refine the estimates instead of adding samples", Notice::kTeacherFar},
};

/// Where the remedy that begins so stands in a text; npos where it does not.
std::size_t findRemedy(const std::string& text, const std::string& remedy) {
  return text.find("\n  " + remedy);
}

void markRefined(std::vector<Warning>& warnings) {
  for (Warning& warning : warnings) {
    const std::size_t remedy = findRemedy(warning.text, "Refine the estimates");
    if (remedy != std::string::npos) {
      warning.text = warning.text.substr(0, remedy) + "\n  " + kDone;
    }
  }
}

/// Takes away the remedies of a run's warnings that go against another one, or that have been taken.
/// are_refined: whether nearly all estimates are refined.
void mendRemedies(std::vector<Warning>& warnings, bool are_refined) {
  if (are_refined) {
    markRefined(warnings);
  }
  for (const Beside& beside : kBeside) {
    const bool is_said = std::any_of(warnings.begin(), warnings.end(), [&](const Warning& warning) {
      return saysNotice(warning.text, beside.notice);
    });
    for (Warning& warning : warnings) {
      const std::size_t remedy = is_said ? findRemedy(warning.text, beside.remedy) : std::string::npos;
      if (remedy != std::string::npos) {
        warning.text.resize(remedy);
      }
    }
  }
}

/// "k (0.71), c (0.8)" of the parameters for which number(p) is to be given; "" of none.
template <class Number, class IsTold>
std::string listParameters(const RunSummary& run, const Number& number, const IsTold& is_told) {
  constexpr int kDigits = 2;
  std::vector<std::string> told;
  for (std::size_t p = 0; p < run.parameters.size(); ++p) {
    if (is_told(p)) {
      told.push_back(run.parameters[p].name.text + " (" + toShortText(number(p), kDigits) + ")");
    }
  }
  return listNames(told);
}

/// Parameters whose errors are in % of their range, because their bounds contain 0.
void appendRelativeToRange(const RunSummary& run, std::vector<Warning>& warnings) {
  std::vector<std::string> names;
  for (const ParameterSpec& parameter : run.parameters) {
    if (parameter.relative_to == RelativeTo::kAutomatic && isRelativeToRange(parameter)) {
      names.push_back(parameter.name.text);
    }
  }
  if (!names.empty()) {
    warnings.push_back(makeWarning(Notice::kRelativeToRange, listNames(names)));
  }
}

/// Whether the estimates are those of the simulator, of which the estimator's are only the start.
bool areRefined(const RunSummary& run) {
  constexpr double kNearlyAll = 0.9;
  return std::any_of(run.evaluation.methods.begin(), run.evaluation.methods.end(),
                     [](const MethodSummary& summary) {
                       return summary.method == "refined" &&
                              double(summary.accepted) >= kNearlyAll * double(summary.samples);
                     });
}

/// The one thing to do about errors that are larger than they need be. Refinement that was tried is not.
std::string adviseOnAccuracy(const RunSummary& run) {
  const bool was_tried =
      std::any_of(run.evaluation.methods.begin(), run.evaluation.methods.end(),
                  [](const MethodSummary& summary) { return summary.method == "refined"; });
  return was_tried ? "Compare with the sampled posterior of a measurement: twinmap infer --posterior."
                   : "Refine the estimates on the simulator: refine=always.";
}

/// 95 % intervals that hold too few or too many true values: further from 0.95 than three standard errors.
void appendCoverage(const RunSummary& run, std::vector<Warning>& warnings) {
  constexpr double kNominal = 0.95, kErrors = 3.0;
  const auto coverage = [&](std::size_t p) { return run.evaluation.metrics[p].coverage95; };
  const auto band = [&](std::size_t p) {
    return kErrors * std::sqrt(kNominal * (1.0 - kNominal) / run.evaluation.metrics[p].samples);
  };
  const std::string narrow =
      listParameters(run, coverage, [&](std::size_t p) { return coverage(p) < kNominal - band(p); });
  const std::string wide =
      listParameters(run, coverage, [&](std::size_t p) { return coverage(p) > kNominal + band(p); });
  if (!narrow.empty()) {
    warnings.push_back(makeWarning(Notice::kIntervalsTooNarrow, narrow, adviseOnAccuracy(run)));
  }
  if (!wide.empty()) {
    warnings.push_back(makeWarning(Notice::kIntervalsTooWide, wide));
  }
}

/// The share of the first answers that are several, which lie apart.
double calcSeveralShare(const RunSummary& run, std::size_t p) {
  constexpr std::size_t kMax = 200;
  const std::vector<Mixture>& mixtures = run.evaluation.predictions.mixtures;
  const std::size_t count = std::min(mixtures.size(), kMax);
  const Eigen::VectorXd& weights = run.evaluation.predictions.weights;
  double several = 0.0, all = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double weight = weights.size() > 0 ? weights[Index(i)] : 1.0;
    all += weight;
    several += weight > 0.0 && isMultimodal(takeMarginal(mixtures[i], Index(p))) ? weight : 0.0;
  }
  return all > 0.0 ? several / all : 0.0;
}

/// Whether errors and standard deviations are those between several modes, mostly.
bool isMultimodal(const RunSummary& run, std::size_t p) {
  constexpr double kMostly = 0.1;
  return calcSeveralShare(run, p) > kMostly;
}

void appendSeveral(const RunSummary& run, std::vector<Warning>& warnings) {
  const auto share = [&](std::size_t p) { return calcSeveralShare(run, p); };
  const std::string listed = listParameters(run, share, [&](std::size_t p) { return isMultimodal(run, p); });
  if (!listed.empty()) {
    warnings.push_back(makeWarning(Notice::kMultimodalTests, listed));
  }
}

/// Whether the errors are mostly the estimator's own, not what the measurement leaves.
bool isFarFromLimit(const RunSummary& run, std::size_t p) {
  constexpr double kFar = 1.5;
  return run.evaluation.metrics[p].ratio_to_limit > kFar && !isMultimodal(run, p);
}

void appendLimit(const RunSummary& run, std::vector<Warning>& warnings) {
  const auto ratio = [&](std::size_t p) { return run.evaluation.metrics[p].ratio_to_limit; };
  const std::string far = listParameters(run, ratio, [&](std::size_t p) { return isFarFromLimit(run, p); });
  if (!far.empty()) {
    warnings.push_back(makeWarning(Notice::kAboveLimit, far, adviseOnAccuracy(run)));
  }
}

/// Whether errors would fall with more simulations, where the answers are a map's and not near the limit: as
/// little as they fell when the simulations were doubled.
void appendGain(const RunSummary& run, std::vector<Warning>& warnings) {
  constexpr double kLittle = 0.7, kNearLimit = 1.1, kPercent = 100.0;
  if (!run.training.cross_validation || run.training.cross_validation->half == 0 || areRefined(run)) {
    return;
  }
  const CrossValidation& found = *run.training.cross_validation;
  std::vector<std::string> told;
  for (std::size_t p = 0; p < run.parameters.size(); ++p) {
    const double left = found.error_ratio[Index(p)];
    if (found.limit_ratio[Index(p)] >= kNearLimit && left > kLittle) {
      told.push_back(
          fmt::format("{} ({:.0f} %)", run.parameters[p].name.text, kPercent * std::max(0.0, 1.0 - left)));
    }
  }
  if (!told.empty()) {
    warnings.push_back(makeWarning(Notice::kMoreSamplesHardlyHelp, found.half, found.all, listNames(told)));
  }
}

/// Whether the information limit has already warned that the parameter is not determined.
bool isUndetermined(const RunSummary& run, std::size_t p) {
  return run.evaluation.identifiability && run.evaluation.identifiability->isUndetermined(Index(p));
}

/// Inferred standard deviations close to that of the prior: nothing was learnt, though the estimator is as
/// good as the measurement.
void appendUninformed(const RunSummary& run, std::vector<Warning>& warnings) {
  constexpr double kUninformed = 0.7, kPercent = 100.0;
  const auto share = [&](std::size_t p) {
    const auto stddev = run.evaluation.predictions.stddev.row(Index(p));
    const Bounds& bounds = run.parameters[p].bounds;
    const double before = run.evaluation.prior_stddev.size() > 0
                              ? run.evaluation.prior_stddev[Index(p)]
                              : kUniformStddev * (bounds.upper - bounds.lower);
    return std::sqrt(stddev.squaredNorm() / double(stddev.size())) / before;
  };
  std::vector<std::string> uninformed;
  for (std::size_t p = 0; p < run.parameters.size(); ++p) {
    if (share(p) > kUninformed && !isUndetermined(run, p) && !isMultimodal(run, p) &&
        !isFarFromLimit(run, p)) {
      uninformed.push_back(fmt::format("{} ({:.0f} %)", run.parameters[p].name.text,
                                       kPercent * std::max(0.0, 1.0 - share(p))));
    }
  }
  if (!uninformed.empty()) {
    warnings.push_back(makeWarning(Notice::kDataUninformative, listNames(uninformed)));
  }
}

void appendCorrelations(const RunSummary& run, std::vector<Warning>& warnings) {
  constexpr double kInseparable = 0.95;
  constexpr int kDigits = 3;
  if (!run.evaluation.identifiability) {
    return;
  }
  const Eigen::MatrixXd& correlation = run.evaluation.identifiability->correlation;
  std::vector<std::string> pairs;
  for (std::size_t row = 0; row < run.parameters.size(); ++row) {
    for (std::size_t other = 0; other < row; ++other) {
      const double value = correlation(Index(row), Index(other));
      if (std::abs(value) > kInseparable && !isUndetermined(run, row) && !isUndetermined(run, other)) {
        pairs.push_back(fmt::format("{} and {} ({})", run.parameters[other].name.text,
                                    run.parameters[row].name.text, toShortText(value, kDigits)));
      }
    }
  }
  if (!pairs.empty()) {
    warnings.push_back(makeWarning(Notice::kCorrelated, listNames(pairs)));
  }
}

void appendFailures(const RunSummary& run, std::vector<Warning>& warnings) {
  const std::size_t failed = run.failures.size();
  if (failed > 0) {
    warnings.push_back(makeWarning(Notice::kSamplesFailed, failed));
  }
}

/// Without the length scales at their upper bound: these merely say that an input is irrelevant.
std::string dropLongLengthScales(const std::string& at_bound) {
  std::string kept;
  std::istringstream items(at_bound);
  for (std::string item; std::getline(items, item, ';');) {
    item.erase(0, item.find_first_not_of(' '));
    const bool is_long = item.rfind("length_scale", 0) == 0 && item.find("upper bound") != std::string::npos;
    kept += is_long ? "" : (kept.empty() ? "" : "; ") + item;
  }
  return kept;
}

void appendTraining(const RunSummary& run, std::vector<Warning>& warnings) {
  std::vector<std::string> at_bound;
  for (const TrainingStart& start : run.training.starts) {
    if (!start.best) {
      continue;
    }
    const std::string kept = dropLongLengthScales(start.at_bound);
    if (!kept.empty()) {
      at_bound.push_back(start.parameter + " (" + kept + ")");
    }
  }
  if (!at_bound.empty()) {
    warnings.push_back(makeWarning(Notice::kHyperparametersAtBound, listNames(at_bound)));
  }
}

}  // namespace

std::vector<std::string> collectWarnings(const RunSummary& run) {
  std::vector<Warning> warnings;
  appendFailures(run, warnings);
  appendCoverage(run, warnings);
  warnings.insert(warnings.end(), run.notes.warnings.begin(), run.notes.warnings.end());
  appendLimit(run, warnings);
  appendUninformed(run, warnings);
  appendSeveral(run, warnings);
  appendCorrelations(run, warnings);
  appendTraining(run, warnings);
  appendGain(run, warnings);
  appendRelativeToRange(run, warnings);
  mendRemedies(warnings, areRefined(run));
  return listTexts(std::move(warnings));
}

}  // namespace twinmap
