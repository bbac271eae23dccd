#include <fmt/format.h>

#include <map>

#include "framework/base/json/json.hpp"
#include "framework/base/log/notice.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/text_tables.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/joint/joint_inference.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/inference/text/explain_notice.hpp"
#include "framework/inference/text/inference_text.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// With what was found and asked later.
InferredMeasurement takeTogether(const JointInference& inferred) {
  InferredMeasurement together = inferred.together;
  together.asked = inferred.asked;
  together.model_test = inferred.model_test;
  return together;
}

/// Of recordings that scatter: what the next one would say, as a model that lacks something is as wrong of
/// their mean as of any of them. Independent, with the intervals of so few, within the bounds.
Estimate combineEstimate(const JointInference& inferred, const std::vector<ParameterSpec>& parameters) {
  const auto p = static_cast<Index>(parameters.size());
  Estimate estimate{VectorXd(p), VectorXd(p)};
  estimate.correlation = MatrixXd::Identity(p, p);
  estimate.limits = {VectorXd(p), VectorXd(p)};
  estimate.estimator = "scatter";
  estimate.interval_factors = {MatrixXd(p, 1), MatrixXd(p, 1)};
  for (Index i = 0; i < p; ++i) {
    const ScatterEstimate& one = inferred.scatter[static_cast<std::size_t>(i)];
    estimate.mean[i] = one.mean;
    estimate.stddev[i] = one.calcStddevOfNext();
    estimate.limits.lower[i] = one.bounds.lower;
    estimate.limits.upper[i] = one.bounds.upper;
    estimate.interval_factors.set(i, 0, one.calcFactor());
  }
  return estimate;
}

/// The posterior's, or that of recordings that scatter.
Estimate selectEstimate(const JointInference& inferred, const InferredMeasurement& together,
                        const std::vector<ParameterSpec>& parameters) {
  const bool scatters = inferred.disagrees() && !inferred.scatter.empty();
  Estimate estimate = scatters ? combineEstimate(inferred, parameters) : selectEstimate(together);
  estimate.statuses = listStatuses(inferred, static_cast<Index>(parameters.size()));
  return estimate;
}

/// "0.34", "< 0.0005" where the simulations can say no more.
std::string describeLevel(const Agreement& agreement) {
  return agreement.isAtFloor() ? fmt::format("p < {:.2g}", agreement.p_value)
                               : fmt::format("p = {:.2g}", agreement.p_value);
}

std::string describeContradictions(const JointInference& inferred,
                                   const std::vector<ParameterSpec>& parameters) {
  std::string text;
  for (const Contradiction& one : inferred.contradictions) {
    if (one.distance < kNormal95) {
      break;
    }
    const auto i = static_cast<Index>(one.parameter);
    const SimulatorPosterior &first = inferred.alone[one.first].posterior,
                             &second = inferred.alone[one.second].posterior;
    text += fmt::format(
        "  {} contradicts {} in {} by {:.3g} sd: {} +- {}, {} +- {} {}\n", inferred.alone[one.first].label,
        inferred.alone[one.second].label, parameters[one.parameter].name.text, one.distance,
        toShortText(first.mean[i], kEstimateDigits), toShortText(first.stddev[i], kStddevDigits),
        toShortText(second.mean[i], kEstimateDigits), toShortText(second.stddev[i], kStddevDigits),
        parameters[one.parameter].unit);
  }
  return text;
}

/// "  coulomb.x would explain 93 % of all that is beyond noise (dry friction: ...)"
std::string describeMissing(const JointInference& inferred) {
  const MissingTerm* missing = inferred.findMissing();
  return missing != nullptr ? fmt::format("  {} would explain {:.0f} % of all that is beyond noise ({})\n",
                                          missing->term, 100.0 * missing->share, missing->meaning)
                            : "";
}

/// misfits: what is missing is said of these.
std::string explainDisagreement(const JointInference& inferred, const std::vector<ParameterSpec>& parameters,
                                bool misfits) {
  return explainNotice(Notice::kTrialsDisagree, inferred.alone.size(), describeLevel(*inferred.agreement),
                       fmt::format("together they fit worse than each alone, by {:.4g} of chi-square",
                                   inferred.agreement->excess)) +
         describeContradictions(inferred, parameters) + (misfits ? "" : describeMissing(inferred)) +
         (inferred.scatter.empty() ? "" : "  The intervals below cover the scatter between recordings.\n");
}

/// Of recordings that the model does not fit each by itself.
std::string explainMisfits(const JointInference& inferred) {
  std::vector<std::string> labels;
  for (const RecordingInference& one : inferred.alone) {
    if (isMismatch(listStatuses(one.inferred))) {
      labels.push_back(one.label);
    }
  }
  return labels.empty() ? ""
                        : explainNotice(Notice::kModelMismatch,
                                        fmt::format("{} misfit{} already alone", fmt::join(labels, ", "),
                                                    labels.size() == 1 ? "s" : "")) +
                              describeMissing(inferred);
}

