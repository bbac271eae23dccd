#include "framework/robots/estimate_file.hpp"

#include <cmath>

#include "framework/base/json/json.hpp"
#include "framework/base/random/random.hpp"
#include "framework/base/text/source_location.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap::robots {
namespace {

Json readFirstLine(const std::string& text, const std::string& source) {
  Json json = tryParseJson(text.substr(0, text.find('\n')));
  if (json.is_discarded()) {
    json = tryParseJson(text);
  }
  if (json.is_discarded() || !json.is_object() || !json.contains("status")) {
    throw ExperimentError(source + ": is not an estimate: give a file that 'twinmap infer ... --json' wrote");
  }
  return json;
}

Json makeCorrelation(const RobotEstimate& estimate) {
  Json rows = Json::array();
  const auto& covariance = estimate.covariance;
  for (std::size_t i = 0; i < covariance.size(); ++i) {
    Json row = Json::array();
    for (std::size_t k = 0; k < covariance.size(); ++k) {
      const double scale = std::sqrt(covariance[i][i] * covariance[k][k]);
      row.push_back(scale > 0.0 ? covariance[i][k] / scale : 0.0);
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

std::map<std::string, double> RobotEstimate::getMeans() const {
  std::map<std::string, double> values;
  for (std::size_t i = 0; i < names.size(); ++i) {
    values[names[i]] = means[i];
  }
  return values;
}

RobotEstimate readEstimate(const std::string& text, const std::string& source) {
  const Json json = readFirstLine(text, source);
  RobotEstimate estimate;
  estimate.source = source;
  try {
    estimate.status = json["status"].is_string() ? json["status"].get<std::string>() : "not judged";
    if (!json.contains("parameters")) {
      throw ExperimentError(source + ": states no parameters (status " + estimate.status +
                            "): correct what 'infer' says of the measurement");
    }
    for (const auto& [name, values] : json["parameters"].items()) {
      estimate.names.push_back(name);
      estimate.means.push_back(values.at("mean").get<double>());
      estimate.stddevs.push_back(values.at("sd").get<double>());
      estimate.units.push_back(values.value("unit", ""));
    }
    if (json.contains("covariance")) {
      estimate.covariance = json["covariance"].get<std::vector<std::vector<double>>>();
    }
  } catch (const Json::exception&) {
    throw ExperimentError(source + ": an estimate's mean, sd or covariance is not a number");
  }
  return estimate;
}

void requireOk(const RobotEstimate& estimate) {
  if (estimate.status != "ok") {
    throw ExperimentError(estimate.source + ": the estimate is " + estimate.status +
                          ", not ok (twinmap explain " + estimate.status +
                          "): correct the model or the recording, or write it with --anyway");
  }
}

std::string makeUpdateJson(const RobotEstimate& estimate, const std::vector<std::string>& without_place) {
  Json json{{"source", estimate.source}, {"status", estimate.status}};
  for (std::size_t i = 0; i < estimate.names.size(); ++i) {
    json["parameters"][estimate.names[i]] = {
        {"mean", estimate.means[i]}, {"sd", estimate.stddevs[i]}, {"unit", estimate.units[i]}};
  }
  if (!estimate.covariance.empty()) {
    json["correlation"] = makeCorrelation(estimate);
  }
  json["not_in_robot_file"] = without_place;
  return formatJson(json, 2) + "\n";
}

EstimateDraws::EstimateDraws(const RobotEstimate& estimate) : estimate_(estimate) {
  const std::size_t n = estimate.names.size();
  Eigen::MatrixXd covariance(n, n);
  for (std::size_t i = 0; i < n; ++i) {
    if (estimate.covariance.size() < n || estimate.covariance[i].size() < n) {
      throw ExperimentError(estimate.source +
                            ": states no covariance of its parameters: infer with a file whose "
                            "estimate has one, or leave --draws out");
    }
    for (std::size_t k = 0; k < n; ++k) {
      covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = estimate.covariance[i][k];
    }
  }
  if (!covariance.allFinite()) {
    throw ExperimentError(estimate.source + ": its covariance is not finite");
  }
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(covariance);
  const Eigen::MatrixXd factor = eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
  for (const auto& row : factor.rowwise()) {
    factor_.emplace_back(row.begin(), row.end());
  }
}

std::map<std::string, double> EstimateDraws::draw(int number) const {
  constexpr std::uint64_t kSeed = 1;
  const RandomStream stream(kSeed, RandomPurpose::kEnsemble);
  std::map<std::string, double> values = estimate_.getMeans();
  for (std::size_t k = 0; k < factor_.size(); ++k) {
    const double normal = stream.calcNormal(static_cast<std::uint64_t>(number), k);
    for (std::size_t i = 0; i < factor_.size(); ++i) {
      values[estimate_.names[i]] += factor_[i][k] * normal;
    }
  }
  return values;
}

}  // namespace twinmap::robots
