#include "framework/inference/measurement/direct_inference.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/log/notice.hpp"
#include "framework/base/log/search_stage.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/data/measurement/recording/recorded_times.hpp"
#include "framework/experiment/check/unused_parameters.hpp"
#include "framework/inference/clock/clock_search.hpp"
#include "framework/inference/derived_values.hpp"
#include "framework/inference/measurement/alternation.hpp"
#include "framework/inference/measurement/measurement_faults.hpp"
#include "framework/inference/measurement/spikes.hpp"
#include "framework/inference/measurement/supposed_input.hpp"
#include "framework/inference/measurement/unknown_excitation.hpp"
#include "framework/inference/measurement/unstated_noise.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/models/model_remarks.hpp"
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

/// Throws where a table of modes lacks all that a feature asks for, as where a column has another name.
void requireModes(const AvailableFeatures& found, const MeasurementReader& reader,
                  const std::string& source) {
  const ResponseLayout& layout = reader.getLayout();
  const auto is_missing = [&](Eigen::Index first) {
    return found.response.segment(first, layout.modes).array().isNaN().all();
  };
  if (layout.modes == 0 || found.response.size() != layout.getRowCount()) {
    return;
  }
  const bool no_frequencies = is_missing(layout.getFrequencyRow(0)),
             no_ratios = is_missing(layout.getDampingRow(0));
  for (const FeatureSpec& feature : reader.getExperiment().features) {
    const auto* modes = std::get_if<ModesFeatureSpec>(&feature);
    const bool lacks_all = modes != nullptr && no_frequencies != no_ratios &&
                           ((modes->frequencies && no_frequencies) || (modes->damping_ratios && no_ratios));
    if (lacks_all) {
      const char* column = no_frequencies ? "frequency" : "damping_ratio";
      const char* key = no_frequencies ? "frequencies" : "damping_ratios";
      throw MeasurementError(
          fmt::format("{}: its table of modes has no numbers in a column '{}', which features ask for; name "
                      "the column so, "
                      "or write modes: {{..., {}: false}}",
                      source, column, key));
    }
  }
}

