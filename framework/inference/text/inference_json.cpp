#include <cmath>

#include "framework/base/json/json.hpp"
#include "framework/estimation/estimate.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/inference/stated_values.hpp"
#include "framework/inference/text/inference_text.hpp"

namespace twinmap {
namespace {

Json makeIntervals(const Intervals& intervals) {
  Json list = Json::array();
  for (const auto& [lower, upper] : intervals) {
    list.push_back({lower, upper});
  }
  return list;
}

/// Pairs of probability and value.
Json makeQuantiles(const Eigen::MatrixXd& quantiles, Eigen::Index parameter) {
  Json list = Json::array();
  for (std::size_t k = 0; k < kQuantileProbabilities.size(); ++k) {
    list.push_back({kQuantileProbabilities[k], quantiles(parameter, static_cast<Eigen::Index>(k))});
  }
  return list;
}

/// Name -> mean, sd, the outermost bounds of its 95 % intervals, unit, its intervals of 95 % and 50 %; of
/// draws its quantiles.
Json toJson(const Estimate& estimate, const std::vector<ParameterSpec>& parameters) {
  const Eigen::VectorXd ratio = estimate.calcRatioToLimit();
  const Eigen::MatrixXd quantiles = estimate.draws.isGiven() ? calcQuantiles(estimate) : Eigen::MatrixXd();
  Json json = Json::object();
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const auto i = static_cast<Eigen::Index>(p);
    if (!isStated(estimate, i)) {
      continue;
    }
    const Intervals of95 = estimate.findIntervals(i, Coverage::k95);
    Json& one = json[parameters[p].name.text];
    one["mean"] = estimate.mean[i];
    one["sd"] = estimate.stddev[i];
    one["lower"] = of95.front().first;
    one["upper"] = of95.back().second;
    one["unit"] = parameters[p].unit;
    one["intervals95"] = makeIntervals(of95);
    one["intervals50"] = makeIntervals(estimate.findIntervals(i, Coverage::k50));
    if (quantiles.size() > 0) {
      one["quantiles"] = makeQuantiles(quantiles, i);
    }
    if (ratio.size() > 0) {
      one["ratio_to_limit"] = ratio[i];
    }
  }
  return json;
}

Json toJson(const DerivedValue& value) {
  Json json = Json::object();
  if (value.isStated()) {
    json = {{"mean", value.mean}, {"sd", value.stddev}, {"lower", value.lower95}, {"upper", value.upper95}};
  }
  json["unit"] = value.unit;
  return json;
}

Json toJson(const std::vector<DerivedValue>& values) {
  Json json = Json::object();
  for (const DerivedValue& value : values) {
    if (value.isStated()) {
      json[value.name] = toJson(value);
    }
  }
  return json;
}

/// values: of the combinations, or none.
Json makeIdentified(const std::vector<DerivedEntry>& entries, const std::vector<DerivedValue>& values) {
  Json identified = Json::array();
  for (std::size_t k = 0; k < entries.size(); ++k) {
    Json one{{"name", entries[k].name}, {"expression", entries[k].expression}};
    for (const auto& [of, coefficient] : entries[k].terms) {
      one["terms"].push_back({{"of", of}, {"coefficient", coefficient}});
    }
    one.update(values.empty() ? Json{{"unit", entries[k].unit}} : toJson(values[k]));
    identified.push_back(one);
  }
  return identified;
}

Json makeRows(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (const auto& row : matrix.rowwise()) {
    rows.push_back(std::vector<double>(row.begin(), row.end()));
  }
  return rows;
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

/// Of each parameter "log_likelihood_ratio" at the values that it is held at, and all parameters there.
Json toJson(const std::vector<Profile>& profiles, const std::vector<ParameterSpec>& parameters) {
  Json json = Json::object();
  for (const Profile& profile : profiles) {
    if (const auto held = static_cast<std::size_t>(profile.parameter); held < parameters.size()) {
      Json& one = json[parameters[held].name.text];
      one["log_likelihood_ratio"] = std::vector<double>(profile.log_ratios.begin(), profile.log_ratios.end());
      for (std::size_t p = 0; p < parameters.size(); ++p) {
        const auto row = profile.points.row(static_cast<Eigen::Index>(p));
        one["parameters"][parameters[p].name.text] = std::vector<double>(row.begin(), row.end());
      }
    }
  }
  return json;
}

Json toJson(const PosteriorEstimate& posterior, const std::vector<ParameterSpec>& parameters) {
  Json json{{"status", posterior.getStatus()}, {"from", toString(posterior.source)}};
  if (posterior.isReliable()) {
    json["parameters"] = toJson(posterior.estimate, parameters);
  } else {
    json["message"] = posterior.message;
  }
  if (!posterior.doubt.empty()) {
    json["doubt"] = posterior.doubt;
  }
  json["effective_sample_size"] = posterior.effective_sample_size;
  json["pareto_shape"] = posterior.pareto_shape;
  json["evaluations"] = posterior.evaluations;
  if (posterior.fit) {
    json["searches"] = posterior.fit->searches;
    json["found_best"] = posterior.fit->found_best;
    json["simulations"] = posterior.fit->simulations;
  }
  if (!posterior.profiles.empty()) {
    json["profiles"] = toJson(posterior.profiles, parameters);
  }
  return json;
}

/// What the simulator leaves of a measurement, where no trust model judges it.
Json toJson(const SimulatorFit& fit) {
  return {{"p_value", fit.test.calcPValue()},
          {"chi_square", fit.chi_square},
          {"degrees", fit.degrees},
          {"chi_square_p_value", fit.test.chi_square_p},
          {"whiteness_p_value", fit.test.whiteness_p},
          {"largest_p_value", fit.test.largest_p}};
}

Json toJson(const NoiseReport& report) {
  Json json{{"stddev", report.stddev}, {"unit", report.unit}};
  if (report.isStated()) {
    json["factor"] = report.found.factor;
  }
  if (report.found.autoregression.size() > 0) {
    json["autoregression"] =
        std::vector<double>(report.found.autoregression.begin(), report.found.autoregression.end());
  }
  if (report.found.has_offset) {
    json["offset"] = report.found.offset;
    json["offset_stddev"] = report.found.offset_stddev;
  }
  return json;
}

Json toJson(const NuisanceSize& size) {
  Json json{{size.name, size.value}, {"sd", size.stddev}};
  if (size.from) {
    json["from"] = *size.from;
  }
  return json;
}

/// What the recording lacks, and what it has other than the stated noise.
void addRecording(const InferredMeasurement& inferred, Json& json) {
  if (!inferred.remarks.empty()) {
    json["remarks"] = inferred.remarks;
  }
  if (!inferred.against.empty()) {
    json["against_model"] = inferred.against;
  }
  if (!inferred.left_out.empty()) {
    json["left_out"] = inferred.left_out;
  }
  for (std::size_t k = 0; k < inferred.countSizes(); ++k) {
    json[inferred.nuisance->kind].push_back(toJson(inferred.nuisance->sizes[k]));
  }
  if (!inferred.posterior || !inferred.posterior->fit) {
    return;
  }
  const SimulatorFit& fit = *inferred.posterior->fit;
  if (!fit.outliers.empty()) {
    json["outliers"] = fit.outliers;
  }
  if (const double factor = fit.getNoiseFactor(); factor != 1.0) {
    json["noise_factor"] = factor;
  }
  for (const NoiseReport& report : fit.noise) {
    json["noise"][report.output] = toJson(report);
  }
}

/// What is known in numbers.
void addValues(const InferredMeasurement& inferred, const Estimate& believed,
               const std::vector<ParameterSpec>& parameters, Json& json) {
  const StatedValues stated = stateValues(inferred, believed, parameters);
  if (const Json values = toJson(stated.estimate, parameters); !values.empty()) {
    json["parameters"] = values;
  }
  if (!stated.nuisance.empty()) {
    json["nuisance"] = toJson(stated.nuisance);
  }
  if (inferred.quantities) {
    json["derived"] = toJson(stated.derived);
  }
  if (!inferred.ridges.empty()) {
    json["identified"] = makeIdentified(listDerived(inferred.ridges, parameters), stated.identified);
  }
}

/// The estimates that there are beside the one that was taken.
void addOrigins(const InferredMeasurement& inferred, const Estimate& estimate,
                const std::vector<ParameterSpec>& parameters, Json& json) {
  if (inferred.refined) {
    json["refined"] = toJson(*inferred.refined, parameters);
  }
  if (inferred.refined ||
      (inferred.by_estimator.isGiven() && estimate.method != inferred.by_estimator.method)) {
    json["inverse_map"]["parameters"] = toJson(inferred.by_estimator, parameters);
  }
  if (inferred.posterior) {
    json["posterior"] = toJson(*inferred.posterior, parameters);
  }
}

}  // namespace

Json nameValues(const Eigen::VectorXd& values, const std::vector<ParameterSpec>& parameters) {
  Json json = Json::object();
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    json[parameters[static_cast<std::size_t>(i)].name.text] = values[i];
  }
  return json;
}

