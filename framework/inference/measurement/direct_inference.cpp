#include "framework/inference/measurement/direct_inference.hpp"

#include <algorithm>

#include "framework/data/measurement/recording/recorded_times.hpp"
#include "framework/experiment/check/unused_parameters.hpp"
#include "framework/inference/derived_values.hpp"
#include "framework/simulation/team_simulator.hpp"

namespace twinmap {
namespace {

/// Of experiments that differ by the times of samples at most.
bool areSame(const std::vector<FeatureSpec>& features, const std::vector<FeatureSpec>& others) {
  if (!areSamples(features) || !areSamples(others)) {
    return true;
  }
  return std::equal(features.begin(), features.end(), others.begin(), others.end(),
                    [](const FeatureSpec& feature, const FeatureSpec& other) {
                      const auto &a = std::get<SamplesFeatureSpec>(feature),
                                 &b = std::get<SamplesFeatureSpec>(other);
                      return a.outputs.front().text == b.outputs.front().text && a.start == b.start &&
                             a.interval == b.interval && a.count == b.count;
                    });
}

/// Of experiments that differ by their measured tables at most.
bool areSame(const std::vector<SignalSpec>& signals, const std::vector<SignalSpec>& others) {
  const auto same_table = [](const TableSpec& table, const TableSpec& other) {
    return table.times == other.times && table.values == other.values;
  };
  return std::equal(signals.begin(), signals.end(), others.begin(), others.end(),
                    [&](const SignalSpec& signal, const SignalSpec& other) {
                      return std::equal(signal.tables.begin(), signal.tables.end(), other.tables.begin(),
                                        other.tables.end(), same_table);
                    });
}

bool areSame(const std::optional<Name>& name, const std::optional<Name>& other) {
  return name.has_value() == other.has_value() && (!name || name->text == other->text);
}

/// One measurement is inferred at a time: all threads simulate for it.
std::unique_ptr<Simulator> makeShared(const MeasurementReader& reader, SimulatorRefiner::Model model) {
  const ModelSpec& spec = reader.getExperiment().model;
  const ResponseLayout& layout = reader.getLayout();
  return shareAmongThreads(model == SimulatorRefiner::Model::kTrusted
                               ? makeTrustedSimulator(spec, layout.times, layout.modes)
                               : makeSimulator(spec, layout.times, layout.modes));
}

}  // namespace

DirectInference::DirectInference(const MeasurementReader& reader, int draws, SimulatorRefiner::Model model,
                                 bool profiles)
    : setup_{std::shared_ptr<const MeasurementReader>(std::shared_ptr<void>(), &reader),
             std::make_shared<const SimulatorRefiner>(reader.getExperiment(), reader.getLayout(),
                                                      makeShared(reader, model))},
      options_(makePosteriorOptions(reader.getExperiment(), draws)),
      quantities_(makeDerivedQuantities(reader.getExperiment())),
      prior_(findStatedPrior(reader.getExperiment().model)),
      unused_(listUnused(reader.getExperiment(), "parameters")) {
  options_.profiles = profiles;
  setup_.simulator->requireNoise();
}

InferredMeasurement DirectInference::infer(const Table& table, std::optional<double> start,
                                           const Eigen::VectorXd& known) {
  const RecordingSetup* followed = follow(table, start);
  if (followed == nullptr) {
    getReader().warnOfInterpolation(table, start);
  }
  const RecordingSetup& setup = followed != nullptr ? *followed : setup_;
  ExplainedRecording explained =
      explainRecording(setup, readFeatures(*setup.reader, table, start), table, start, known, options_);
  nameUnstatedNoise(explained);
  InferredMeasurement& inferred = explained.inferred;
  if (followed != nullptr &&
      !areSame(followed->reader->getExperiment().features, getReader().getExperiment().features)) {
    inferred.remarks.emplace_back(
        "features are taken at the times of the recording, between which nothing is interpolated");
  }
  describe(inferred);
  return std::move(inferred);
}

const RecordingSetup* DirectInference::follow(const Table& table, std::optional<double> start) {
  std::optional<ExperimentSpec> experiment = getReader().follow(table, start);
  if (!experiment) {
    return nullptr;
  }
  const ExperimentSpec* last = followed_ ? &followed_->reader->getExperiment() : nullptr;
  if (last == nullptr || !areSame(last->features, experiment->features) ||
      !areSame(last->model.excitation, experiment->model.excitation) ||
      !areSame(last->measurement.modes, experiment->measurement.modes)) {
    followed_ = makeSetup(std::make_shared<const MeasurementReader>(std::move(*experiment)));
  }
  return &*followed_;
}

InferredMeasurement DirectInference::infer(const Eigen::VectorXd& features, const Eigen::VectorXd& known) {
  InferredMeasurement inferred;
  const SimulatorRefiner& simulator = *setup_.simulator;
  const std::string failure = simulator.findFailure(known);
  if (failure.empty()) {
    inferred.posterior =
        simulator.samplePosterior(features, known, simulator.describeNoise({}), {}, options_).estimate;
    inferred.ridges = simulator.findRidges(*inferred.posterior, known);
  } else {
    inferred.posterior = simulator.makeFailed(features, known, failure);
  }
  describe(inferred);
  return inferred;
}

void DirectInference::tryNuisance(const AvailableFeatures& found, const Eigen::VectorXd& known,
                                  InferredMeasurement& inferred) const {
  ExplainedRecording explained{setup_, found, known, {}, {}, std::move(inferred)};
  twinmap::tryNuisance(options_, explained);
  inferred = std::move(explained.inferred);
}

void DirectInference::describe(InferredMeasurement& inferred) const {
  inferred.quantities = quantities_;
  inferred.prior = prior_;
  inferred.unused = unused_;
}

}  // namespace twinmap
