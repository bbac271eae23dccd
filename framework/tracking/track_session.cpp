#include "framework/tracking/track_session.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "framework/base/files/digest.hpp"
#include "framework/base/files/folder_lock.hpp"
#include "framework/base/files/sync_file.hpp"
#include "framework/base/json/json.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/files/tracking_file.hpp"
#include "framework/inference/known_value.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/inference/text/inference_text.hpp"
#include "framework/tracking/measured_context.hpp"
#include "framework/tracking/track_answer.hpp"
#include "framework/tracking/track_file.hpp"
#include "framework/tracking/track_history.hpp"
#include "framework/tracking/track_likelihood.hpp"
#include "framework/tracking/track_model.hpp"
#include "framework/tracking/track_page.hpp"

namespace twinmap {

namespace fs = std::filesystem;

fs::path findTracking(const fs::path& run_or_experiment, const fs::path& given) {
  if (!given.empty()) {
    if (!loadTracking(given.string())) {
      throw ExperimentError(given.string() +
                            ": has no section 'tracking'; write one, as docs/reference says");
    }
    return given;
  }
  const bool is_yaml = run_or_experiment.extension() == ".yaml" || run_or_experiment.extension() == ".yml";
  return is_yaml && loadTracking(run_or_experiment.string()) ? run_or_experiment : fs::path();
}

namespace {

std::string digestText(const std::string& text) {
  return toHex(calcDigest(text.data(), text.size()));
}

std::optional<TrackingSpec> readTracking(const fs::path& file, const ModelSpec& model) {
  std::optional<TrackingSpec> tracking;
  if (!file.empty()) {
    tracking = loadTracking(file.string());
  }
  if (tracking) {
    checkTracking(*tracking, model);
  }
  return tracking;
}

TrackIdentity identify(const InferenceSource& source, const std::optional<TrackingSpec>& tracking) {
  const std::string estimator =
      source.findTrained() != nullptr ? source.findTrained()->getMap().getKind() : "posterior";
  return {source.getExperiment().name.text, digestText(writeExperiment(source.getExperiment()) + estimator),
          tracking ? writeTracking(*tracking) : ""};
}

/// Of a status, whether a measurement with it does not update: the model does not hold for it, or nothing
/// reliable is known of it.
bool isBarred(const std::string& status) {
  return status == "model_mismatch" || status == "model_incomplete" || status == "missing_term" ||
         status == "unreliable" || status == "not_simulated";
}

}  // namespace

struct TrackSession::Parts {
  const InferenceSource& source;
  fs::path state;
  FileLock lock;
  TrackOptions options;
  std::optional<TrackingSpec> tracking;
  TrackIdentity identity;
  std::unique_ptr<MeasurementInference> inference;
  Eigen::VectorXd known;
  std::vector<std::string> conditions, columns;
  TrackSpace space;
  tracking::Model model;
  tracking::Belief prior;
  std::optional<TrackedTwin> twin;
  std::optional<TrackHistory> history;
  bool changed = false;  ///< since commit()

  Parts(const InferenceSource& from, fs::path file, TrackOptions given)
      : source(from),
        state(std::move(file)),
        lock(state.string() + ".lock", state.string(), "another --state"),
        options(std::move(given)),
        tracking(readTracking(options.tracking, getModel())),
        identity(identify(source, tracking)),
        inference(source.makeSession(options.session)),
        known(collectKnown(getModel().inputs, parseKnownValues(options.known))),
        conditions(tracking ? listConditions(*tracking) : std::vector<std::string>{}),
        columns(source.getReader().listColumns()),
        space(getModel().parameters),
        model(makeTrackModel(findSpec(), getModel(), space)),
        prior(makeTrackPrior(getModel(), space)) {
    if (options.lag < 1) {
      throw ExperimentError("--lag must be at least 1");
    }
    columns.insert(columns.end(), conditions.begin(), conditions.end());
    if (tracking && tracking->time.column) {
      columns.push_back(tracking->time.column->name);
    }
    std::optional<LoadedTrack> loaded = readTrackFile(state, identity, model, options.lag);
    history.emplace(getHistoryFile(), loaded ? loaded->history_bytes : 0);
    if (loaded) {
      twin.emplace(std::move(loaded->twin));
    } else {
      twin.emplace(model, options.lag);
    }
  }

  const ModelSpec& getModel() const { return source.getExperiment().model; }
  const TrackingSpec* findSpec() const { return tracking ? &*tracking : nullptr; }
  TrackView view() const { return {getModel().parameters, space, findSpec()}; }
  fs::path getHistoryFile() const { return fs::path(state).replace_extension(".jsonl"); }

  TrackCourse calcCourse() const {
    return calcTrackCourse(history->read(model.countParameters(), model.conditions), model);
  }

  TrackRecord makeRecord(const Table& table, const std::string& digest,
                         const MeasurementContext& context) const {
    TrackRecord record{table.source, digest, ""};
    const std::optional<double> stated = context.at ? context.at : readTrackTime(table, findSpec());
    record.measurement.time = stated ? *stated : number(digest);
    record.measurement.conditions = readConditions(table, conditions);
    record.covariates = listCovariates(table, conditions);
    requirePlace(record);
    return record;
  }