void addModelTest(const std::optional<ModelTest>& test, const std::vector<ParameterSpec>& parameters,
                  Json& json) {
  json["model_tested"] = test.has_value();
  if (test && test->missing) {
    const MissingTerm& missing = *test->missing;
    json["missing"] = {{"term", missing.term},
                       {"meaning", missing.meaning},
                       {"size", missing.size},
                       {"sd", missing.stddev},
                       {"unit", missing.unit},
                       {"share", missing.share},
                       {"log_evidence", missing.log_evidence},
                       {"rivals", missing.rivals}};
    if (missing.shifts.size() > 0) {
      json["missing"]["shifts"] = nameValues(missing.shifts, parameters);
    }
  }
  if (test && test->unnoticed) {
    const UnnoticedTerm& term = *test->unnoticed;
    json["unnoticed"] = {{"term", term.term},
                         {"meaning", term.meaning},
                         {"size", term.size},
                         {"unit", term.unit},
                         {"parameter", parameters[term.parameter].name.text},
                         {"shift", term.shift}};
  }
}

std::string makeInferenceJson(const InferredMeasurement& inferred,
                              const std::vector<ParameterSpec>& parameters,
                              const std::vector<FeatureInfo>& features) {
  return formatJson(makeAnswerJson(inferred, selectEstimate(inferred), parameters, features));
}

