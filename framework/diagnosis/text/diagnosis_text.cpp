#include "framework/diagnosis/text/diagnosis_text.hpp"

#include <fmt/format.h>

#include <cmath>

#include "framework/base/log/notice.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/text_tables.hpp"
#include "framework/diagnosis/problem/score_test.hpp"
#include "framework/diagnosis/remainder/residual_noise.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/inference/text/inference_text.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// "; speed at which friction sets in s = 0.01 m/s"
std::string describeOwnScales(const TermCandidate& candidate) {
  std::string text;
  for (const OwnScale& scale : candidate.own_scales) {
    text += fmt::format("; {} {} {}", scale.meaning, toShortText(scale.value, 3), scale.unit);
  }
  return text;
}

/// "k -3.2, d +41": the parameters that move by more than half a standard deviation, or "none".
std::string describeShifts(const VectorXd& shifts, const std::vector<ParameterSpec>& parameters) {
  std::string text;
  for (Index i = 0; i < shifts.size(); ++i) {
    if (std::abs(shifts[i]) > kNoticeable) {
      text += fmt::format("{}{} {:+.2g}", text.empty() ? "" : ", ",
                          parameters[static_cast<std::size_t>(i)].name.text, shifts[i]);
    }
  }
  return text.empty() ? "none" : text;
}

/// An estimate and its standard deviation, as cells.
void addEstimate(const VectorXd& mean, const VectorXd& stddev, Index i, std::vector<std::string>& row) {
  row.push_back(i < mean.size() ? toShortText(mean[i], kEstimateDigits) : "-");
  row.push_back(i < mean.size() ? toShortText(stddev[i], kStddevDigits) : "-");
}

/// "a force on x of sd 0.03 N, which changes within 0.1 s (log evidence 57.0)"
std::string describeSize(const Remainder& remainder) {
  return fmt::format("{} of sd {} {}, which changes within {} s (log evidence {:.1f}){}", remainder.what,
                     toShortText(remainder.stddev, kRoughDigits), remainder.unit,
                     toShortText(remainder.correlation_time, kRoughDigits), remainder.log_evidence,
                     remainder.rivals.empty()
                         ? ""
                         : fmt::format(", or as {}: these recordings do not tell them apart",
                                       fmt::join(remainder.rivals, ", ")));
}

std::string describeOutside(const Remainder& remainder, const std::vector<ParameterSpec>& parameters) {
  const Index outside = remainder.findOutside(parameters);
  return outside < 0 ? ""
                     : fmt::format(" It would move {} out of its bounds: no estimate.",
                                   parameters[static_cast<std::size_t>(outside)].name.text);
}

/// What it is, and the parameters with it.
std::string makeProcessText(const std::string& what, const Remainder& remainder,
                            const std::vector<ParameterSpec>& parameters) {
  const TextRows rows = listRemainderRows(remainder, parameters);
  const std::string with =
      remainder.rivals.empty() ? " With it:\n" : " With one of them, weighted by evidence:\n";
  return "  " + what + (rows.empty() ? "\n" : with + alignRows(rows, 2, "  "));
}

/// Why no candidate was found.
std::string describeNone(const DiagnosisStep& step, double level) {
  const TermFinding& best = step.ranked.front();
  if (!(best.p_value < level)) {
    return fmt::format(
        "None of {} candidates found (|z| above {:.2f} would be, by chance in {:g} % of models)", step.tested,
        calcCriticalZ(level, step.tested), 100.0 * level);
  }
  const char* reason = !best.fitted ? "no fit with it succeeded"
                       : best.log_evidence > 0.0
                           ? "not out of what remains with it, which is not noise either"
                           : "a fit with it explains no more than its freedom would of noise";
  return fmt::format("None of {} candidates found: {} stands out (z {:+.1f}), but {}", step.tested,
                     best.candidate.term, best.z, reason);
}

}  // namespace

std::string describeFit(const ExplainedFit& fit) {
  return fmt::format("chi-square {} of {:.0f} degrees of freedom, {}",
                     toShortText(fit.posterior.chi_square, kFigureDigits), fit.posterior.degrees,
                     fit.isExplained() ? "explained by the noise" : "model_mismatch");
}

std::string describeBefore(const Diagnosis& diagnosis) {
  const SimulatorPosterior& before = diagnosis.before.posterior;
  return diagnosis.found > 0 && diagnosis.before.isExplained()
             ? fmt::format(
                   "chi-square {} of {:.0f} degrees of freedom, within the noise by its size, but a "
                   "missing term stands out",
                   toShortText(before.chi_square, kFigureDigits), before.degrees)
             : describeFit(diagnosis.before);
}

