#include <fmt/format.h>

#include <algorithm>

#include "framework/base/json/json.hpp"
#include "framework/base/log/notice.hpp"
#include "framework/base/text/escape.hpp"
#include "framework/base/text/nearest_name.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/text_tables.hpp"
#include "framework/inference/joint/joint_inference.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/inference/text/explain_notice.hpp"
#include "framework/inference/text/inference_text.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr int kJointDigits = 6, kJointStddevDigits = 3;

/// A parameter's estimate from all recordings: the posterior's, or that of recordings that scatter.
ScatterEstimate takeEstimate(const JointInference& inferred, std::size_t parameter) {
  if (!inferred.scatter.empty()) {
    return inferred.scatter[parameter];
  }
  const auto i = static_cast<Index>(parameter);
  const MatrixXd quantiles = inferred.joint.calcQuantiles(Eigen::Vector2d(0.025, 0.975));
  return {inferred.joint.mean[i], inferred.joint.stddev[i], quantiles(i, 0), quantiles(i, 1), 0.0};
}

bool isStated(const JointInference& inferred) {
  return inferred.agreement && (!inferred.scatter.empty() || inferred.joint.isReliable());
}

/// "0.34", "< 0.0005" where the simulations can say no more.
std::string describeLevel(const Agreement& agreement) {
  return agreement.isAtFloor() ? fmt::format("p < {:.2g}", agreement.p_value)
                               : fmt::format("p = {:.2g}", agreement.p_value);
}

std::string describeContradictions(const JointInference& inferred,
                                   const std::vector<ParameterSpec>& parameters) {
  constexpr double kShown = 2.0;
  std::string text;
  for (const Contradiction& one : inferred.contradictions) {
    if (one.distance < kShown) {
      break;
    }
    const auto i = static_cast<Index>(one.parameter);
    const SimulatorPosterior &first = inferred.alone[one.first].posterior,
                             &second = inferred.alone[one.second].posterior;
    text += fmt::format(
        "  {} contradicts {} in {} by {:.3g} sd: {} +- {}, {} +- {} {}\n", inferred.alone[one.first].label,
        inferred.alone[one.second].label, parameters[one.parameter].name.text, one.distance,
        toShortText(first.mean[i], kJointDigits), toShortText(first.stddev[i], kJointStddevDigits),
        toShortText(second.mean[i], kJointDigits), toShortText(second.stddev[i], kJointStddevDigits),
        parameters[one.parameter].unit);
  }
  return text;
}

/// misfits: the remedy has been given for these.
std::string describeAgreement(const JointInference& inferred, const std::vector<ParameterSpec>& parameters,
                              bool misfits) {
  const std::size_t count = inferred.alone.size();
  const Agreement& agreement = *inferred.agreement;
  if (!inferred.disagrees()) {
    return fmt::format("  The {} recordings agree ({}).\n", count, describeLevel(agreement));
  }
  const std::string text =
      misfits ? explainBriefly(Notice::kTrialsDisagree, count, describeLevel(agreement), agreement.excess)
              : explainNotice(Notice::kTrialsDisagree, count, describeLevel(agreement), agreement.excess);
  return text + describeContradictions(inferred, parameters) +
         (inferred.scatter.empty() ? "" : "  The intervals below cover the scatter between recordings.\n");
}

/// Of recordings that the model does not fit each by itself.
std::string describeMisfits(const JointInference& inferred) {
  std::vector<std::string> labels;
  for (const RecordingInference& one : inferred.alone) {
    if (isMismatch(selectEstimate(one.inferred).statuses)) {
      labels.push_back(one.label);
    }
  }
  return labels.empty() ? ""
                        : explainNotice(Notice::kModelMismatch,
                                        fmt::format("{} misfit{} already alone", fmt::join(labels, ", "),
                                                    labels.size() == 1 ? "s" : ""));
}

