#include <fmt/format.h>

#include "framework/diagnosis/missing_term.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/inference/joint/recording_list.hpp"
#include "framework/inference/joint/trial_reader.hpp"
#include "framework/python/arrays.hpp"
#include "framework/python/bindings.hpp"
#include "framework/python/measured_columns.hpp"
#include "framework/python/python_map.hpp"

namespace twinmap::python {
namespace {

/// Trial ("" without trials), name, and columns; without these the name is that of a file.
using Recorded = std::tuple<std::string, std::string, std::optional<NamedVectors>>;

std::vector<RecordedTable> readTables(const std::vector<Recorded>& recordings,
                                      const JointInferrer& inferrer) {
  std::vector<RecordedTable> tables;
  for (const auto& [trial, name, columns] : recordings) {
    tables.push_back({trial, name, readOrMakeTable(name, columns, inferrer.getReader(trial).listColumns())});
  }
  return tables;
}

/// Of the machine's parameters alone; none where there are none.
Eigen::MatrixXd takeDraws(const SimulatorPosterior& joint, std::size_t parameters) {
  const auto p = static_cast<Eigen::Index>(parameters);
  return joint.draws.rows() >= p ? Eigen::MatrixXd(joint.draws.topRows(p)) : Eigen::MatrixXd(p, 0);
}

/// JSON and text, as `twinmap infer --joint` prints them, and the joint draws (n, p) with their weights.
nb::tuple inferTogether(const std::string& path, const std::vector<Recorded>& recordings,
                        const RecordedWindows& windows, const Known& known, std::optional<int> draws) {
  std::vector<std::string> texts;
  for (const auto& [name, value] : known) {
    texts.push_back(fmt::format("{}={:.17g}", name, value));
  }
  const JointInferrer inferrer(loadExperimentTree(path), texts, draws);
  const RecordingList list(inferrer, readTables(recordings, inferrer), windows);
  if (list.get().size() < 2) {
    throw ExperimentError(path +
                          ": one recording alone is not inferred jointly; Experiment.infer() takes it");
  }
  JointInference inferred;
  {
    const nb::gil_scoped_release release;
    inferred = inferrer.infer(list.get());
    testModel(path, list.get(), texts, inferred);
  }
  return nb::make_tuple(makeJointJson(inferred, inferrer.getParameters()),
                        makeJointTable(inferred, inferrer.getParameters()),
                        moveToRows(takeDraws(inferred.joint, inferrer.getParameters().size())),
                        copyVector(inferred.joint.weights));
}

/// The features of a map that was trained on several trials, of a recording of each.
Eigen::VectorXd readTrials(const PythonMap& map, const std::vector<Recorded>& recordings) {
  const TrialReader reader(map.getReader().getExperiment());
  std::vector<RecordedTable> tables;
  for (const auto& [trial, name, columns] : recordings) {
    tables.push_back({trial, name, readOrMakeTable(name, columns, reader.get(trial).listColumns())});
  }
  const std::optional<Eigen::VectorXd> features = reader.read(tables);
  if (!features) {
    throw MeasurementError(
        "a map of several trials needs one whole recording of each; infer_together() takes others");
  }
  return *features;
}

}  // namespace

void bindJoint(nb::module_& module) {
  module.def(
      "read_trials",
      [](const PythonMap& map, const std::vector<Recorded>& recordings) {
        return copyVector(readTrials(map, recordings));
      },
      nb::arg("map"), nb::arg("recordings"));
  module.def(
      "infer_together",
      [](const std::string& path, const std::vector<Recorded>& recordings, const std::vector<double>& starts,
         std::optional<double> windows, const Known& known, std::optional<int> draws) {
        return inferTogether(path, recordings, {starts, windows}, known, draws);
      },
      nb::arg("path"), nb::arg("recordings"), nb::arg("starts"), nb::arg("windows"), nb::arg("known"),
      nb::arg("draws"));
}

}  // namespace twinmap::python