std::string describeNoise(const Diagnosis& diagnosis) {
  const std::string sizes = describeSizes(diagnosis.corrected.noise, diagnosis.noise);
  return sizes.empty() ? "" : "Noise as the residual has it: sd " + sizes;
}

std::string describeBounds(const Diagnosis& diagnosis) {
  const std::vector<std::string> names = diagnosis.listAtBounds();
  return names.empty() ? ""
                       : fmt::format(
                             "The best fit lies at the bounds of {}: widen them first, as terms may make up "
                             "for bounds that are too narrow.",
                             fmt::join(names, ", "));
}

std::string describeRemainder(const Diagnosis& diagnosis) {
  return "What remains is as " + describeSize(*diagnosis.remainder) + "." +
         describeOutside(*diagnosis.remainder, diagnosis.corrected.model.parameters);
}

std::string describeProcess(const Diagnosis& diagnosis) {
  return fmt::format(
             "A random process explains {}: it is as {}. Wind, ground motion or the chatter of a drive are "
             "such.",
             diagnosis.process_ties
                 ? "as much as all terms found, and these recordings do not tell them apart"
                 : "more than all terms found",
             describeSize(*diagnosis.process)) +
         describeOutside(*diagnosis.process, diagnosis.corrected.model.parameters);
}

TextRows listTermRows(const DiagnosisStep& step, const std::vector<ParameterSpec>& parameters) {
  constexpr std::size_t kShownRivals = 3;  // of a place, beside those that are tied
  TextRows rows{
      {"of", "term", "size", "sd", "unit", "z", "explains", "log evidence", "parameters move (sd)"}};
  for (const TermPlace place :
       {TermPlace::kMachine, TermPlace::kStart, TermPlace::kInputs, TermPlace::kSensors}) {
    std::size_t rivals = 0;
    for (std::size_t i = 0; i < step.ranked.size(); ++i) {
      const TermFinding& one = step.ranked[i];
      if (one.candidate.place == place && (i < step.tied || rivals++ < kShownRivals)) {
        rows.push_back({getName(place), one.candidate.term, toShortText(one.estimate, kFigureDigits),
                        toShortText(one.stddev, kRoughDigits), one.candidate.unit,
                        fmt::format("{:+.1f}", one.z), fmt::format("{:.0f} %", 100.0 * one.share),
                        fmt::format("{:.1f}", one.log_evidence), describeShifts(one.shifts, parameters)});
      }
    }
  }
  return rows;
}

TextRows listParameterRows(const Diagnosis& diagnosis) {
  const SimulatorPosterior &before = diagnosis.before.posterior, &after = diagnosis.after.posterior;
  const AveragedEstimate& averaged = diagnosis.averaged;
  TextRows rows{{"parameter", "unit", "before", "sd", "after", "sd"}};
  const std::vector<ParameterSpec>& parameters = diagnosis.corrected.model.parameters;
  const auto shared = static_cast<Index>(diagnosis.shared);
  for (Index i = 0; i < static_cast<Index>(parameters.size()); ++i) {
    const ParameterSpec& parameter = parameters[static_cast<std::size_t>(i)];
    rows.push_back({parameter.name.text, parameter.unit});
    addEstimate(before.mean, before.stddev, i < shared ? i : before.mean.size(), rows.back());
    const bool is_averaged = i < shared && averaged.isGiven();
    addEstimate(is_averaged ? averaged.mean : after.mean, is_averaged ? averaged.stddev : after.stddev, i,
                rows.back());
  }
  return rows;
}

TextRows listRemainderRows(const Remainder& remainder, const std::vector<ParameterSpec>& parameters) {
  if (remainder.findOutside(parameters) >= 0) {
    return {};
  }
  TextRows rows{{"parameter", "unit", "effective", "sd"}};
  for (Index i = 0; i < remainder.mean.size(); ++i) {
    const ParameterSpec& parameter = parameters[static_cast<std::size_t>(i)];
    rows.push_back({parameter.name.text, parameter.unit});
    addEstimate(remainder.mean, remainder.stddevs, i, rows.back());
  }
  return rows;
}

