#include <cmath>

#include "framework/base/json/json.hpp"
#include "framework/estimation/estimate.hpp"
#include "framework/inference/inference_text.hpp"
#include "framework/inference/select_estimate.hpp"

namespace twinmap {
namespace {

Json makeIntervals(const Intervals& intervals) {
  Json list = Json::array();
  for (const auto& [lower, upper] : intervals) {
    list.push_back({lower, upper});
  }
  return list;
}

/// Name -> mean, sd, the outermost bounds of its 95 % intervals, unit, its intervals of 95 % and 50 %.
Json toJson(const Estimate& estimate, const std::vector<ParameterSpec>& parameters) {
  const Eigen::VectorXd ratio = estimate.calcRatioToLimit();
  Json json = Json::object();
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const auto i = static_cast<Eigen::Index>(p);
    const Intervals of95 = estimate.findIntervals(i, Coverage::k95);
    Json& one = json[parameters[p].name.text];
    one["mean"] = estimate.mean[i];
    one["sd"] = estimate.stddev[i];
    one["lower"] = of95.front().first;
    one["upper"] = of95.back().second;
    one["unit"] = parameters[p].unit;
    one["intervals95"] = makeIntervals(of95);
    one["intervals50"] = makeIntervals(estimate.findIntervals(i, Coverage::k50));
    if (ratio.size() > 0) {
      one["ratio_to_limit"] = ratio[i];
    }
  }
  return json;
}

/// The components, each with its weight.
Json makeComponents(const Mixture& mixture, const std::vector<ParameterSpec>& parameters) {
  Json components = Json::array();
  for (Eigen::Index c = 0; c < mixture.countComponents(); ++c) {
    components.push_back(
        {{"weight", mixture.weights[c]},
         {"parameters", toJson(Estimate{mixture.means.col(c), mixture.stddevs.col(c)}, parameters)}});
  }
  return components;
}

Json toJson(const Trust& trust, const std::vector<FeatureInfo>& features) {
  Json json;
  json["p_value"] = trust.p_value;
  json["chi_square"] = trust.chi_square;
  json["residuals"] = trust.residuals;
  json["chi_square_p_value"] = trust.chi_square_p_value;
  json["anomaly_p_value"] = trust.anomaly_p_value;
  json["anomaly"] = describeAnomaly(trust, features);
  json["distance"] = trust.distance;
  return json;
}

Json toJson(const Refined& refined, const std::vector<ParameterSpec>& parameters) {
  Json json{{"status", toString(refined.status)}};
  if (refined.isAccepted()) {
    json["parameters"] =
        toJson(makeEstimate(refined, static_cast<Eigen::Index>(parameters.size())), parameters);
  } else {
    json[refined.hasConverged() ? "message" : "error"] = refined.message;
  }
  json["start"] = refined.start;
  json["distance"] = refined.distance;
  json["chi_square"] = refined.chi_square;
  json["steps"] = refined.iterations;
  json["simulations"] = refined.simulations;
  json["converged"] = refined.hasConverged();
  return json;
}

Json makeQuantiles(const SurrogatePosterior& posterior, Eigen::Index parameter) {
  Json quantiles = Json::array();
  for (std::size_t k = 0; k < kPosteriorProbabilities.size(); ++k) {
    quantiles.push_back(
        {kPosteriorProbabilities[k], posterior.quantiles(parameter, static_cast<Eigen::Index>(k))});
  }
  return quantiles;
}

Json toJson(const SurrogatePosterior& posterior, const std::vector<ParameterSpec>& parameters) {
  Json json{{"status", posterior.getStatus()}};
  if (posterior.isReliable()) {
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      const auto i = static_cast<Eigen::Index>(p);
      json["parameters"][parameters[p].name.text] = {
          {"mean", posterior.mean[i]},          {"sd", posterior.stddev[i]},
          {"lower", posterior.getLower95()[i]}, {"upper", posterior.getUpper95()[i]},
          {"unit", parameters[p].unit},         {"quantiles", makeQuantiles(posterior, i)}};
    }
  } else {
    json["message"] = posterior.message;
  }
  json["effective_sample_size"] = posterior.effective_sample_size;
  json["pareto_shape"] = posterior.pareto_shape;
  json["evaluations"] = posterior.evaluations;
  return json;
}

}  // namespace

std::string makeInferenceJson(const InferredMeasurement& inferred,
                              const std::vector<ParameterSpec>& parameters,
                              const std::vector<FeatureInfo>& features) {
  Json json{{"source", inferred.source}, {"start", inferred.start}};
  const Estimate estimate = selectEstimate(inferred);
  json["status"] = estimate.statuses.empty() ? Json() : Json(estimate.statuses.front());
  if (!estimate.statuses.empty()) {
    json["statuses"] = estimate.statuses;
  }
  json["method"] = toString(estimate.method);
  json["parameters"] = toJson(estimate, parameters);
  if (estimate.mixture.isGiven()) {
    json["components"] = makeComponents(estimate.mixture, parameters);
  }
  if (inferred.trust) {
    json["fault"] = inferred.fault.empty() ? Json(nullptr) : Json(inferred.fault);
    json["trust"] = toJson(*inferred.trust, features);
  }
  if (inferred.refined) {
    json["refined"] = toJson(*inferred.refined, parameters);
    json["inverse_map"]["parameters"] = toJson(inferred.by_estimator, parameters);
  }
  if (inferred.posterior) {
    json["posterior"] = toJson(*inferred.posterior, parameters);
  }
  return formatJson(json);
}

std::string makeErrorJson(const std::string& source, double start, const std::string& error) {
  return formatJson({{"source", source}, {"start", start}, {"status", "error"}, {"error", error}});
}

}  // namespace twinmap
