#include "framework/tracking/track_session.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/files/digest.hpp"
#include "framework/base/files/folder_lock.hpp"
#include "framework/base/json/json.hpp"
#include "framework/data/measurement/files/read_table.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/files/tracking_file.hpp"
#include "framework/inference/known_value.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/inference/text/inference_text.hpp"
#include "framework/tracking/change_diagnosis.hpp"
#include "framework/tracking/measured_context.hpp"
#include "framework/tracking/track_answer.hpp"
#include "framework/tracking/track_file.hpp"
#include "framework/tracking/track_history.hpp"
#include "framework/tracking/track_likelihood.hpp"
#include "framework/tracking/track_model.hpp"
#include "framework/tracking/track_page.hpp"

namespace twinmap {

namespace fs = std::filesystem;

std::optional<TrackingSpec> findTracking(const fs::path& run_or_experiment, const fs::path& given) {
  if (!given.empty()) {
    std::optional<TrackingSpec> tracking = loadTracking(given.string());
    if (!tracking) {
      throw ExperimentError(given.string() +
                            ": has no section 'tracking'; write one, as docs/reference says");
    }
    return tracking;
  }
  return isExperimentFile(run_or_experiment) ? loadTracking(run_or_experiment.string()) : std::nullopt;
}

namespace {

std::string digestText(const std::string& text) {
  return toHex(calcDigest(text.data(), text.size()));
}

TrackIdentity identify(const TwinSource& source, const std::optional<TrackingSpec>& tracking) {
  return {source.getName(), digestText(source.describe()), tracking ? writeTracking(*tracking) : ""};
}

TrackOptions check(TrackOptions options, const ModelSpec& model) {
  if (options.lag < 1) {
    throw ExperimentError("--lag must be at least 1");
  }
  if (options.tracking) {
    checkTracking(*options.tracking, model);
  }
  return options;
}

}  // namespace

struct TrackSession::Parts {
  /// One trial's, or the experiment's where it has none.
  struct TrialInference {
    const MeasurementReader& reader;
    std::unique_ptr<MeasurementInference> inference;
    Eigen::VectorXd known;
    std::vector<std::string> columns{};
  };

  const TwinSource& source;
  fs::path state;
  FileLock lock;
  TrackOptions options;
  TrackIdentity identity;
  std::vector<TrialInference> trials;
  std::vector<std::string> conditions;
  TrackSpace space;
  tracking::Model model;
  TrackPrior prior;
  std::optional<TrackedTwin> twin;
  std::optional<TrackHistory> history;
  RecordingShelf shelf;
  bool changed = false;  ///< since commit()

  Parts(const TwinSource& from, fs::path file, TrackOptions given)
      : source(from),
        state(std::move(file)),
        lock(state.string() + ".lock", state.string(), "another --state"),
        options(check(std::move(given), getModel())),
        identity(identify(source, options.tracking)),
        trials(makeInferences(source, options)),
        conditions(options.tracking ? listConditions(*options.tracking) : std::vector<std::string>{}),
        space(getModel().parameters),
        model(makeTrackModel(findSpec(), getModel(), space, findSharedError())),
        prior(makeTrackPrior(getModel(), space)) {
    std::optional<LoadedTrack> loaded = readTrackFile(state, identity, model, options.lag);
    history.emplace(getHistoryFile(), loaded ? loaded->history_bytes : 0);
    if (loaded) {
      twin.emplace(std::move(loaded->twin));
    } else {
      twin.emplace(model, options.lag);
    }
  }

  static std::vector<TrialInference> makeInferences(const TwinSource& source, const TrackOptions& options) {
    std::vector<std::string> beside;  // columns that tracking asks for
    if (options.tracking) {
      beside = listConditions(*options.tracking);
      if (options.tracking->time.column) {
        beside.push_back(options.tracking->time.column->name);
      }
    }
    std::vector<TrialInference> inferences;
    const std::vector<KnownValue> known = parseKnownValues(options.known);
    for (const TwinSource::Member& one : source.getMembers()) {
      const MeasurementReader& reader = one.source->getReader();
      inferences.push_back({reader, one.source->makeSession(options.session),
                            collectKnown(reader.getExperiment().model.inputs, known), reader.listColumns()});
      std::vector<std::string>& columns = inferences.back().columns;
      columns.insert(columns.end(), beside.begin(), beside.end());
    }
    return inferences;
  }

  const ModelSpec& getModel() const { return source.getModel(); }
  /// Of a run whose estimates are not refined; what is simulated has none.
  Eigen::VectorXd findSharedError() const {
    const Inferrer* trained = source.getMembers().front().source->findTrained();
    return trained != nullptr && !trials.front().inference->refines() ? trained->getModel().shared_error
                                                                      : Eigen::VectorXd();
  }
  TrialInference& findTrial(const std::string& trial) { return trials[source.find(trial)]; }
  const TrackingSpec* findSpec() const { return options.tracking ? &*options.tracking : nullptr; }
  TrackView view() const { return {getModel().parameters, space, findSpec(), &twin->getDiagnoses()}; }
  fs::path getHistoryFile() const { return fs::path(state).replace_extension(".jsonl"); }

  TrackCourse calcCourse() const {
    return calcTrackCourse(history->read(model.countParameters(), model.conditions), model);
  }

  TrackRecord makeRecord(const MeasurementReader& reader, const Table& table, const std::string& digest,
                         const MeasurementContext& context) {
    TrackRecord record{table.source, digest, ""};
    record.trial = context.trial;
    record.start = context.start;
    const std::optional<double> stated = context.at ? context.at : readTrackTime(table, findSpec());
    record.measurement.time = stated ? *stated : number(record);
    const Table window = takeWindow(table, reader, context.start);
    record.measurement.conditions = readConditions(window, conditions);
    record.covariates = listCovariates(window, conditions);
    requirePlace(record);
    return record;
  }