std::string makeEstimateTable(const JointInference& inferred, const std::vector<ParameterSpec>& parameters) {
  std::vector<std::vector<std::string>> rows{{"parameter", "unit", "mean", "sd", "95 % interval"}};
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const ScatterEstimate estimate = takeEstimate(inferred, p);
    rows.push_back(
        {parameters[p].name.text, parameters[p].unit, toShortText(estimate.mean, kJointDigits),
         toShortText(estimate.stddev, kJointStddevDigits),
         toShortText(estimate.lower, kJointDigits) + " .. " + toShortText(estimate.upper, kJointDigits)});
  }
  return alignRows(rows, rows.front().size(), "  ");
}

std::string makeAloneTable(const JointInference& inferred, const std::vector<ParameterSpec>& parameters) {
  std::vector<std::vector<std::string>> rows{{"alone", "status"}};
  for (const ParameterSpec& parameter : parameters) {
    rows.front().push_back(parameter.name.text);
  }
  for (std::size_t k = 0; k < inferred.alone.size(); ++k) {
    const RecordingInference& one = inferred.alone[k];
    rows.push_back({one.label + (one.posterior.is_linear ? ", linear" : ""),
                    selectEstimate(one.inferred).statuses.front()});
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      const auto i = static_cast<Index>(p);
      rows.back().push_back(one.posterior.isReliable()
                                ? toShortText(one.posterior.mean[i], kJointDigits) + " +- " +
                                      toShortText(one.posterior.stddev[i], kJointStddevDigits)
                                : "-");
    }
  }
  return alignRows(rows, rows.front().size(), "  ");
}

Json makeEstimateJson(const JointInference& inferred, const std::vector<ParameterSpec>& parameters) {
  Json json = Json::object();
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const ScatterEstimate estimate = takeEstimate(inferred, p);
    json[parameters[p].name.text] = {{"mean", estimate.mean},
                                     {"sd", estimate.stddev},
                                     {"lower", estimate.lower},
                                     {"upper", estimate.upper},
                                     {"unit", parameters[p].unit}};
    if (!inferred.scatter.empty()) {
      json[parameters[p].name.text]["scatter"] = estimate.scatter;
    }
  }
  return json;
}

/// Of the parameters in their units: the posterior's, or the variances of recordings that scatter.
Json makeJointCovariance(const JointInference& inferred, std::size_t count) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < count; ++i) {
    Json row = Json::array();
    for (std::size_t j = 0; j < count; ++j) {
      const double variance =
          i == j && !inferred.scatter.empty() ? inferred.scatter[i].stddev * inferred.scatter[i].stddev : 0.0;
      row.push_back(inferred.scatter.empty()
                        ? inferred.joint.covariance(static_cast<Index>(i), static_cast<Index>(j))
                        : variance);
    }
    rows.push_back(row);
  }
  return rows;
}

Json makeTrialsJson(const JointInference& inferred, const std::vector<ParameterSpec>& parameters) {
  Json trials = Json::array();
  for (const RecordingInference& recording : inferred.alone) {
    Json one = parseJson(makeInferenceJson(recording.inferred, parameters, {}));
    one["label"] = recording.label;
    one["is_linear"] = recording.posterior.is_linear;
    trials.push_back(one);
  }
  return trials;
}

std::string describeFaults(const JointInference& inferred, const std::vector<std::string>& listed) {
  LabelledMeasurements recordings;
  for (const RecordingInference& one : inferred.alone) {
    recordings.emplace_back(one.label, &one.inferred);
  }
  std::string text;
  for (const std::string& fault : listRecordingFaults(inferred.alone)) {
    const bool is_said =
        std::find(listed.begin(), listed.end(), fault) != listed.end() && !isAdvisedElse(fault, listed);
    text += is_said ? explainFaults(fault, recordings) : "";
  }
  return text;
}

}  // namespace

