#include <cmath>

#include "framework/base/json/json.hpp"
#include "framework/diagnosis/remainder/residual_noise.hpp"
#include "framework/diagnosis/text/diagnosis_text.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/inference/text/inference_text.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Name -> mean, sd, the ends of the 95 % interval and unit, of the first `count`. quantiles: of all, 2.5 %
/// and 97.5 %.
Json makeMoments(const VectorXd& mean, const VectorXd& stddev, const Eigen::MatrixXd& quantiles,
                 const std::vector<ParameterSpec>& parameters, std::size_t count) {
  Json json;
  for (std::size_t p = 0; p < count; ++p) {
    const auto i = static_cast<Index>(p);
    json[parameters[p].name.text] = {{"mean", mean[i]},
                                     {"sd", stddev[i]},
                                     {"lower", quantiles(i, 0)},
                                     {"upper", quantiles(i, 1)},
                                     {"unit", parameters[p].unit}};
  }
  return json;
}

Json makeScalesJson(const TermCandidate& candidate) {
  Json json = Json::array();
  for (const OwnScale& own : candidate.own_scales) {
    json.push_back({{"meaning", own.meaning}, {"value", own.value}, {"unit", own.unit}});
  }
  return json;
}

Json makeFindingJson(const TermFinding& finding, const std::vector<ParameterSpec>& parameters) {
  Json json{{"term", finding.candidate.term},
            {"meaning", finding.candidate.meaning},
            {"of", getName(finding.candidate.place)},
            {"size", finding.estimate},
            {"sd", finding.stddev},
            {"unit", finding.candidate.unit},
            {"z", finding.z},
            {"p_value", finding.p_value},
            {"log_evidence", finding.log_evidence},
            {"share", finding.share},
            {"chi_square", finding.chi_square},
            {"fitted", finding.fitted},
            {"shifts", nameValues(finding.shifts, parameters)}};
  if (!std::isfinite(finding.log_evidence)) {
    json["log_evidence"] = nullptr;  // the fit with it failed
  }
  if (!finding.candidate.own_scales.empty()) {
    json["own_scales"] = makeScalesJson(finding.candidate);
  }
  return json;
}

Json makeStepJson(const DiagnosisStep& step, const std::vector<ParameterSpec>& parameters) {
  Json json{{"chi_square", step.chi_square},
            {"degrees", step.degrees},
            {"tested", step.tested},
            {"found", step.found},
            {"tied", step.found ? step.tied : 0},
            {"candidates", Json::array()}};
  if (step.partner) {
    json["partner"] = makeFindingJson(*step.partner, parameters);
  }
  if (!step.dropped.empty()) {
    json["dropped"] = step.dropped;
  }
  for (const TermRival& one : step.rivals) {
    json["rivals"].push_back({{"term", one.term}, {"rival", one.rival}, {"took_over", one.took_over}});
  }
  if (!step.advice.empty()) {
    json["advice"] = step.advice;
  }
  for (const TermFinding& finding : step.ranked) {
    json["candidates"].push_back(makeFindingJson(finding, parameters));
  }
  return json;
}

Json makeFitJson(const ExplainedFit& fit, const std::vector<ParameterSpec>& parameters, std::size_t count) {
  const SimulatorPosterior& posterior = fit.posterior;
  Json json{{"chi_square", posterior.chi_square},
            {"degrees", posterior.degrees},
            {"p_value", fit.test.calcPValue()},
            {"explained", fit.isExplained()}};
  if (!posterior.isReliable()) {
    json["message"] = posterior.message;
    return json;
  }
  json["parameters"] = makeMoments(posterior.mean, posterior.stddev,
                                   posterior.calcQuantiles(Eigen::Vector2d(0.025, 0.975)), parameters, count);
  return json;
}