  /// The time of what states none: its number, of what is there already that one's.
  double number(const std::string& digest) const {
    for (const TrackRecord& record : twin->getWindow()) {
      if (record.digest == digest) {
        return record.measurement.time;
      }
    }
    return static_cast<double>(twin->getNow().tracker.getState().count + 1);
  }

  void requirePlace(const TrackRecord& record) const {
    if (!std::isfinite(record.measurement.time)) {
      throw MeasurementError(record.source + ": its time must be finite");
    }
    if (twin->isTooLate(record)) {
      throw MeasurementError(fmt::format(
          "{}: its time, {}, is before the last {} measurements, the first of which is of {}; nothing older "
          "can "
          "be put where it belongs: begin with a greater --lag, and track all again",
          record.source, record.measurement.time, options.lag, twin->getWindow().front().measurement.time));
    }
  }

  /// Whether it updates, by its statuses.
  bool informs(const Estimate& estimate) const {
    return estimate.isGiven() && estimate.mean.allFinite() && estimate.stddev.allFinite() &&
           std::none_of(estimate.statuses.begin(), estimate.statuses.end(), [&](const std::string& status) {
             return isBarred(status) &&
                    std::find(options.use.begin(), options.use.end(), status) == options.use.end();
           });
  }

  void take(const Estimate& estimate, TrackRecord& record) const {
    const Eigen::Index p = space.count();
    tracking::Measurement& measurement = record.measurement;
    record.status = joinStatuses(estimate.statuses, ", ");
    measurement.rows.resize(0, p);
    measurement.variances = Eigen::VectorXd::Constant(p, std::numeric_limits<double>::infinity());
    if (!informs(estimate)) {
      return;
    }
    tracking::Measurement said = makeTrackMeasurement(estimate, space, prior);
    said.time = measurement.time;
    said.conditions = measurement.conditions;
    measurement = std::move(said);
    record.estimate.resize(p);
    for (Eigen::Index j = 0; j < p; ++j) {
      record.estimate[j] = space.toCoordinate(j, estimate.mean[j]);
    }
  }

  void commit() {
    if (changed) {
      syncFile(getHistoryFile());  // first: the state says how much of it is there
      writeTrackFile(state, identity, *twin, history->getBytes());
      changed = false;
    }
  }

  Json update(const Table& table, const std::string& digest, const MeasurementContext& context) {
    TrackRecord record = makeRecord(table, digest, context);
    const InferredMeasurement inferred = inference->infer(table, context.start, known);
    const Estimate estimate = selectEstimate(inferred);
    Json json = makeAnswerJson(inferred, estimate, getModel().parameters,
                               source.getReader().getExtractor().getInfos());
    const long long alarms = twin->getNow().alarm_count;
    const bool is_known = twin->findSame(record) != nullptr, is_late = twin->isLate(record);
    Json beside{{"at", record.measurement.time}, {"counted", !is_known}, {"late", !is_known && is_late}};
    if (!is_known) {
      take(estimate, record);
      history->add(record);  // where that fails, nothing has changed
      const tracking::Step step = twin->add(record);
      changed = true;
      beside["updates"] = record.measurement.values.size() > 0;
      if (!is_late) {
        beside["fits"] = step.is_used || record.measurement.values.size() == 0;
        beside["chi_square"] = step.chi_square;
        beside["degrees"] = step.degrees;
        beside["alarm_statistic"] = step.statistic;
      }
    }
    json["track"] = makeTrackState(twin->getNow(), view());
    json["track"].update(beside);
    json["track"]["alarms"] = makeTrackAlarms(twin->getNow(), alarms, view());
    return json;
  }
};

TrackSession::TrackSession(const InferenceSource& source, fs::path state, TrackOptions options)
    : parts_(std::make_unique<Parts>(source, std::move(state), std::move(options))) {}

TrackSession::~TrackSession() = default;

Json TrackSession::update(const std::string& text, const std::string& name,
                          const MeasurementContext& context) {
  std::istringstream stream(text);
  return parts_->update(readCsv(stream, name, parts_->columns, parts_->inference->getMissingCells()),
                        digestText(text), context);
}

Json TrackSession::updateFile(const fs::path& file, const MeasurementContext& context) {
  return parts_->update(readTable(file, parts_->columns, parts_->inference->getMissingCells()),
                        toHex(calcFileDigest(file)), context);
}

void TrackSession::commit() {
  parts_->commit();
}

Json TrackSession::getState() const {
  Json json = makeTrackState(parts_->twin->getNow(), parts_->view());
  json["alarms"] = makeTrackAlarms(parts_->twin->getNow(), 0, parts_->view());
  return json;
}

std::string TrackSession::makeHistory() const {
  return makeTrackCsv(parts_->calcCourse(), parts_->getModel().parameters, parts_->space);
}

std::string TrackSession::makePage() const {
  return makeTrackPage(parts_->identity.run, parts_->calcCourse(), parts_->twin->getNow(), parts_->view());
}

std::vector<std::string> TrackSession::listCounted() const {
  const tracking::Model& model = parts_->model;
  std::vector<std::string> digests;
  for (const TrackRecord& record : parts_->history->read(model.countParameters(), model.conditions)) {
    digests.push_back(record.digest);
  }
  return digests;
}

fs::path TrackSession::getHistoryFile() const {
  return parts_->getHistoryFile();
}

}  // namespace twinmap
