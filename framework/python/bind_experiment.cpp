#include "framework/data/noise/noise.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/python/arrays.hpp"
#include "framework/python/bindings.hpp"
#include "framework/python/interruptible.hpp"
#include "framework/python/python_experiment.hpp"
#include "framework/python/quantity.hpp"
#include "framework/simulation/sample_generator.hpp"

namespace twinmap::python {
namespace {

using Texts = std::vector<std::string>;

std::unique_ptr<PythonExperiment> loadExperiment(const std::string& path, const Texts& overrides) {
  return std::make_unique<PythonExperiment>(loadExperimentTree(path, overrides));
}

std::unique_ptr<PythonExperiment> parse(const std::string& text, const std::string& source,
                                        const Texts& overrides) {
  return std::make_unique<PythonExperiment>(parseExperimentTree(text, source, overrides));
}

std::string writeYaml(const PythonExperiment& experiment) {
  return experiment.isSweep() ? writeIndependentDefaults(experiment.getTree())
                              : writeExperiment(experiment.getSpec());
}

/// Responses (n, rows), and of each sample why it failed, or "".
nb::tuple simulate(const PythonExperiment& experiment, const Rows& points, int threads) {
  const Eigen::MatrixXd parameters = viewColumns(points, countSampled(experiment.getSpec().model), "points");
  std::atomic<bool> stop{false};
  Trajectories trajectories;
  runInterruptibly(
      [&] {
        GeneratorOptions options;
        options.threads = threads;
        options.stop = &stop;
        trajectories = generateSamples(*experiment.getSimulator(), parameters, options);
      },
      stop);
  Texts reasons;
  for (const SampleStatus& status : trajectories.statuses) {
    reasons.push_back(status.ok ? "" : status.reason);
  }
  return nb::make_tuple(moveToRows(std::move(trajectories.responses)), reasons);
}

Array extract(const PythonExperiment& experiment, const Rows& responses) {
  const auto columns = viewColumns(responses, experiment.getLayout().getRowCount(), "responses");
  Eigen::MatrixXd features;
  {
    const nb::gil_scoped_release release;
    features = experiment.getExtractor()->extract(columns);
  }
  return moveToRows(std::move(features));
}

Array addMeasurementNoise(const PythonExperiment& experiment, const Rows& responses, std::uint64_t seed) {
  const auto columns = viewColumns(responses, experiment.getLayout().getRowCount(), "responses");
  Eigen::MatrixXd noisy;
  {
    const nb::gil_scoped_release release;
    noisy = addNoise(columns, ResponseNoise(experiment.getSpec().noise, experiment.getLayout()),
                     RandomStream(seed, RandomPurpose::kSingleNoise));
  }
  return moveToRows(std::move(noisy));
}

}  // namespace

void bindExperiment(nb::module_& module) {
  const auto release = nb::call_guard<nb::gil_scoped_release>();
  nb::class_<PythonExperiment>(module, "Experiment")
      .def_static("load", &loadExperiment, release)
      .def_static("parse", &parse, release)
      .def("write_yaml", &writeYaml, release)
      .def_prop_ro("name", [](const PythonExperiment& e) { return e.getSpec().name.text; })
      .def_prop_ro("description", [](const PythonExperiment& e) { return e.getSpec().description; })
      .def_prop_ro("seed", [](const PythonExperiment& e) { return e.getSpec().seed; })
      .def_prop_ro("is_sweep", &PythonExperiment::isSweep)
      .def_prop_ro("parameters",
                   [](const PythonExperiment& e) { return describe(e.getSpec().model.parameters); })
      .def_prop_ro("sampled",
                   [](const PythonExperiment& e) { return describe(collectSampled(e.getSpec().model)); })
      .def_prop_ro("inputs", [](const PythonExperiment& e) { return describe(e.getSpec().model.inputs); })
      .def_prop_ro("outputs", [](const PythonExperiment& e) { return describeOutputs(e.getLayout()); })
      .def_prop_ro("features",
                   [](const PythonExperiment& e) { return describe(e.getExtractor()->getInfos()); })
      .def_prop_ro("times", [](const PythonExperiment& e) { return copyVector(e.getLayout().times); })
      .def_prop_ro("modes", [](const PythonExperiment& e) { return e.getLayout().modes; })
      .def("simulate", &simulate, nb::arg("points"), nb::arg("threads"))
      .def("extract", &extract, nb::arg("responses"))
      .def("add_noise", &addMeasurementNoise, nb::arg("responses"), nb::arg("seed"));
}

}  // namespace twinmap::python
