#include "framework/inference/inference_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "framework/inference/answer.hpp"
#include "framework/inverse_map/predictions.hpp"
#include "framework/results/aligned_rows.hpp"
#include "framework/results/escape.hpp"
#include "framework/spec/parameter_box.hpp"
#include "framework/spec/yaml/nearest_name.hpp"
#include "framework/spec/yaml/number_text.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

std::string joinStatuses(const InferredMeasurement& inferred, const char* separator) {
  std::string joined;
  for (const std::string& status : listStatuses(inferred)) {
    joined += (joined.empty() ? "" : separator) + status;
  }
  return joined;
}

/// What is wrong, in words; one line each.
std::string explainStatus(TrustStatus status, const Trust& trust, const std::vector<FeatureInfo>& features) {
  switch (status) {
    case TrustStatus::kModelMismatch:
      return fmt::format("  No point of the parameter box explains the features: {}.\n",
                         describeBurst(trust, features));
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

Row makeRow(const ParameterSpec& parameter, double mean, double stddev) {
  constexpr int kDigits = 6, kStddevDigits = 3;
  return {parameter.name.text, parameter.unit, toShortText(mean, kDigits), toShortText(stddev, kStddevDigits),
          fmt::format("{} .. {}", toShortText(mean - kNormal95 * stddev, kDigits),
                      toShortText(mean + kNormal95 * stddev, kDigits))};
}

/// How the refinement went; the table of its answer follows where it was accepted.
std::string describeRefined(const Refined& refined) {
  if (!refined.isAccepted()) {
    return fmt::format("  not refined ({}): {}; the map's answer, which nothing confirms:\n",
                       toString(refined.status), refined.message);
  }
  return fmt::format("  refined by {} steps ({} simulations), {:.2g} sd from the map's:\n",
                     refined.iterations, refined.simulations, refined.distance);
}

std::string makeEstimateTable(const Eigen::VectorXd& mean, const Eigen::VectorXd& stddev,
                              const std::vector<ParameterSpec>& parameters) {
  std::vector<Row> rows{{"parameter", "unit", "mean", "sd", "95 % interval"}};
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const auto i = static_cast<Index>(p);
    rows.push_back(makeRow(parameters[p], mean[i], stddev[i]));
  }
  return alignRows(rows, rows.front().size(), kIndent);
}

}  // namespace

std::string describeTrust(const InferredMeasurement& inferred, const std::vector<FeatureInfo>& features) {
  if (!inferred.trust) {
    const std::string statuses = joinStatuses(inferred, ", ");
    return inferred.source + ": " + statuses + (statuses.empty() ? "" : "; ") +
           "not judged (the run has no trust model)\n";
  }
  const Trust& trust = *inferred.trust;
  std::string text =
      fmt::format("{}: {} (p = {:.2g}, chi-square {:.1f} of {} residuals)\n", inferred.source,
                  joinStatuses(inferred, ", "), trust.p_value, trust.chi_square, trust.residuals);
  for (const TrustStatus status : trust.statuses) {
    text += explainStatus(status, trust, features);
  }
  return text;
}

std::string describeBurst(const Trust& trust, const std::vector<FeatureInfo>& features) {
  const Burst& burst = trust.burst;
  if (burst.first + burst.count > static_cast<Index>(features.size())) {
    return "";
  }
  const std::string& first = features[static_cast<std::size_t>(burst.first)].name;
  const std::string& last = features[static_cast<std::size_t>(burst.first + burst.count - 1)].name;
  return "it is worst at " + (burst.count == 1 ? first : first + " to " + last);
}

std::string describeMapLimit(const InferredMeasurement& inferred,
                             const std::vector<ParameterSpec>& parameters) {
  if (!isMapLimited(inferred)) {
    return "";
  }
  const char* advice = inferred.refined ? "add simulations" : "refine, or add simulations";
  const Eigen::VectorXd ratio = calcRatioToLimit(inferred.inference);
  std::vector<std::string> far;
  for (Index p = 0; p < ratio.size(); ++p) {
    if (ratio[p] > kMapLimitedRatio) {
      far.push_back(
          fmt::format("{} is {:.2g} times", parameters[static_cast<std::size_t>(p)].name.text, ratio[p]));
    }
  }
  std::string text =
      far.empty() ? "" : fmt::format("  {} above what the measurement allows: {}.\n", listNames(far), advice);
  if (!inferred.map_is_honest) {
    text += fmt::format("  The map does not know its own errors (cross-validation): {}.\n", advice);
  }
  return text;
}

std::string makeInferenceTable(const InferredMeasurement& inferred,
                               const std::vector<ParameterSpec>& parameters,
                               const std::vector<FeatureInfo>& features) {
  const Inference& by_map = inferred.inference;
  const Answer answer = chooseAnswer(inferred);
  std::string text = describeTrust(inferred, features) + describeMapLimit(inferred, parameters);
  if (inferred.refined) {
    text += describeRefined(*inferred.refined);
  }
  text += makeEstimateTable(answer.mean, answer.stddev, parameters);
  if (answer.refined) {
    text += "  the map's:\n" + makeEstimateTable(by_map.mean, by_map.stddev, parameters);
  }
  return text;
}

std::string makeInferenceCsvHeader(bool refined) {
  return std::string("source,start,parameter,unit,mean,sd,lower,upper,status,p_value") +
         (refined ? ",refined_mean,refined_sd,map_mean,map_sd" : "") + "\n";
}

std::string makeInferenceCsvRows(const InferredMeasurement& inferred,
                                 const std::vector<ParameterSpec>& parameters) {
  const Answer answer = chooseAnswer(inferred);
  const Inference& by_map = inferred.inference;
  std::string text;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const auto i = static_cast<Index>(p);
    const double mean = answer.mean[i], stddev = answer.stddev[i];
    text += fmt::format("{},{},{},{},{},{},{},{},{},{}", escapeCsv(inferred.source), toText(inferred.start),
                        escapeCsv(parameters[p].name.text), escapeCsv(parameters[p].unit), toText(mean),
                        toText(stddev), toText(mean - kNormal95 * stddev), toText(mean + kNormal95 * stddev),
                        joinStatuses(inferred, " "), inferred.trust ? toText(inferred.trust->p_value) : "");
    if (inferred.refined) {
      text += answer.refined ? fmt::format(",{},{}", toText(mean), toText(stddev)) : ",,";
      text += fmt::format(",{},{}", toText(by_map.mean[i]), toText(by_map.stddev[i]));
    }
    text += "\n";
  }
  return text;
}

}  // namespace twinmap