std::string describeStep(const DiagnosisStep& step, std::size_t number, double level) {
  const TermFinding& best = step.ranked.front();
  std::string text;
  if (step.found) {
    text = fmt::format("{}. missing: {}\n  {}{}\n", number, best.candidate.term, best.candidate.meaning,
                       describeOwnScales(best.candidate));
    if (step.partner) {
      text += fmt::format("  and with it: {}\n  {}{}\n  size {} {} (sd {})\n", step.partner->candidate.term,
                          step.partner->candidate.meaning, describeOwnScales(step.partner->candidate),
                          toShortText(step.partner->estimate, kFigureDigits), step.partner->candidate.unit,
                          toShortText(step.partner->stddev, kRoughDigits));
    }
    for (const std::string& term : step.dropped) {
      text += fmt::format("  superfluous now: {}\n", term);
    }
    for (const TermRival& one : step.rivals) {
      text +=
          fmt::format(one.took_over ? "  {} takes the place of {}\n"
                                    : "  or {} in the place of {}: these recordings do not tell them apart\n",
                      one.rival, one.term);
    }
    for (std::size_t i = 1; i < step.tied; ++i) {
      text += fmt::format("  or: {}\n  {}{}\n", step.ranked[i].candidate.term,
                          step.ranked[i].candidate.meaning, describeOwnScales(step.ranked[i].candidate));
    }
    if (step.tied > 1) {
      text += fmt::format("  These recordings do not tell them apart; {}.\n", step.advice);
    }
  } else {
    text = describeNone(step, level) + "\n";
  }
  return text;
}

std::string makeDiagnosisTable(const Diagnosis& diagnosis, const std::string& source) {
  const std::vector<ParameterSpec>& parameters = diagnosis.corrected.model.parameters;
  std::string text = fmt::format("{}: {}\n", source, describeBefore(diagnosis));
  for (const std::string& line : {describeNoise(diagnosis), describeBounds(diagnosis)}) {
    text += line.empty() ? "" : line + "\n";
  }
  LabelledMeasurements recordings;
  for (const RecordingInference& one : diagnosis.alone) {
    recordings.emplace_back(one.label, &one.inferred);
  }
  for (const std::string& fault : diagnosis.listFaults()) {
    text += explainFaults(fault, recordings);
  }
  text +=
      diagnosis.process ? makeProcessText(describeProcess(diagnosis), *diagnosis.process, parameters) : "";
  for (std::size_t i = 0; i < diagnosis.steps.size(); ++i) {
    if (!diagnosis.steps[i].ranked.empty()) {
      text += describeStep(diagnosis.steps[i], i + 1, diagnosis.level) +
              alignRows(listTermRows(diagnosis.steps[i], parameters), 1, "    ");
    }
  }
  if (diagnosis.found > 0 || diagnosis.is_coloured) {
    text += fmt::format("With {}: {}\n",
                        diagnosis.is_coloured        ? "coloured noise"
                        : diagnosis.terms.size() > 1 ? "these terms"
                                                     : "this term",
                        describeFit(diagnosis.after));
    if (!diagnosis.after.posterior.isReliable()) {
      text += fmt::format("  No estimate: {}.\n", diagnosis.after.posterior.message);
    }
    text += alignRows(listParameterRows(diagnosis), 2, "  ");
    if (const auto names = diagnosis.listTermsAtBounds(); !names.empty()) {
      text += fmt::format(
          "  {} at the end of what was searched: widen these bounds in the corrected file (--out).\n",
          fmt::join(names, ", "));
    }
    if (diagnosis.averaged.models > 1) {
      text +=
          "  The parameters are those with each of the terms that are not told apart, weighted by "
          "evidence.\n";
    }
  }
  if (diagnosis.isIncomplete()) {
    text += fmt::format("{}: {}\n", diagnosis.getStatus(), describeNotice(Notice::kModelIncomplete));
    text += diagnosis.remainder
                ? makeProcessText(describeRemainder(diagnosis), *diagnosis.remainder, parameters)
                : "";
  }
  return text;
}

std::string makeBlindSpotTable(const std::vector<BlindSpot>& spots,
                               const std::vector<ParameterSpec>& parameters) {
  std::vector<std::vector<std::string>> rows{{"term", "noticed from", "unit", "parameters by then (sd)"}};
  for (const BlindSpot& spot : spots) {
    const bool is_seen = std::isfinite(spot.noticed);
    const std::vector<OwnScale>& scales = spot.candidate.own_scales;
    const std::string scale =
        scales.empty() ? ""
                       : fmt::format(" ({} {})", toShortText(scales.front().value, 3), scales.front().unit);
    rows.push_back({spot.candidate.term + scale, is_seen ? toShortText(spot.noticed, 3) : "never",
                    spot.candidate.unit, is_seen ? describeShifts(spot.shifts, parameters) : "-"});
  }
  return alignRows(rows, 1);
}

}  // namespace twinmap
