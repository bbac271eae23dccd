#include <algorithm>

#include "framework/data/measurement/files/read_table.hpp"
#include "framework/diagnosis/missing_term.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/known_value.hpp"
#include "framework/inference/segments/segment_inference.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/inference/text/inference_text.hpp"
#include "framework/python/arrays.hpp"
#include "framework/python/bindings.hpp"
#include "framework/python/measured_columns.hpp"
#include "framework/python/python_experiment.hpp"
#include "framework/python/python_map.hpp"
#include "framework/python/quantity.hpp"

namespace twinmap::python {
namespace {

/// How measurements are to be taken.
struct InferRequest {
  Known known;
  std::optional<double> start;
  SessionOptions options;
};

/// posterior_from: "simulator", "surrogate" or "", which is neither.
InferRequest makeRequest(Known known, std::optional<double> start, std::optional<bool> refine,
                         int posterior_draws, const std::string& posterior_from, bool profiles) {
  SessionOptions options{refine, posterior_draws, {}};
  options.profiles = profiles;
  for (const PosteriorSource source : {PosteriorSource::kSurrogate, PosteriorSource::kSimulator}) {
    if (posterior_from == toString(source)) {
      options.posterior_from = source;
    }
  }
  return {std::move(known), start, options};
}

/// What Python makes its Estimate of.
struct InferredEstimate {
  InferredMeasurement measurement;
  Estimate estimate;
};

/// Infers by a borrowed session, without the interpreter's lock; `infer` takes it and the known inputs.
template <class Infer>
InferredEstimate inferBy(PythonMap& map, const InferRequest& request, const Infer& infer) {
  const nb::gil_scoped_release release;
  const Eigen::VectorXd known = collectKnown(map.getReader().getExperiment().model.inputs, request.known);
  PythonMap::Session session = map.borrow(request.options);
  InferredMeasurement measurement = infer(*session, known);
  map.giveBack(request.options, std::move(session));
  Estimate estimate = selectEstimate(measurement);
  return {std::move(measurement), std::move(estimate)};
}

/// As the command does.
InferredMeasurement inferAndTest(const PythonMap& map, MeasurementInference& session,
                                 const InferRequest& request, const Eigen::VectorXd& known,
                                 const Table& table) {
  InferredMeasurement measurement = session.infer(table, request.start, known);
  testModel(map.getReader(), table, request.start, known, measurement);
  return measurement;
}

InferredEstimate inferFile(PythonMap& map, const std::string& path, const InferRequest& request) {
  return inferBy(map, request, [&](MeasurementInference& session, const Eigen::VectorXd& known) {
    return inferAndTest(map, session, request, known,
                        readTable(path, map.getReader().listColumns(), session.getMissingCells()));
  });
}

InferredEstimate inferColumns(PythonMap& map, const NamedVectors& columns, const InferRequest& request) {
  const std::vector<NamedColumn> named = viewNamed(columns);
  return inferBy(map, request, [&](MeasurementInference& session, const Eigen::VectorXd& known) {
    const Table table =
        makeTable("measurement", named, map.getReader().listColumns(), session.getMissingCells());
    return inferAndTest(map, session, request, known, table);
  });
}

InferredEstimate inferFeatures(PythonMap& map, const Vector& features, const InferRequest& request) {
  const Eigen::VectorXd values = viewVector(features, "features");
  const Eigen::Index count = map.getReader().getExtractor().getFeatureCount();
  if (values.size() != count || !values.allFinite()) {
    throw MeasurementError("features: must be " + std::to_string(count) + " finite numbers");
  }
  return inferBy(map, request, [&](MeasurementInference& session, const Eigen::VectorXd& known) {
    return session.infer(values, known);
  });
}

/// A recording in segments of so many seconds. Columns: without these, the file that the name is of.
InferredEstimate inferSegments(const PythonMap& map, const std::string& name,
                               const std::optional<NamedVectors>& columns, double length,
                               const InferRequest& request) {
  const ExperimentSpec& experiment = map.getReader().getExperiment();
  const SegmentInference inference(experiment, length, collectKnown(experiment.model.inputs, request.known),
                                   request.options.posterior_draws);
  const Table table = readOrMakeTable(name, columns, inference.listColumns());
  const nb::gil_scoped_release release;
  InferredMeasurement measurement = inference.infer(table, request.start);
  Eigen::MatrixXd& points = measurement.posterior->estimate.draws.points;
  const auto machine = static_cast<Eigen::Index>(experiment.model.parameters.size());
  points = Eigen::MatrixXd(
      points.topRows(std::min(machine, points.rows())));  // nuisances have an order of their own
  Estimate estimate = selectEstimate(measurement);
  return {std::move(measurement), std::move(estimate)};
}

nb::tuple predict(const PythonMap& map, const Rows& features, const Rows& known, int threads) {
  const Inferrer& inferrer = map.getTrained();
  const auto inputs = static_cast<Eigen::Index>(inferrer.getExperiment().model.inputs.size());
  const auto columns = viewColumns(features, inferrer.getExtractor().getFeatureCount(), "X");
  const auto settings = viewColumns(known, inputs, "inputs");
  Estimates estimates;
  {
    const nb::gil_scoped_release release;
    estimates = inferrer.getMap().predict(columns, settings, threads);
  }
  return nb::make_tuple(moveToRows(std::move(estimates.mean)), moveToRows(std::move(estimates.stddev)));
}

std::unique_ptr<PythonMap> loadMap(const std::string& run_or_maps) {
  return std::make_unique<PythonMap>(run_or_maps);
}

std::unique_ptr<PythonMap> makeMap(const PythonExperiment& experiment) {
  return std::make_unique<PythonMap>(experiment.getSpec());
}

const ModelSpec& getModel(const PythonMap& map) {
  return map.getReader().getExperiment().model;
}

const std::vector<FeatureInfo>& listFeatures(const PythonMap& map, const InferredEstimate& inferred) {
  return inferred.measurement.segments ? inferred.measurement.segments->samples
                                       : map.getReader().getExtractor().getInfos();
}

std::string writeJson(const PythonMap& map, const InferredEstimate& inferred) {
  return makeInferenceJson(inferred.measurement, getModel(map).parameters, listFeatures(map, inferred));
}

std::string writeText(const PythonMap& map, const InferredEstimate& inferred) {
  return makeInferenceTable(inferred.measurement, getModel(map).parameters, listFeatures(map, inferred));
}

void bindPosterior(nb::module_& module) {
  using Posterior = PosteriorEstimate;
  nb::class_<Posterior>(module, "Posterior")
      .def_prop_ro("mean", [](const Posterior& s) { return copyVector(s.estimate.mean); })
      .def_prop_ro("stddev", [](const Posterior& s) { return copyVector(s.estimate.stddev); })
      .def_prop_ro("quantiles", [](const Posterior& s) { return moveToRows(calcQuantiles(s.estimate)); })
      .def_prop_ro("draws",
                   [](const Posterior& s) { return moveToRows(Eigen::MatrixXd(s.estimate.draws.points)); })
      .def_prop_ro("weights", [](const Posterior& s) { return copyVector(s.estimate.draws.weights); })
      .def_prop_ro("source", [](const Posterior& s) { return toString(s.source); })
      .def_ro("effective_sample_size", &Posterior::effective_sample_size)
      .def_ro("pareto_shape", &Posterior::pareto_shape)
      .def_ro("evaluations", &Posterior::evaluations)
      .def_ro("message", &Posterior::message);
}

/// Of each component that may fit its weight, mean and standard deviation; none of an estimate that is one.
nb::list listComponents(const Mixture& mixture) {
  nb::list components;
  for (Eigen::Index c = 0; c < mixture.countComponents(); ++c) {
    components.append(nb::make_tuple(mixture.weights[c], copyVector(Eigen::VectorXd(mixture.means.col(c))),
                                     copyVector(Eigen::VectorXd(mixture.stddevs.col(c)))));
  }
  return components;
}

/// Of each parameter its intervals, lower and upper bound each.
std::vector<Intervals> listIntervals(const Estimate& estimate, Coverage coverage) {
  std::vector<Intervals> intervals;
  for (Eigen::Index p = 0; p < estimate.mean.size(); ++p) {
    intervals.push_back(estimate.findIntervals(p, coverage));
  }
  return intervals;
}

void bindEstimate(nb::module_& module) {
  using Inferred = InferredEstimate;
  nb::class_<Inferred>(module, "Estimate")
      .def_prop_ro("mean", [](const Inferred& i) { return copyVector(i.estimate.mean); })
      .def_prop_ro("stddev", [](const Inferred& i) { return copyVector(i.estimate.stddev); })
      .def_prop_ro("covariance", [](const Inferred& i) { return moveToRows(i.estimate.calcCovariance()); })
      .def_prop_ro("intervals50", [](const Inferred& i) { return listIntervals(i.estimate, Coverage::k50); })
      .def_prop_ro("intervals95", [](const Inferred& i) { return listIntervals(i.estimate, Coverage::k95); })
      .def_prop_ro("components", [](const Inferred& i) { return listComponents(i.estimate.mixture); })
      .def_prop_ro("statuses", [](const Inferred& i) { return i.estimate.statuses; })
      .def_prop_ro("method", [](const Inferred& i) { return i.estimate.getMethod(); })
      .def_prop_ro("posterior", [](const Inferred& i) { return i.measurement.posterior; });
  nb::class_<InferRequest>(module, "InferRequest")
      .def(
          "__init__",
          [](InferRequest* made, Known known, std::optional<double> start, std::optional<bool> refine,
             int posterior_draws, const std::string& posterior_from, bool profiles) {
            new (made) InferRequest(
                makeRequest(std::move(known), start, refine, posterior_draws, posterior_from, profiles));
          },
          nb::arg("known"), nb::arg("start"), nb::arg("refine"), nb::arg("posterior_draws"),
          nb::arg("posterior_from"), nb::arg("profiles"));
}

}  // namespace

void bindMap(nb::module_& module) {
  bindPosterior(module);
  bindEstimate(module);
  nb::class_<PythonMap>(module, "Map")
      .def_static("load", &loadMap, nb::call_guard<nb::gil_scoped_release>())
      .def_static("of_experiment", &makeMap)
      .def("infer_file", &inferFile)
      .def("infer_columns", &inferColumns)
      .def("infer_features", &inferFeatures)
      .def("infer_segments", &inferSegments, nb::arg("name"), nb::arg("columns"), nb::arg("length"),
           nb::arg("request"))
      .def("write_json", &writeJson)
      .def("write_text", &writeText)
      .def("predict", &predict, nb::arg("features"), nb::arg("inputs"), nb::arg("threads"))
      .def_prop_ro("parameters", [](const PythonMap& m) { return describe(getModel(m).parameters); })
      .def_prop_ro("unknown", [](const PythonMap& m) { return describe(collectUnknown(getModel(m))); })
      .def_prop_ro("inputs", [](const PythonMap& m) { return describe(getModel(m).inputs); })
      .def_prop_ro("outputs", [](const PythonMap& m) { return describeOutputs(m.getReader().getLayout()); })
      .def_prop_ro("features",
                   [](const PythonMap& m) { return describe(m.getReader().getExtractor().getInfos()); })
      .def_prop_ro("name", [](const PythonMap& m) { return m.getReader().getExperiment().name.text; })
      .def_prop_ro("residual_correlation",
                   [](const PythonMap& m) {
                     return moveToRows(Eigen::MatrixXd(m.getTrained().getMap().getResidualCorrelation()));
                   })
      .def("write_experiment",
           [](const PythonMap& m) { return writeExperiment(m.getReader().getExperiment()); });
}

}  // namespace twinmap::python
