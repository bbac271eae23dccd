#include <pybind11/stl.h>

#include "framework/base/files/atomic_file.hpp"
#include "framework/diagnosis/text/corrected_file.hpp"
#include "framework/diagnosis/text/diagnosis_text.hpp"
#include "framework/python/bindings.hpp"
#include "framework/python/measured_columns.hpp"
#include "framework/python/python_map.hpp"
#include "framework/study/diagnosis/diagnosis_page.hpp"

namespace twinmap::python {
namespace {

/// Name and columns; without these the name is that of a file.
using Recorded = std::pair<std::string, std::optional<NamedVectors>>;

RecordedFeatures readTables(const MeasurementReader& reader, const std::vector<Recorded>& recordings,
                            const std::vector<double>& starts, const Eigen::VectorXd& known) {
  std::vector<std::optional<double>> from(starts.begin(), starts.end());
  if (from.empty()) {
    from.emplace_back();
  }
  RecordedFeatures all{reader.getLayout(), {}, known};
  for (const auto& [name, columns] : recordings) {
    const Table table = readOrMakeTable(name, columns, reader.listColumns());
    for (const std::optional<double>& start : from) {
      append(readRecording(reader, table, start, known), all);
    }
  }
  return all;
}

/// JSON and text, as `twinmap diagnose` prints them, and the corrected experiment. page: file for the page,
/// or
/// "".
py::tuple diagnoseRecordings(const PythonMap& map, const std::vector<Recorded>& recordings,
                             const std::vector<double>& starts, const Known& known,
                             const std::vector<std::string>& accepted, const std::string& page) {
  const MeasurementReader& reader = map.getReader();
  const RecordedFeatures read =
      readTables(reader, recordings, starts, collectKnown(reader.getExperiment().model.inputs, known));
  DiagnosisOptions options;
  options.accepted = accepted;
  options.posterior = makePosteriorOptions(reader.getExperiment(), SimulatorPosteriorOptions{}.draws);
  std::vector<std::string> sources;
  std::string names;
  for (const Recorded& one : recordings) {
    sources.push_back(one.first);
    names += (names.empty() ? "" : ", ") + one.first;
  }
  Diagnosis diagnosis;
  {
    const py::gil_scoped_release release;
    diagnosis = diagnose(reader.getExperiment(), read, options);
    if (!page.empty()) {
      writeTextFile(
          page, makeDiagnosisPage(diagnosis, reader.getExperiment(), read, nameRecordings(sources, starts)));
    }
  }
  return py::make_tuple(makeDiagnosisJson(diagnosis, names), makeDiagnosisTable(diagnosis, names),
                        writeCorrected(diagnosis.corrected));
}

/// JSON and text, as `twinmap diagnose` without recordings prints them.
py::tuple findBlindSpots(const PythonMap& map, const Known& known) {
  const MeasurementReader& reader = map.getReader();
  RecordedFeatures recordings = readRecordings(reader, {}, {}, {});
  recordings.known = collectKnown(reader.getExperiment().model.inputs, known);
  recordings.features = {Eigen::VectorXd::Zero(reader.getExtractor().getFeatureCount())};
  std::vector<BlindSpot> spots;
  {
    const py::gil_scoped_release release;
    spots = calcBlindSpots(reader.getExperiment(), recordings, DiagnosisOptions{}.level);
  }
  const std::vector<ParameterSpec>& parameters = reader.getExperiment().model.parameters;
  return py::make_tuple(makeBlindSpotJson(spots, parameters), makeBlindSpotTable(spots, parameters));
}

}  // namespace

void bindDiagnosis(py::module_& module) {
  module.def("diagnose", &diagnoseRecordings, py::arg("map"), py::arg("recordings"), py::arg("starts"),
             py::arg("known"), py::arg("accepted"), py::arg("page"));
  module.def("find_blind_spots", &findBlindSpots, py::arg("map"), py::arg("known"));
}

}  // namespace twinmap::python