std::string makeJointTable(const JointInference& inferred, const std::vector<ParameterSpec>& parameters) {
  const std::vector<std::string> listed = listStatuses(inferred, static_cast<Index>(parameters.size()));
  const std::string statuses = joinStatuses(listed, ", ");
  std::string text = fmt::format("{} recordings together: {}\n", inferred.alone.size(), statuses);
  if (!inferred.agreement) {
    return fillCommands(text + explainNotice(Notice::kNotSimulated, inferred.joint.message), inferred.asked);
  }
  if (listed == std::vector<std::string>{getNotice(Notice::kOk).name}) {
    text += describeUnnoticed(inferred.model_test, parameters);
  } else if (hasStatus(listed, Notice::kMissingTerm)) {
    text += fillCommands(explainMissingTerm(*inferred.findMissing(), parameters), inferred.asked);
  }
  // each recording alone is tested at a level of its own: what all together take for chance is not said
  const bool misfits = isMismatch(listed);
  if (!inferred.beyond.empty()) {
    text += misfits || isAdvisedElse(getNotice(Notice::kAtBounds).name, listed)
                ? explainBriefly(Notice::kAtBounds, listNames(inferred.beyond))
                : explainNotice(Notice::kAtBounds, listNames(inferred.beyond));
  }
  text += fillCommands(
      (misfits ? describeMisfits(inferred) : "") + describeAgreement(inferred, parameters, misfits),
      inferred.asked);
  text += describeFaults(inferred, listed);
  if (isStated(inferred)) {
    text += makeEstimateTable(inferred, parameters);
  } else {
    text += misfits || inferred.disagrees() || !inferred.beyond.empty()
                ? explainBriefly(Notice::kUnreliable, inferred.joint.message)
                : explainUnreliable(inferred.joint.message, inferred.asked);
  }
  text += makeAloneTable(inferred, parameters);
  for (const RecordingInference& one : inferred.alone) {
    text += describeReading(one.inferred, "  " + one.label + ": ");
  }
  return text + fmt::format("  sampled on the simulator: {} simulations\n", inferred.simulations);
}

std::string makeJointCsvRows(const JointInference& inferred, const std::vector<ParameterSpec>& parameters) {
  std::string text;
  for (const RecordingInference& one : inferred.alone) {
    text += makeInferenceCsvRows(one.inferred, parameters, false);
  }
  const std::string statuses =
      fmt::format("{}", fmt::join(listStatuses(inferred, static_cast<Index>(parameters.size())), " "));
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    std::string numbers = ",,,";
    if (isStated(inferred)) {
      const ScatterEstimate estimate = takeEstimate(inferred, p);
      numbers = toText(estimate.mean) + "," + toText(estimate.stddev) + "," + toText(estimate.lower) + "," +
                toText(estimate.upper);
    }
    text += fmt::format("joint,,{},{},{},{},{},posterior\n", escapeCsv(parameters[p].name.text),
                        escapeCsv(parameters[p].unit), numbers, statuses,
                        inferred.agreement ? toText(inferred.agreement->p_value) : "");
  }
  return text;
}

std::string makeJointJson(const JointInference& inferred, const std::vector<ParameterSpec>& parameters) {
  const std::vector<std::string> statuses = listStatuses(inferred, static_cast<Index>(parameters.size()));
  Json json{{"source", "joint"},
            {"status", statuses.front()},
            {"statuses", statuses},
            {"method", inferred.scatter.empty() ? "posterior" : "scatter"}};
  if (isStated(inferred)) {
    json["parameters"] = makeEstimateJson(inferred, parameters);
    json["covariance"] = makeJointCovariance(inferred, parameters.size());
  } else {
    json["message"] = inferred.joint.message;
  }
  json["effective_sample_size"] = inferred.joint.effective_sample_size;
  json["pareto_shape"] = inferred.joint.pareto_shape;
  if (inferred.agreement) {
    json["agreement"] = {{"agrees", !inferred.disagrees()},
                         {"p_value", inferred.agreement->p_value},
                         {"excess", inferred.agreement->excess},
                         {"contradictions", Json::array()}};
    for (const Contradiction& one : inferred.contradictions) {
      json["agreement"]["contradictions"].push_back({{"parameter", parameters[one.parameter].name.text},
                                                     {"first", inferred.alone[one.first].label},
                                                     {"second", inferred.alone[one.second].label},
                                                     {"distance", one.distance}});
    }
  }
  addModelTest(inferred.model_test, parameters, json);
  json["trials"] = makeTrialsJson(inferred, parameters);
  json["simulations"] = inferred.simulations;
  return formatJson(json);
}

}  // namespace twinmap