Json makeAnswerJson(const InferredMeasurement& inferred, const Estimate& estimate,
                    const std::vector<ParameterSpec>& parameters, const std::vector<FeatureInfo>& features) {
  Json json{{"source", inferred.source}};
  if (!std::isnan(inferred.start)) {
    json["start"] = inferred.start;
  }
  json["status"] = estimate.statuses.empty() ? Json() : Json(estimate.statuses.front());
  if (!estimate.statuses.empty()) {
    json["statuses"] = estimate.statuses;
  }
  json["method"] = estimate.getMethod();
  if (inferred.prior) {
    json["prior"] = inferred.prior->text;
  }
  if (inferred.segments) {
    json["segments"] = {{"count", inferred.segments->count},
                        {"length", inferred.segments->length},
                        {"states", inferred.segments->states}};
  }
  addRecording(inferred, json);
  addValues(inferred, estimate, parameters, json);
  if (estimate.correlation.size() > 0) {
    json["covariance"] = makeRows(estimate.calcCovariance());
  }
  if (estimate.mixture.isGiven()) {
    json["components"] = makeComponents(estimate.mixture, parameters);
  }
  addModelTest(inferred.model_test, parameters, json);
  const bool was_simulated =
      inferred.posterior && inferred.posterior->fit && inferred.posterior->fit->isTested();
  if (inferred.trust || was_simulated) {
    json["fault"] = inferred.fault.empty() ? Json(nullptr) : Json(inferred.fault);
  }
  if (inferred.trust) {
    json["trust"] = toJson(*inferred.trust, features);
  } else if (was_simulated) {
    json["trust"] = toJson(*inferred.posterior->fit);
  }
  addOrigins(inferred, estimate, parameters, json);
  return json;
}

std::string makeErrorJson(const std::string& source, double start, const std::string& error) {
  return formatJson({{"source", source}, {"start", start}, {"status", "error"}, {"error", error}});
}

}  // namespace twinmap