/// The noise of outputs for which it is unknown.
Json makeNoiseJson(const Diagnosis& diagnosis) {
  Json json = Json::object();
  const std::vector<OutputNoiseSpec>& stated = diagnosis.corrected.noise.stddev;
  for (std::size_t i = 0; i < stated.size(); ++i) {
    if (stated[i].stddev.unknown) {
      json[stated[i].name.text] = diagnosis.noise.stddev[i].stddev.value;
    }
  }
  return json;
}

Json makeRemainderJson(const Remainder& remainder, const std::vector<ParameterSpec>& parameters) {
  Json json{{"what", remainder.what},
            {"rivals", remainder.rivals},
            {"sd", remainder.stddev},
            {"unit", remainder.unit},
            {"correlation_time", remainder.correlation_time},
            {"log_evidence", remainder.log_evidence},
            {"times", std::vector<double>(remainder.times.begin(), remainder.times.end())},
            {"process", std::vector<double>(remainder.process.begin(), remainder.process.end())}};
  for (Index i = 0; i < remainder.mean.size() && remainder.findOutside(parameters) < 0; ++i) {
    json["parameters"][parameters[static_cast<std::size_t>(i)].name.text] = {{"mean", remainder.mean[i]},
                                                                             {"sd", remainder.stddevs[i]}};
  }
  return json;
}

}  // namespace

std::string makeDiagnosisJson(const Diagnosis& diagnosis, const std::string& source) {
  const std::vector<ParameterSpec>& parameters = diagnosis.corrected.model.parameters;
  Json json{{"source", source},
            {"status", diagnosis.getStatus()},
            {"level", diagnosis.level},
            {"found", diagnosis.listTerms()},
            {"complete", diagnosis.after.isExplained()},
            {"at_bounds", diagnosis.listAtBounds()},
            {"terms_at_bounds", diagnosis.listTermsAtBounds()},
            {"before", makeFitJson(diagnosis.before, parameters, diagnosis.shared)},
            {"after", makeFitJson(diagnosis.after, parameters, parameters.size())},
            {"steps", Json::array()}};
  if (diagnosis.averaged.isGiven()) {
    json["parameters"] = makeMoments(diagnosis.averaged.mean, diagnosis.averaged.stddev,
                                     diagnosis.averaged.calcQuantiles(Eigen::Vector2d(0.025, 0.975)),
                                     parameters, diagnosis.shared);
  }
  if (hasUnknownNoise(diagnosis.corrected.noise)) {
    json["noise"] = makeNoiseJson(diagnosis);
  }
  for (const RecordingInference& one : diagnosis.alone) {
    json["recordings"].push_back({{"label", one.label}, {"statuses", listStatuses(one.inferred)}});
  }
  if (diagnosis.remainder) {
    json["remainder"] = makeRemainderJson(*diagnosis.remainder, parameters);
  }
  if (diagnosis.process) {
    json["process"] = makeRemainderJson(*diagnosis.process, parameters);
    json["process"]["ties"] = diagnosis.process_ties;
  }
  for (const DiagnosisStep& step : diagnosis.steps) {
    json["steps"].push_back(makeStepJson(step, parameters));
  }
  return formatJson(json);
}

std::string makeBlindSpotJson(const std::vector<BlindSpot>& spots,
                              const std::vector<ParameterSpec>& parameters) {
  Json json{{"blind_spots", Json::array()}};
  for (const BlindSpot& spot : spots) {
    Json one{{"term", spot.candidate.term},
             {"meaning", spot.candidate.meaning},
             {"unit", spot.candidate.unit},
             {"noticed_from", nullptr}};
    if (!spot.candidate.own_scales.empty()) {
      one["own_scales"] = makeScalesJson(spot.candidate);
    }
    if (std::isfinite(spot.noticed)) {
      one["noticed_from"] = spot.noticed;
      one["shifts"] = nameValues(spot.shifts, parameters);
    }
    json["blind_spots"].push_back(one);
  }
  return formatJson(json);
}

}  // namespace twinmap