std::vector<std::string> listMeasured(const ModelSpec& model) {
  std::vector<std::string> names;
  for (const SignalSpec& signal : model.excitation) {
    if (std::any_of(signal.tables.begin(), signal.tables.end(),
                    [](const TableSpec& table) { return table.measured.has_value(); })) {
      names.push_back(signal.name.text);
    }
  }
  return names;
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

/// An inference whose features are at the times of a table, and whose excitation is the table's.
struct DirectInference::LikeRecording {
  LikeRecording(ExperimentSpec experiment, const SimulatorPosteriorOptions& options)
      : reader(std::move(experiment)),
        inference(reader, options.draws, SimulatorRefiner::Model::kTrusted, options.profiles) {}

  const MeasurementReader reader;
  DirectInference inference;
};

DirectInference::~DirectInference() = default;

DirectInference::DirectInference(const MeasurementReader& reader, int draws, SimulatorRefiner::Model model,
                                 bool profiles)
    : reader_(reader),
      simulator_(reader.getExperiment(), reader.getLayout(), makeShared(reader, model)),
      options_(makePosteriorOptions(reader.getExperiment(), draws)),
      quantities_(makeDerivedQuantities(reader.getExperiment())),
      prior_(findStatedPrior(reader.getExperiment().model)),
      unused_(listUnused(reader.getExperiment(), "parameters")) {
  options_.profiles = profiles;
  simulator_.requireNoise();
}

InferredMeasurement DirectInference::infer(const Table& table, std::optional<double> start,
                                           const Eigen::VectorXd& known) {
  if (LikeRecording* followed = follow(table, start)) {
    InferredMeasurement inferred =
        followed->inference.infer(table, start, followed->reader.readAvailableFeatures(table, start), known);
    if (!areSame(followed->reader.getExperiment().features, reader_.getExperiment().features)) {
      inferred.remarks.emplace_back(
          "features are taken at the times of the recording, between which nothing is interpolated");
    }
    return inferred;
  }
  const AvailableFeatures found = reader_.readAvailableFeatures(table, start);
  reader_.warnOfInterpolation(table, start);
  return infer(table, start, found, known);
}

DirectInference::LikeRecording* DirectInference::follow(const Table& table, std::optional<double> start) {
  std::optional<ExperimentSpec> experiment = reader_.follow(table, start);
  if (!experiment) {
    return nullptr;
  }
  const ExperimentSpec* last = followed_ ? &followed_->reader.getExperiment() : nullptr;
  if (last == nullptr || !areSame(last->features, experiment->features) ||
      !areSame(last->model.excitation, experiment->model.excitation) ||
      !areSame(last->measurement.modes, experiment->measurement.modes)) {
    followed_ = std::make_unique<LikeRecording>(std::move(*experiment), options_);
  }
  return followed_.get();
}

InferredMeasurement DirectInference::infer(const Table& table, std::optional<double> start,
                                           const AvailableFeatures& read, const Eigen::VectorXd& known) {
  requireModes(read, reader_, table.source);
  AvailableFeatures found = read;
  const std::unique_ptr<const SimulatorRefiner> own =
      makeOwnSimulator(reader_, simulator_, found, known, options_);
  const SimulatorRefiner& simulator = own ? *own : simulator_;
  InferredMeasurement inferred = infer(simulator, found.features, known, found.clipped);
  tryWithoutSpikes(simulator, found, known, inferred);
  tryWithoutAlternation(simulator, found, known, inferred);
  inferred.source = table.source;
  inferred.start = reader_.getStart(table, start);
  inferred.left_out = found.remarks;
  const std::vector<std::string> bridged = describeBridged(reader_.getExperiment().model);
  inferred.remarks.insert(inferred.remarks.end(), bridged.begin(), bridged.end());
  if (tryClock(found, known, inferred)) {
    return inferred;
  }
  inferred.fault = explainMisfit(simulator, found, known, *inferred.posterior);
  inferred.against = listAgainst(found, known, inferred);
  if (inferred.fault.empty()) {
    const std::vector<std::string> noisy =
        describeUnstatedNoise(reader_, simulator, found, known, *inferred.posterior);
    inferred.remarks.insert(inferred.remarks.end(), noisy.begin(), noisy.end());
  }
  return inferred;
}

std::vector<std::string> DirectInference::listAgainst(const AvailableFeatures& found,
                                                      const Eigen::VectorXd& known,
                                                      const InferredMeasurement& inferred) const {
  const std::string status = listStatuses(inferred).front();
  const bool explains_nothing = status == getNotice(Notice::kNotSimulated).name ||
                                status == getNotice(Notice::kModelMismatch).name ||
                                status == getNotice(Notice::kUnreliable).name;
  if (!explains_nothing || !inferred.fault.empty()) {
    return {};
  }
  std::vector<std::string> against = listModelRemarks(reader_.getExperiment().model);
  const SimulatorFit& fit = *inferred.posterior->fit;
  if (const std::string grams = fit.isSimulated() ? explainByGrams(found, known, fit) : ""; !grams.empty()) {
    against.push_back(grams);
  }
  return against;
}

std::string DirectInference::explainByGrams(const AvailableFeatures& found, const Eigen::VectorXd& known,
                                            const SimulatorFit& fit) const {
  constexpr double kGross = 100.0, kLeft = 0.01;  // of the misfit: as faults of a recording are told
  const ExperimentSpec& experiment = reader_.getExperiment();
  const std::vector<BodySpec>& bodies = experiment.model.system.bodies;
  if (experiment.model.source || !simulator_.samplesFast() || fit.chi_square < kGross * fit.degrees) {
    return "";
  }
  std::vector<std::vector<std::size_t>> tried;  // bodies whose masses may be in g
  std::vector<std::size_t> all;
  for (std::size_t body = 0; body < bodies.size(); ++body) {
    double mass = 0.0;
    if (parseLiteral(bodies[body].mass.text, mass)) {
      tried.push_back({body});
      all.push_back(body);
    }
  }
  if (all.size() > 1) {
    tried.push_back(all);
  }
  const SearchStage stage("are masses in g");
  for (const std::vector<std::size_t>& heavy : tried) {
    ExperimentSpec light = experiment;
    std::string names;
    for (const std::size_t body : heavy) {
      light.model.system.bodies[body].mass.text = "0.001 * " + bodies[body].mass.text;
      names += (names.empty() ? "" : ", ") + bodies[body].name.text;
    }
    const SimulatorRefiner refiner(light, reader_.getLayout());
    if (refiner.findLeastChiSquare(found.features, known, static_cast<Eigen::Index>(found.available.size())) <
        kLeft * fit.chi_square) {
      return "the mass of " + names +
             " is 1000 times too large, as g in the place of kg (that explains 99 % of the misfit)";
    }
  }
  return "";
}

void DirectInference::tryWithoutSpikes(const SimulatorRefiner& simulator, AvailableFeatures& found,
                                       const Eigen::VectorXd& known, InferredMeasurement& inferred) const {
  constexpr double kLess = 0.5;
  const std::optional<SimulatorFit>& fit = inferred.posterior->fit;
  if (!fit || !fit->isSimulated() || fit->isPlausible() || !areSamples(reader_.getExperiment().features)) {
    return;
  }
  const SpikedFeatures spiked =
      findSpikedFeatures(found.response, reader_.getLayout(), reader_.getExtractor().getInfos());
  if (spiked.features.empty()) {
    return;
  }
  AvailableFeatures without = found;
  without.response(spiked.rows).setConstant(std::numeric_limits<double>::quiet_NaN());
  without.features(spiked.features).setConstant(std::numeric_limits<double>::quiet_NaN());
  for (const Eigen::Index feature : spiked.features) {
    without.available.erase(std::remove(without.available.begin(), without.available.end(), feature),
                            without.available.end());
  }
  InferredMeasurement other = infer(simulator, without.features, known, without.clipped);
  const std::optional<SimulatorFit>& own = other.posterior->fit;
  if (own && own->isSimulated() && (own->isPlausible() || own->chi_square < kLess * fit->chi_square)) {
    inferred = std::move(other);
    std::vector<std::string>& outliers = inferred.posterior->fit->outliers;
    outliers.insert(outliers.end(), spiked.said.begin(), spiked.said.end());
    found = std::move(without);
  }
}

void DirectInference::tryWithoutAlternation(const SimulatorRefiner& simulator, AvailableFeatures& found,
                                            const Eigen::VectorXd& known,
                                            InferredMeasurement& inferred) const {
  const std::optional<SimulatorFit>& fit = inferred.posterior->fit;
  if (!fit || !fit->isSimulated() || fit->isPlausible() || !areSamples(reader_.getExperiment().features)) {
    return;
  }
  Alternation alternation = findAlternation(found.response, reader_.getLayout());
  if (alternation.said.empty()) {
    return;
  }
  const Eigen::VectorXd features = found.features + reader_.getExtractor().extract(alternation.shift);
  InferredMeasurement other = infer(simulator, features, known, found.clipped);
  if (other.posterior->fit && other.posterior->fit->isPlausible()) {
    inferred = std::move(other);
    inferred.remarks = std::move(alternation.said);
    found.features = features;
    found.response += alternation.shift;
  }
}

bool DirectInference::tryClock(const AvailableFeatures& found, const Eigen::VectorXd& known,
                               InferredMeasurement& inferred) const {
  constexpr Eigen::Index kFewest = 20;  // samples, of which a clock can be told
  const ExperimentSpec& experiment = reader_.getExperiment();
  const std::vector<std::string> statuses = listStatuses(inferred);
  if (statuses.empty() || statuses.front() != toString(TrustStatus::kModelMismatch) || !inferred.posterior ||
      !inferred.posterior->fit || !inferred.posterior->fit->isSimulated() || found.stated.isGiven() ||
      experiment.model.source || !areSamples(experiment.features) || !simulator_.samplesFast() ||
      static_cast<Eigen::Index>(found.available.size()) < kFewest) {
    return false;
  }
  const SearchStage stage("does a fault of the clock explain it");
  const NoiseHypothesis noise = simulator_.describeNoise(found.clipped);
  std::optional<ClockedMeasurement> clocked =
      findClockFaults({experiment, reader_.getLayout(), found.features, known, noise},
                      inferred.posterior->fit->best, options_);
  if (!clocked) {
    return false;
  }
  inferred.trust.reset();
  inferred.posterior = std::move(clocked->posterior);
  inferred.clock_faults = std::move(clocked->faults);
  inferred.ridges = clocked->simulator->findRidges(*inferred.posterior, known);
  return true;
}

std::string DirectInference::explainMisfit(const SimulatorRefiner& simulator, const AvailableFeatures& found,
                                           const Eigen::VectorXd& known,
                                           const PosteriorEstimate& posterior) const {
  const SimulatorFit& fit = *posterior.fit;
  if (!fit.isSimulated() || fit.isPlausible()) {
    return "";
  }
  const SearchStage stage("does a fault of the recording explain it");
  const auto calcMisfit = [&](const Eigen::VectorXd& corrected) {
    return simulator.findLeastChiSquare(simulator.getExtractor().extract(corrected), known,
                                        static_cast<Eigen::Index>(found.available.size()));
  };
  return explainByFault(found.response, reader_.getLayout(), fit.chi_square, fit.residual.size(), calcMisfit,
                        listMeasured(reader_.getExperiment().model));
}

InferredMeasurement DirectInference::infer(const Eigen::VectorXd& features, const Eigen::VectorXd& known) {
  return infer(simulator_, features, known, {});
}

InferredMeasurement DirectInference::infer(const SimulatorRefiner& simulator, const Eigen::VectorXd& features,
                                           const Eigen::VectorXd& known,
                                           const std::vector<ClippedSample>& clipped) const {
  InferredMeasurement inferred;
  const std::string failure = simulator.findFailure(known);
  if (!failure.empty()) {
    inferred.posterior = simulator.makeFailed(features, known, failure);
    inferred.quantities = quantities_;
    return inferred;
  }
  inferred.posterior =
      simulator.samplePosterior(features, known, simulator.describeNoise(clipped), {}, options_);
  inferred.ridges = simulator.findRidges(*inferred.posterior, known);
  inferred.quantities = quantities_;
  inferred.prior = prior_;
  inferred.unused = unused_;
  return inferred;
}

}  // namespace twinmap
