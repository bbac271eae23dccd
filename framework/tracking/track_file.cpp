#include "framework/tracking/track_file.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/hdf5/hdf5_file.hpp"
#include "framework/base/json/json.hpp"
#include "kernels/tracking/flat_state.hpp"

namespace twinmap {
namespace {

using Eigen::VectorXd;

constexpr const char* kVersion = "twinmap track 2";

std::vector<double> toList(const VectorXd& values) {
  return {values.begin(), values.end()};
}

VectorXd toVector(const Json& list) {
  const auto values = list.get<std::vector<double>>();
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// Infinite numbers of a list, which JSON has not, are left out as null.
Json writeVariances(const VectorXd& values) {
  Json list = Json::array();
  for (const double value : values) {
    list.push_back(std::isfinite(value) ? Json(value) : Json());
  }
  return list;
}

VectorXd readVariances(const Json& list) {
  VectorXd values(static_cast<Eigen::Index>(list.size()));
  for (std::size_t i = 0; i < list.size(); ++i) {
    values[static_cast<Eigen::Index>(i)] =
        list[i].is_null() ? std::numeric_limits<double>::infinity() : list[i].get<double>();
  }
  return values;
}

Json writeAlarm(const TrackAlarm& alarm) {
  const tracking::Change& change = alarm.change;
  return {{"announced", alarm.announced},
          {"of_several", alarm.is_of_several},
          {"parameter", change.parameter},
          {"time", change.time},
          {"earliest", change.earliest},
          {"latest", change.latest},
          {"size", change.size},
          {"stddev", change.stddev},
          {"probability", change.probability},
          {"probabilities", toList(change.probabilities)},
          {"rivals", alarm.rivals}};
}

TrackAlarm readAlarm(const Json& json) {
  TrackAlarm alarm{json.at("announced"), json.at("of_several")};
  tracking::Change& change = alarm.change;
  change.parameter = json.at("parameter").get<Eigen::Index>();
  change.time = json.at("time");
  change.earliest = json.at("earliest");
  change.latest = json.at("latest");
  change.size = json.at("size");
  change.stddev = json.at("stddev");
  change.probability = json.at("probability");
  change.probabilities = toVector(json.at("probabilities"));
  alarm.rivals = json.at("rivals").get<std::vector<std::string>>();
  return alarm;
}

std::string writePoint(const TrackPoint& point) {
  Json json{{"alarm_count", point.alarm_count}, {"uncalibrated_at", point.uncalibrated_at}};
  json["alarms"] = Json::array();
  for (const TrackAlarm& alarm : point.alarms) {
    json["alarms"].push_back(writeAlarm(alarm));
  }
  json["course"] = Json::array();
  for (const CourseSample& sample : point.course) {
    Json covariates = Json::array();
    for (const Covariate& covariate : sample.covariates) {
      covariates.push_back({covariate.name, covariate.value});
    }
    json["course"].push_back({{"time", sample.time},
                              {"estimate", toList(sample.estimate)},
                              {"variances", writeVariances(sample.variances)},
                              {"covariates", covariates}});
  }
  return formatJson(json);
}

void readPoint(const std::string& text, TrackPoint& point) {
  const Json json = parseJson(text);
  point.alarm_count = json.at("alarm_count");
  point.uncalibrated_at = json.at("uncalibrated_at");
  for (const Json& alarm : json.at("alarms")) {
    point.alarms.push_back(readAlarm(alarm));
  }
  for (const Json& sample : json.at("course")) {
    point.course.push_back(
        {sample.at("time"), toVector(sample.at("estimate")), readVariances(sample.at("variances")), {}});
    for (const Json& covariate : sample.at("covariates")) {
      point.course.back().covariates.push_back({covariate.at(0), covariate.at(1)});
    }
  }
}

std::string writeDiagnosis(const AlarmDiagnosis& one) {
  return formatJson({{"announced", one.announced},
                     {"of_several", one.is_of_several},
                     {"parameter", one.parameter},
                     {"time", one.time},
                     {"answer", one.answer}});
}

AlarmDiagnosis readDiagnosis(const std::string& text) {
  const Json json = parseJson(text);
  return {json.at("announced"), json.at("of_several"), json.at("parameter").get<Eigen::Index>(),
          json.at("time"), json.at("answer")};
}

/// None of a file from before there were any.
std::deque<AlarmDiagnosis> readDiagnoses(const Hdf5Reader& file) {
  std::deque<AlarmDiagnosis> diagnoses;
  for (const std::string& text :
       file.contains("diagnoses") ? file.readTexts("diagnoses") : std::vector<std::string>{}) {
    diagnoses.push_back(readDiagnosis(text));
  }
  return diagnoses;
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
  throw std::runtime_error(path.string() + ": " + why);
}

void requireIdentity(const std::filesystem::path& path, const std::vector<std::string>& found,
                     const TrackIdentity& identity) {
  if (found.size() != 4 || found[0] != kVersion) {
    refuse(path,
           "is not a state of this version of track; name another --state, and track the history again");
  }
  if (found[1] != identity.run || found[2] != identity.digest) {
    refuse(path, "is the state of another run or experiment ('" + found[1] + "', digest " + found[2] +
                     "; this is '" + identity.run + "', " + identity.digest +
                     "); give that run, or name another --state");
  }
  if (found[3] != identity.tracking) {
    refuse(path,
           "was begun with another section 'tracking'; give that one (--tracking), or name another --state");
  }
}

}  // namespace

void writeTrackFile(const std::filesystem::path& path, const TrackIdentity& identity, const TrackedTwin& twin,
                    std::uint64_t history_bytes) {
  writeAtomically(path, [&](const std::filesystem::path& temporary) {
    Hdf5Writer file(temporary, Hdf5Seal::kDigest);
    file.write("identity",
               std::vector<std::string>{kVersion, identity.run, identity.digest, identity.tracking});
    const std::vector<double> numbers = tracking::flatten(twin.getBase().tracker.getState());
    file.write("base", numbers.data(), {numbers.size()});
    std::vector<std::string> texts{writePoint(twin.getBase())};
    for (const TrackRecord& record : twin.getWindow()) {
      texts.push_back(writeRecord(record));
    }
    file.write("texts", texts);
    std::vector<std::string> diagnoses;
    for (const AlarmDiagnosis& one : twin.getDiagnoses()) {
      diagnoses.push_back(writeDiagnosis(one));
    }
    if (!diagnoses.empty()) {
      file.write("diagnoses", diagnoses);
    }
    file.write("history_bytes", std::vector<std::int64_t>{static_cast<std::int64_t>(history_bytes)});
    file.close();
  });
}

std::optional<LoadedTrack> readTrackFile(const std::filesystem::path& path, const TrackIdentity& identity,
                                         const tracking::Model& model, int lag) {
  if (!std::filesystem::exists(path)) {
    return {};
  }
  const Hdf5Reader file(path, Hdf5Seal::kDigest);
  requireIdentity(path, file.contains("identity") ? file.readTexts("identity") : std::vector<std::string>{},
                  identity);
  try {
    TrackPoint base{tracking::Tracker(model)};
    const VectorXd numbers = file.readVector("base");
    base.tracker.setState(tracking::unflatten(model, {numbers.begin(), numbers.end()}));
    const std::vector<std::string> texts = file.readTexts("texts");
    readPoint(texts.at(0), base);
    std::deque<TrackRecord> window;
    for (std::size_t i = 1; i < texts.size(); ++i) {
      window.push_back(readRecord(texts[i], model.countParameters(), model.conditions));
    }
    const auto bytes = static_cast<std::uint64_t>(file.readIntegers("history_bytes").at(0));
    return LoadedTrack{TrackedTwin(std::move(base), std::move(window), lag, readDiagnoses(file)), bytes};
  } catch (const Json::exception&) {
    refuse(path, "is not a state of track");
  } catch (const std::out_of_range&) {
    refuse(path, "is not a state of track");
  }
}

}  // namespace twinmap
