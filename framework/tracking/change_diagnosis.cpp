#include "framework/tracking/change_diagnosis.hpp"

#include <fmt/core.h>

#include <exception>

#include "framework/base/json/json.hpp"
#include "framework/base/log/search_stage.hpp"
#include "framework/diagnosis/change_or_term.hpp"
#include "framework/diagnosis/scored_candidates.hpp"

namespace twinmap {
namespace {

/// Adds those that are at hand and can be inferred; how many.
std::size_t addRecordings(const std::vector<const TrackRecord*>& records, const ChangeRecorder& recorder,
                          ChangeRecordings& recordings) {
  std::size_t count = 0;
  const MeasurementReader& reader = recorder.inference.getReader();
  for (const TrackRecord* record : records) {
    const std::optional<KeptTable> kept = recorder.find(*record);
    if (!kept) {
      continue;
    }
    try {
      RecordedFeatures one = readRecording(reader, kept->table, kept->start, recorder.known);
      recordings.inferred.push_back(recorder.inference.infer(kept->table, kept->start, recorder.known));
      append(one, recordings.all);
      ++count;
    } catch (const MeasurementError&) {
      // the file is another by now, or not a recording of the model
    }
  }
  return count;
}

std::string sayWithout(const std::string& why) {
  return "no term that the model may lack was held against it: " + why;
}

Json describe(const ChangeOrTerm& weighed, std::size_t before, std::size_t after,
              const std::vector<ParameterSpec>& parameters) {
  const std::string sides = fmt::format("{} recordings before it and {} behind", before, after);
  Json json{{"before", before}, {"after", after}, {"terms", weighed.tested}};
  json["log_evidence"] = weighed.change.log_evidence;
  json["changed"] = Json::array();
  for (const std::size_t parameter : weighed.change.parameters) {
    json["changed"].push_back(parameters[parameter].name.text);
  }
  if (!weighed.rival) {
    json["says"] =
        weighed.change.parameters.empty()
            ? fmt::format("{} do not show it by themselves, nor a term that the model lacks", sides)
            : fmt::format("none of {} terms explains {} as well with one set of parameters", weighed.tested,
                          sides);
    return json;
  }
  const MissingTerm& term = weighed.rival->term;
  json["term"] = term.term;
  json["meaning"] = term.meaning;
  json["size"] = term.size;
  json["sd"] = term.stddev;
  json["unit"] = term.unit;
  json["log_evidence_over_change"] = weighed.rival->over_change;
  json["explains"] = term.explains;
  json["or"] = term.rivals;
  json["says"] =
      fmt::format("one set of parameters with {} explains {} as well as a change does", term.term, sides);
  return json;
}

Json weigh(const ChangeWindows& windows, const ChangeRecorder& recorder) {
  const MeasurementReader& reader = recorder.inference.getReader();
  const ExperimentSpec& experiment = reader.getExperiment();
  if (reader.findReduction() != nullptr) {
    return {{"says", sayWithout("the run looks at a part of the samples")}};
  }
  requireSystem(experiment);
  ChangeRecordings recordings{{reader.getLayout(), {}, recorder.known}};
  recordings.before = addRecordings(windows.before, recorder, recordings);
  const std::size_t after = addRecordings(windows.after, recorder, recordings);
  if (recordings.before == 0 || after == 0) {
    const char* side = recordings.before == 0 ? "before it" : "behind it";
    return {{"says", sayWithout(fmt::format("no recording from {} is at hand any more", side))}};
  }
  const SearchStage stage("hold the change against terms that the model may lack");
  return describe(weighChangeOrTerm(experiment, recordings), recordings.before, after,
                  experiment.model.parameters);
}

}  // namespace

AlarmDiagnosis diagnoseAlarm(const TrackAlarm& alarm, const ChangeWindows& windows,
                             const ChangeRecorder& recorder) {
  AlarmDiagnosis diagnosis{alarm.announced, alarm.is_of_several, alarm.change.parameter, alarm.change.time};
  Json json;
  try {
    json = weigh(windows, recorder);
  } catch (const std::exception& error) {  // terms that are not known, or nothing can be simulated
    json = {{"says", sayWithout(error.what())}};
  }
  diagnosis.answer = formatJson(json);
  return diagnosis;
}

}  // namespace twinmap
