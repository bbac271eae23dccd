
#include "framework/base/files/atomic_file.hpp"
#include "framework/diagnosis/problem/sensor_faults.hpp"
#include "framework/diagnosis/text/corrected_file.hpp"
#include "framework/diagnosis/text/diagnosis_text.hpp"
#include "framework/inference/joint/recording_list.hpp"
#include "framework/python/bindings.hpp"
#include "framework/python/measured_columns.hpp"
#include "framework/python/python_map.hpp"
#include "framework/study/diagnosis/diagnosis_page.hpp"

namespace twinmap::python {
namespace {

/// Name and columns; without these the name is that of a file.
using Recorded = std::pair<std::string, std::optional<NamedVectors>>;

std::vector<RecordedTable> readTables(const std::vector<Recorded>& recordings,
                                      const std::vector<std::string>& columns) {
  std::vector<RecordedTable> tables;
  for (const auto& [name, values] : recordings) {
    tables.push_back({"", name, readOrMakeTable(name, values, columns)});
  }
  return tables;
}

/// JSON and text, as `twinmap diagnose` prints them, and the corrected experiment. page: its file, or "".
nb::tuple diagnoseRecordings(const PythonMap& map, const std::vector<Recorded>& recordings,
                             const std::vector<double>& starts, const Known& known,
                             const std::vector<std::string>& accepted, const std::string& page) {
  const MeasurementReader& reader = map.getReader();
  const ExperimentSpec& experiment = reader.getExperiment();
  const std::vector<KnownValue> values = listKnown(known);
  const JointInferrer inferrer(experiment, values);
  const RecordingList list(inferrer, readTables(recordings, reader.listColumns()), {starts, {}});
  DiagnosisOptions options;
  options.accepted = accepted;
  options.posterior = makePosteriorOptions(experiment, SimulatorPosteriorOptions{}.draws);
  std::vector<std::string> sources;
  std::string names;
  for (const Recorded& one : recordings) {
    sources.push_back(one.first);
    names += (names.empty() ? "" : ", ") + one.first;
  }
  Diagnosis diagnosis;
  {
    const nb::gil_scoped_release release;
    const DiagnosedRecordings read = explainSensors(inferrer, experiment, list.get(), values);
    diagnosis = diagnoseExplained(experiment, read, options);
    if (!page.empty()) {
      writeTextFile(page,
                    makeDiagnosisPage(diagnosis, experiment, read.features, nameRecordings(sources, starts)));
    }
  }
  return nb::make_tuple(makeDiagnosisJson(diagnosis, names), makeDiagnosisTable(diagnosis, names),
                        writeCorrected(diagnosis.corrected));
}

/// JSON and text, as `twinmap diagnose` without recordings prints them.
nb::tuple findBlindSpots(const PythonMap& map, const Known& known) {
  const MeasurementReader& reader = map.getReader();
  const RecordedFeatures recordings = makeEmptyRecordings(reader.getExperiment(), listKnown(known));
  std::vector<BlindSpot> spots;
  {
    const nb::gil_scoped_release release;
    spots = calcBlindSpots(reader.getExperiment(), recordings, DiagnosisOptions{}.level);
  }
  const std::vector<ParameterSpec>& parameters = reader.getExperiment().model.parameters;
  return nb::make_tuple(makeBlindSpotJson(spots, parameters), makeBlindSpotTable(spots, parameters));
}

}  // namespace

void bindDiagnosis(nb::module_& module) {
  module.def("diagnose", &diagnoseRecordings, nb::arg("map"), nb::arg("recordings"), nb::arg("starts"),
             nb::arg("known"), nb::arg("accepted"), nb::arg("page"));
  module.def("find_blind_spots", &findBlindSpots, nb::arg("map"), nb::arg("known"));
}

}  // namespace twinmap::python