/// What several recordings alone have to be said against them, by status.
std::map<std::string, std::string> explainSeveral(const JointInference& inferred,
                                                  const std::vector<ParameterSpec>& parameters) {
  const std::string misfits = explainMisfits(inferred);
  std::map<std::string, std::string> texts{
      {getNotice(Notice::kModelMismatch).name, misfits},
      {getNotice(Notice::kNotSimulated).name, explainNotice(Notice::kNotSimulated, inferred.joint.message)}};
  if (inferred.disagrees()) {
    texts[getNotice(Notice::kTrialsDisagree).name] =
        explainDisagreement(inferred, parameters, !misfits.empty());
  }
  LabelledMeasurements recordings;
  for (const RecordingInference& one : inferred.alone) {
    recordings.emplace_back(one.label, &one.inferred);
  }
  for (const std::string& fault : listRecordingFaults(inferred.alone)) {
    texts[fault] = explainFaults(fault, recordings);
  }
  return texts;
}

std::string makeAloneTable(const JointInference& inferred, const std::vector<ParameterSpec>& parameters) {
  std::vector<std::vector<std::string>> rows{{"alone", "status"}};
  for (const ParameterSpec& parameter : parameters) {
    rows.front().push_back(parameter.name.text);
  }
  for (const RecordingInference& one : inferred.alone) {
    rows.push_back(
        {one.label + (one.posterior.is_linear ? ", linear" : ""), listStatuses(one.inferred).front()});
    const Estimate estimate = selectEstimate(one.inferred);
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      const auto i = static_cast<Index>(p);
      rows.back().push_back(one.posterior.isReliable()
                                ? toShortText(estimate.mean[i], kEstimateDigits) + " +- " +
                                      toShortText(estimate.stddev[i], kStddevDigits)
                                : "-");
    }
  }
  if (!inferred.scatter.empty()) {
    rows.push_back({"scatter over sd", ""});
    for (const ScatterEstimate& one : inferred.scatter) {
      rows.back().push_back(toShortText(one.ratio, kRoughDigits));
    }
  }
  return alignRows(rows, rows.front().size(), "  ");
}

Json makeAgreementJson(const JointInference& inferred, const std::vector<ParameterSpec>& parameters) {
  Json json{{"agrees", !inferred.disagrees()},
            {"p_value", inferred.agreement->p_value},
            {"excess", inferred.agreement->excess},
            {"contradictions", Json::array()}};
  for (const Contradiction& one : inferred.contradictions) {
    json["contradictions"].push_back({{"parameter", parameters[one.parameter].name.text},
                                      {"first", inferred.alone[one.first].label},
                                      {"second", inferred.alone[one.second].label},
                                      {"distance", one.distance}});
  }
  return json;
}

Json makeTrialsJson(const JointInference& inferred, const std::vector<ParameterSpec>& parameters) {
  Json trials = Json::array();
  for (const RecordingInference& recording : inferred.alone) {
    Json one = makeAnswerJson(recording.inferred, selectEstimate(recording.inferred), parameters, {});
    one["label"] = recording.label;
    one["is_linear"] = recording.posterior.is_linear;
    trials.push_back(one);
  }
  return trials;
}

}  // namespace

std::string makeJointTable(const JointInference& inferred, const std::vector<ParameterSpec>& parameters) {
  const InferredMeasurement together = takeTogether(inferred);
  const Estimate estimate = selectEstimate(inferred, together, parameters);
  std::string text =
      fmt::format("{} recordings together: {}\n", inferred.alone.size(),
                  joinStatuses(estimate.statuses, ", ")) +
      explainStatuses(together, estimate, parameters, {}, explainSeveral(inferred, parameters));
  if (!inferred.agreement) {
    return text;
  }
  if (!inferred.disagrees()) {
    text += fmt::format("  The {} recordings agree ({}).\n", inferred.alone.size(),
                        describeLevel(*inferred.agreement));
  }
  text += describeEstimate(together, estimate, parameters) + makeAloneTable(inferred, parameters);
  for (const RecordingInference& one : inferred.alone) {
    text += describeReading(one.inferred, "  " + one.label + ": ");
  }
  return text;
}

std::string makeJointCsvRows(const JointInference& inferred, const std::vector<ParameterSpec>& parameters) {
  std::string text;
  for (const RecordingInference& one : inferred.alone) {
    text += makeInferenceCsvRows(one.inferred, parameters, false);
  }
  const InferredMeasurement together = takeTogether(inferred);
  return text + makeAnswerCsvRows(together, selectEstimate(inferred, together, parameters),
                                  inferred.agreement ? toText(inferred.agreement->p_value) : "", parameters,
                                  false);
}

std::string makeJointJson(const JointInference& inferred, const std::vector<ParameterSpec>& parameters) {
  const InferredMeasurement together = takeTogether(inferred);
  Json json = makeAnswerJson(together, selectEstimate(inferred, together, parameters), parameters, {});
  for (std::size_t p = 0; p < inferred.scatter.size(); ++p) {
    Json& one = json["parameters"][parameters[p].name.text];
    one["scatter_over_sd"] = inferred.scatter[p].ratio;
    if (inferred.disagrees()) {
      one["scatter"] = inferred.scatter[p].scatter;
    }
  }
  if (!inferred.joint.message.empty()) {
    json["message"] = inferred.joint.message;
  }
  json["effective_sample_size"] = inferred.joint.effective_sample_size;
  json["pareto_shape"] = inferred.joint.pareto_shape;
  if (inferred.agreement) {
    json["agreement"] = makeAgreementJson(inferred, parameters);
  }
  json["trials"] = makeTrialsJson(inferred, parameters);
  json["simulations"] = inferred.simulations;
  return formatJson(json);
}

}  // namespace twinmap
