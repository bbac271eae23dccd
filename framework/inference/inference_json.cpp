#include <cmath>

#include "framework/base/json/json.hpp"
#include "framework/estimation/predictions.hpp"
#include "framework/inference/answer.hpp"
#include "framework/inference/inference_text.hpp"

namespace twinmap {
namespace {

Json makeEstimate(double mean, double stddev, const std::string& unit) {
  Json estimate;
  estimate["mean"] = mean;
  estimate["sd"] = stddev;
  estimate["lower"] = mean - kNormal95 * stddev;
  estimate["upper"] = mean + kNormal95 * stddev;
  estimate["unit"] = unit;
  return estimate;
}

Json makeEstimatesJson(const Eigen::VectorXd& mean, const Eigen::VectorXd& stddev,
                       const std::vector<ParameterSpec>& parameters) {
  Json estimates = Json::object();
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const auto i = static_cast<Eigen::Index>(p);
    estimates[parameters[p].name.text] = makeEstimate(mean[i], stddev[i], parameters[p].unit);
  }
  return estimates;
}

Json makeIntervals(const Intervals& intervals) {
  Json list = Json::array();
  for (const auto& [lower, upper] : intervals) {
    list.push_back({lower, upper});
  }
  return list;
}

/// With the answer's own intervals, and a mixture's smallest sets.
Json makeEstimatesJson(const Answer& answer, const std::vector<ParameterSpec>& parameters) {
  Json estimates = makeEstimatesJson(answer.mean, answer.stddev, parameters);
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const auto i = static_cast<Eigen::Index>(p);
    Json& estimate = estimates[parameters[p].name.text];
    estimate["lower"] = answer.lower95[i];
    estimate["upper"] = answer.upper95[i];
    if (answer.mixture.isGiven()) {
      estimate["intervals95"] = makeIntervals(answer.intervals95[p]);
      estimate["intervals50"] =
          makeIntervals(findWithin(takeMarginal(answer.mixture, i), answer.reach.get(i).of50));
    }
  }
  return estimates;
}

/// The components, each with its weight.
Json makeComponents(const Mixture& mixture, const std::vector<ParameterSpec>& parameters) {
  Json components = Json::array();
  for (Eigen::Index c = 0; c < mixture.countComponents(); ++c) {
    components.push_back(
        {{"weight", mixture.weights[c]},
         {"parameters", makeEstimatesJson(mixture.means.col(c), mixture.stddevs.col(c), parameters)}});
  }
  return components;
}

/// The map's, with how far they are from what the measurement allows.
Json makeMapEstimates(const Inference& inference, const std::vector<ParameterSpec>& parameters) {
  Json estimates = makeEstimatesJson(makeMapAnswer(inference), parameters);
  const Eigen::VectorXd ratio = calcRatioToLimit(inference);
  for (Eigen::Index p = 0; p < ratio.size(); ++p) {
    estimates[parameters[static_cast<std::size_t>(p)].name.text]["ratio_to_limit"] = ratio[p];
  }
  return estimates;
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
    json["parameters"] = makeEstimatesJson(refined.point, refined.stddev, parameters);
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
    json["parameters"] = makeEstimatesJson(posterior.mean, posterior.stddev, parameters);
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      const auto i = static_cast<Eigen::Index>(p);
      Json& estimate = json["parameters"][parameters[p].name.text];
      estimate["lower"] = posterior.getLower95()[i];
      estimate["upper"] = posterior.getUpper95()[i];
      estimate["quantiles"] = makeQuantiles(posterior, i);
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
  const std::vector<std::string> statuses = listStatuses(inferred);
  json["status"] = statuses.empty() ? Json() : Json(statuses.front());
  if (!statuses.empty()) {
    json["statuses"] = statuses;
  }
  const Answer answer = chooseAnswer(inferred);
  json["method"] = toString(answer.method);
  json["parameters"] = answer.isRefined() ? makeEstimatesJson(answer, parameters)
                                          : makeMapEstimates(inferred.inference, parameters);
  if (answer.mixture.isGiven()) {
    json["components"] = makeComponents(answer.mixture, parameters);
  }
  if (inferred.trust) {
    json["trust"] = toJson(*inferred.trust, features);
  }
  if (inferred.refined) {
    json["refined"] = toJson(*inferred.refined, parameters);
    json["inverse_map"]["parameters"] = makeMapEstimates(inferred.inference, parameters);
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