  /// The time of what states none: its number, of what is there already that one's. Throws MeasurementError
  /// where that is older than the window, of which no more is known.
  double number(const TrackRecord& of) {
    for (const TrackRecord& record : twin->getWindow()) {
      if (record.digest == of.digest) {
        return record.measurement.time;
      }
    }
    const long long count = twin->getNow().tracker.getState().count;
    if (count > static_cast<long long>(twin->getWindow().size()) && history->contains(of.digest)) {
      throw MeasurementError(fmt::format(
          "{}: was counted before the last {} measurements, and states no time; it is not counted "
          "again. If it is another measurement, give its time (--at)",
          of.source, twin->getWindow().size()));
    }
    return static_cast<double>(count + 1);
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

  void take(const Estimate& estimate, TrackRecord& record) const {
    const Eigen::Index p = space.count();
    tracking::Measurement& measurement = record.measurement;
    record.status = joinStatuses(estimate.statuses, ", ");
    measurement.rows.resize(0, p);
    measurement.variances = Eigen::VectorXd::Constant(p, std::numeric_limits<double>::infinity());
    if (!informs(estimate, options.use)) {
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

  /// An alarm that the last measurement raised, held against terms that the model may lack.
  void diagnose(TrialInference& trial) {
    const TrackAlarm* alarm = twin->findUndiagnosed();
    if (alarm != nullptr) {
      const auto find = [&](const TrackRecord& record) {
        return shelf.find(record, trial.columns, trial.inference->getMissingCells());
      };
      const ChangeWindows windows =
          chooseChangeWindows(twin->getWindow(), twin->getNow(), alarm->change.time);
      twin->note(diagnoseAlarm(*alarm, windows, {*trial.inference, trial.known, find}));
    }
  }

  Json update(TrialInference& trial, const Table& table, const std::string& digest,
              const MeasurementContext& context, bool is_file) {
    TrackRecord record = makeRecord(trial.reader, table, digest, context);
    record.is_file = is_file;
    if (const TrackRecord* counted = twin->findSame(record)) {
      return answerAgain(*counted, table.source);
    }
    const InferredMeasurement inferred = trial.inference->infer(table, context.start, trial.known);
    const Estimate estimate = selectEstimate(inferred);
    Json json =
        makeAnswerJson(inferred, estimate, getModel().parameters, trial.reader.getExtractor().getInfos());
    const bool is_late = twin->isLate(record);
    const double time = record.measurement.time;
    take(estimate, record);
    const Eigen::Index rows = record.measurement.values.size();
    history->add(record);  // where that fails, nothing has changed
    shelf.add(trial.reader, table, record);
    const long long alarms = twin->getNow().alarm_count;
    const tracking::Step step = twin->add(std::move(record));
    changed = true;
    diagnose(trial);
    Json beside{{"at", time}, {"counted", true}, {"late", is_late}, {"updates", rows > 0}};
    if (!is_late) {
      beside["fits"] = step.is_used || rows == 0;
      beside["chi_square"] = step.chi_square;
      beside["degrees"] = step.degrees;
      beside["alarm_statistic"] = step.statistic;
    }
    addTrack(std::move(beside), alarms, json);
    return json;
  }

  /// The belief is as it is now, whatever has come since.
  Json answerAgain(const TrackRecord& counted, const std::string& name) const {
    Json json{{"source", name}, {"status", counted.status}};
    addTrack({{"at", counted.measurement.time}, {"counted", false}, {"late", false}},
             twin->getNow().alarm_count, json);
    return json;
  }

  /// alarms: how many there were before.
  void addTrack(Json beside, long long alarms, Json& json) const {
    json["track"] = makeTrackState(twin->getNow(), view());
    json["track"].update(beside);
    json["track"]["alarms"] = makeTrackAlarms(twin->getNow(), alarms, view());
  }
};

TrackSession::TrackSession(const TwinSource& source, fs::path state, TrackOptions options)
    : parts_(std::make_unique<Parts>(source, std::move(state), std::move(options))) {}

TrackSession::~TrackSession() = default;

Json TrackSession::update(const std::string& text, const std::string& name,
                          const MeasurementContext& context) {
  std::istringstream stream(text);
  Parts::TrialInference& trial = parts_->findTrial(context.trial);
  return parts_->update(trial, readCsv(stream, name, trial.columns, trial.inference->getMissingCells()),
                        digestText(text), context, false);
}

Json TrackSession::updateFile(const fs::path& file, const MeasurementContext& context) {
  Parts::TrialInference& trial = parts_->findTrial(context.trial);
  return parts_->update(trial, readTable(file, trial.columns, trial.inference->getMissingCells()),
                        toHex(calcFileDigest(file)), context, true);
}

std::optional<double> TrackSession::readTime(const fs::path& file, const std::string& trial) const {
  const TrackingSpec* tracking = parts_->findSpec();
  if (tracking == nullptr || !tracking->time.column) {
    return {};
  }
  const Parts::TrialInference& of = parts_->findTrial(trial);
  return readTrackTime(readTable(file, of.columns, of.inference->getMissingCells()), tracking);
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

std::vector<double> TrackSession::listWindows(const fs::path& file, const MeasurementContext& context,
                                              double length) const {
  const Parts::TrialInference& trial = parts_->findTrial(context.trial);
  return trial.reader.listWindows(readTable(file, trial.columns, trial.inference->getMissingCells()),
                                  context.start, length);
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
