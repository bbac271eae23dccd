#include "framework/tracking/track_record.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "framework/base/json/json.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Numbers that are not finite are null.
template <class Values>
Json writeNumbers(const Values& values) {
  Json list = Json::array();
  for (Index i = 0; i < values.size(); ++i) {
    const double value = values.data()[i];
    list.push_back(std::isfinite(value) ? Json(value) : Json());
  }
  return list;
}

VectorXd readNumbers(const Json& list, double missing) {
  VectorXd values(static_cast<Index>(list.size()));
  for (std::size_t i = 0; i < list.size(); ++i) {
    values[static_cast<Index>(i)] = list[i].is_null() ? missing : list[i].get<double>();
  }
  return values;
}

void require(bool fits) {
  if (!fits) {
    throw std::runtime_error("is not a record of such a tracker");
  }
}

constexpr double kSaysNothing = std::numeric_limits<double>::infinity();
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Rows, values and variances of a measurement or of a mode.
template <class Likelihood>
void readLikelihood(const Json& json, Index parameters, Likelihood& likelihood) {
  likelihood.values = readNumbers(json.at("values"), kMissing);
  const VectorXd rows = readNumbers(json.at("rows"), kMissing);
  require(rows.size() == likelihood.values.size() * parameters);
  likelihood.rows = Eigen::Map<const Eigen::MatrixXd>(rows.data(), likelihood.values.size(), parameters);
  likelihood.variances = readNumbers(json.at("variances"), kSaysNothing);
  require(likelihood.variances.size() == parameters);
}

}  // namespace

bool TrackRecord::isBefore(const TrackRecord& other) const {
  return std::tie(measurement.time, digest) < std::tie(other.measurement.time, other.digest);
}

std::string writeRecord(const TrackRecord& record) {
  const tracking::Measurement& measurement = record.measurement;
  Json covariates = Json::array();
  for (const Covariate& covariate : record.covariates) {
    covariates.push_back({covariate.name, covariate.value});
  }
  Json modes = Json::array();
  for (const tracking::Mode& mode : measurement.modes) {
    modes.push_back({{"rows", writeNumbers(mode.rows)},
                     {"values", writeNumbers(mode.values)},
                     {"variances", writeNumbers(mode.variances)},
                     {"log_weight", mode.log_weight}});
  }
  Json json{{"time", measurement.time},
            {"source", record.source},
            {"digest", record.digest},
            {"status", record.status},
            {"estimate", writeNumbers(record.estimate)},
            {"rows", writeNumbers(measurement.rows)},
            {"values", writeNumbers(measurement.values)},
            {"variances", writeNumbers(measurement.variances)},
            {"conditions", writeNumbers(measurement.conditions)},
            {"covariates", covariates},
            {"modes", modes},
            {"trial", record.trial},
            {"is_file", record.is_file}};
  if (record.start) {
    json["start"] = *record.start;
  }
  return formatJson(json);
}

TrackRecord readRecord(const std::string& line, Index parameters, Index conditions) {
  const Json json = tryParseJson(line);
  require(json.is_object());
  try {
    TrackRecord record{json.at("source"), json.at("digest"), json.at("status")};
    for (const Json& covariate : json.at("covariates")) {
      record.covariates.push_back({covariate.at(0), covariate.at(1)});
    }
    record.trial = json.value("trial", "");
    record.is_file = json.value("is_file", false);
    if (json.contains("start")) {
      record.start = json.at("start").get<double>();
    }
    tracking::Measurement& measurement = record.measurement;
    record.estimate = readNumbers(json.at("estimate"), kMissing);
    measurement.time = json.at("time");
    readLikelihood(json, parameters, measurement);
    for (const Json& mode : json.at("modes")) {
      measurement.modes.emplace_back();
      measurement.modes.back().log_weight = mode.at("log_weight");
      readLikelihood(mode, parameters, measurement.modes.back());
    }
    measurement.conditions = readNumbers(json.at("conditions"), kMissing);
    require(measurement.conditions.size() == conditions);
    return record;
  } catch (const Json::exception&) {
    throw std::runtime_error("is not a record of such a tracker");
  }
}

}  // namespace twinmap
