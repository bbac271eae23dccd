#include "framework/inference/measurement/explained_recording.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/log/notice.hpp"
#include "framework/base/log/search_stage.hpp"
#include "framework/data/measurement/recording/recorded_times.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/clock/clock_search.hpp"
#include "framework/inference/measurement/alternation.hpp"
#include "framework/inference/measurement/gram_masses.hpp"
#include "framework/inference/measurement/measurement_faults.hpp"
#include "framework/inference/measurement/required_modes.hpp"
#include "framework/inference/measurement/spikes.hpp"
#include "framework/inference/measurement/supposed_input.hpp"
#include "framework/inference/measurement/unknown_excitation.hpp"
#include "framework/inference/measurement/unstated_noise.hpp"
#include "framework/inference/measurement/wider_bounds.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/models/model_remarks.hpp"
#include "framework/simulation/team_simulator.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

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

/// A kind of nuisance, and what is asked while it is looked for.
struct NuisanceKind {
  NuisanceSearch* find;
  const char* question;
};
/// In the order in which they are tried.
constexpr NuisanceKind kNuisances[] = {{findClockFaults, "does a fault of the clock explain it"}};

void take(SampledMeasurement sampled, ExplainedRecording& explained) {
  explained.noise = std::move(sampled.noise);
  explained.posterior = std::move(sampled.posterior);
  explained.inferred.posterior = std::move(sampled.estimate);
  explained.inferred.ridges =
      explained.setup.simulator->findRidges(*explained.inferred.posterior, explained.known);
}

/// As drawn, the last of what is unknown; false where one is not significant.
bool takeSizes(const BoundedDraws& draws, std::vector<NuisanceSize>& sizes) {
  Index row = draws.points.rows() - static_cast<Index>(sizes.size());
  for (NuisanceSize& size : sizes) {
    const VectorXd own = draws.points.row(row++).transpose();
    size.value = draws.weights.dot(own) / draws.weights.sum();
    size.stddev =
        std::sqrt(draws.weights.dot((own.array() - size.value).square().matrix()) / draws.weights.sum());
    if (std::abs(size.value) < kRareDeviations * size.stddev) {
      return false;
    }
  }
  return true;
}

/// Whether one does; then it is what was inferred.
bool explainBy(const NuisanceKind& kind, const RecordedSamples& recorded,
               const SimulatorPosteriorOptions& options, ExplainedRecording& explained) {
  const SearchStage stage = SearchStage::supposing(kind.question);
  std::optional<NuisanceFit> fit = kind.find(recorded, explained.inferred.posterior->fit->best);
  if (!fit) {
    return false;
  }
  SampledMeasurement sampled =
      fit->simulator->sampleUnder(recorded.noise, fit->features, recorded.known, fit->point, options);
  const PosteriorEstimate& posterior = sampled.estimate;
  if (!posterior.isReliable() || !posterior.fit->isPlausible() ||
      !takeSizes(posterior.estimate.draws, fit->nuisance.sizes)) {
    return false;
  }
  fit->nuisance.text = fit->describe(fit->nuisance.sizes);
  explained.inferred.trust.reset();
  explained.inferred.nuisance = std::move(fit->nuisance);
  explained.setup.simulator = std::move(fit->simulator);
  explained.found.features = std::move(fit->features);
  take(std::move(sampled), explained);
  return true;
}

/// One recording, from one hypothesis to the next.
class Explaining {
 public:
  Explaining(const RecordingSetup& setup, AvailableFeatures found, const VectorXd& known,
             const SimulatorPosteriorOptions& options, const VectorXd& lead)
      : options_(options), lead_(lead), explained_{setup, std::move(found), known, {}, {}, {}} {}

  ExplainedRecording explain() {
    const std::string failure = getSimulator().findFailure(explained_.known);
    if (!failure.empty()) {
      upd().posterior = getSimulator().makeFailed(explained_.found.features, explained_.known, failure);
    } else {
      SampledMeasurement stated = sampleAsStated();
      upd().fault = explainByBounds(getReader(), getSimulator(), explained_.found, explained_.known,
                                    *stated.estimate.fit);
      if (!upd().fault.empty()) {
        take(std::move(stated), explained_);
        return std::move(explained_);
      }
      take(explainByNoise(std::move(stated)), explained_);
      tryWithoutSpikes();
      tryWithoutAlternation();
    }
    if (!tryNuisance(options_, explained_)) {
      nameRest();
    }
    return std::move(explained_);
  }

 private:
  const SimulatorRefiner& getSimulator() const { return *explained_.setup.simulator; }
  const MeasurementReader& getReader() const { return *explained_.setup.reader; }
  const SimulatorFit& getFit() const { return *getInferred().posterior->fit; }
  const InferredMeasurement& getInferred() const { return explained_.inferred; }
  InferredMeasurement& upd() { return explained_.inferred; }

  /// The place to which other recordings lead (u x 1), or none.
  MatrixXd listGiven() const {
    if (lead_.size() == 0) {
      return {};
    }
    VectorXd given = calcBoxCenter(getSimulator().getUnknown());
    given.head(lead_.size()) = lead_;
    return given;
  }

  SampledMeasurement sampleAsStated() const {
    const AvailableFeatures& found = explained_.found;
    return getSimulator().sampleAsStated(found.features, explained_.known,
                                         getSimulator().describeNoise(found.clipped), listGiven(),
                                         getSimulator().spareMisfit(options_));
  }

  SampledMeasurement explainByNoise(SampledMeasurement stated) const {
    const AvailableFeatures& found = explained_.found;
    return getSimulator().explainByNoise(std::move(stated), found.features, explained_.known,
                                         getSimulator().describeNoise(found.clipped), options_);
  }

  SampledMeasurement sample(const AvailableFeatures& found) const {
    return getSimulator().samplePosterior(found.features, explained_.known,
                                          getSimulator().describeNoise(found.clipped), listGiven(), options_);
  }

  /// Whether other hypotheses are worth a try that look at samples.
  bool isUnexplained() const {
    return getFit().isSimulated() && !getFit().isPlausible() &&
           areSamples(getReader().getExperiment().features);
  }

  void tryWithoutSpikes() {
    if (!isUnexplained()) {
      return;
    }
    const SpikedFeatures spiked = findSpikedFeatures(explained_.found.response, getReader().getLayout(),
                                                     getReader().getExtractor().getInfos());
    if (spiked.features.empty()) {
      return;
    }
    AvailableFeatures without = explained_.found;
    without.response(spiked.rows).setConstant(std::numeric_limits<double>::quiet_NaN());
    without.features(spiked.features).setConstant(std::numeric_limits<double>::quiet_NaN());
    for (const Index feature : spiked.features) {
      without.available.erase(std::remove(without.available.begin(), without.available.end(), feature),
                              without.available.end());
    }
    SampledMeasurement other = sample(without);
    SimulatorFit& own = *other.estimate.fit;
    if (own.isSimulated() && (own.isPlausible() || own.chi_square < kClearlyLess * getFit().chi_square)) {
      own.outliers.insert(own.outliers.end(), spiked.said.begin(), spiked.said.end());
      own.outlier_features.insert(own.outlier_features.end(), spiked.features.begin(), spiked.features.end());
      take(std::move(other), explained_);
      explained_.found = std::move(without);
    }
  }

  void tryWithoutAlternation() {
    if (!isUnexplained()) {
      return;
    }
    Alternation alternation = findAlternation(explained_.found.response, getReader().getLayout());
    if (alternation.said.empty()) {
      return;
    }
    AvailableFeatures even = explained_.found;
    even.features += getReader().getExtractor().extract(alternation.shift);
    even.response += alternation.shift;
    SampledMeasurement other = sample(even);
    if (other.estimate.fit->isPlausible()) {
      take(std::move(other), explained_);
      upd().remarks = std::move(alternation.said);
      explained_.found = std::move(even);
    }
  }

  /// The simple fault of the recording that explains a gross misfit, or "".
  std::string findFault() const {
    if (!getFit().isSimulated() || getFit().isPlausible()) {
      return "";
    }
    const SearchStage stage = SearchStage::supposing("does a fault of the recording explain it");
    const AvailableFeatures& found = explained_.found;
    const auto calcMisfit = [&](const VectorXd& corrected) {
      return getSimulator().findLeastChiSquare(getSimulator().getExtractor().extract(corrected),
                                               explained_.known, static_cast<Index>(found.available.size()));
    };
    return explainByFault(found.response, getReader().getLayout(), getFit().chi_square,
                          getFit().residual.size(), calcMisfit,
                          listMeasured(getReader().getExperiment().model));
  }

  /// What speaks against the model, where it explains nothing and no fault of the recording does.
  std::vector<std::string> listAgainst() const {
    const Notice status = getStatus(listStatuses(getInferred()).front()).notice;
    const bool explains_nothing =
        status == Notice::kNotSimulated || status == Notice::kModelMismatch || status == Notice::kUnreliable;
    if (!explains_nothing || !getInferred().fault.empty()) {
      return {};
    }
    std::vector<std::string> against = listModelRemarks(getReader().getExperiment().model);
    const std::string grams =
        getFit().isSimulated()
            ? explainByGrams(getReader(), getSimulator(), explained_.found, explained_.known, getFit())
            : "";
    if (!grams.empty()) {
      against.push_back(grams);
    }
    return against;
  }

  void nameRest() {
    upd().fault = findFault();
    upd().against = listAgainst();
  }

  const SimulatorPosteriorOptions& options_;
  const VectorXd lead_;
  ExplainedRecording explained_;
};

}  // namespace

MeasuredTrial ExplainedRecording::makeTrial() const {
  MeasuredTrial trial = setup.simulator->makeTrial(found.features, known);
  trial.noise = noise;
  return trial;
}

AvailableFeatures readFeatures(const MeasurementReader& reader, const Table& table,
                               std::optional<double> start) {
  AvailableFeatures found = reader.readAvailableFeatures(table, start);
  requireModes(found, reader, table.source);
  return found;
}

UnexplainedRecording readUnexplained(std::shared_ptr<const MeasurementReader> reader, const Table& table,
                                     std::optional<double> start) {
  if (std::optional<ExperimentSpec> followed = reader->follow(table, start)) {
    reader = std::make_shared<const MeasurementReader>(std::move(*followed));
  }
  AvailableFeatures found = readFeatures(*reader, table, start);
  return {std::move(reader), std::move(found)};
}

RecordingSetup makeSetup(std::shared_ptr<const MeasurementReader> reader) {
  const ExperimentSpec& experiment = reader->getExperiment();
  const ResponseLayout& layout = reader->getLayout();
  auto simulator = std::make_shared<const SimulatorRefiner>(
      experiment, layout,
      shareAmongThreads(makeTrustedSimulator(experiment.model, layout.times, layout.modes)));
  return {std::move(reader), std::move(simulator)};
}

ExplainedRecording explainRecording(const RecordingSetup& setup, AvailableFeatures found, const Table& table,
                                    std::optional<double> start, const VectorXd& known,
                                    const SimulatorPosteriorOptions& options, const VectorXd& lead) {
  const MeasurementReader& reader = *setup.reader;
  RecordingSetup own = setup;
  if (auto supposed = makeOwnSimulator(reader, *setup.simulator, found, known, options)) {
    own.simulator = std::move(supposed);
  }
  ExplainedRecording explained = Explaining(own, std::move(found), known, options, lead).explain();
  InferredMeasurement& inferred = explained.inferred;
  inferred.source = table.source;
  inferred.start = reader.getStart(table, start);
  inferred.left_out = explained.found.remarks;
  const std::vector<std::string> bridged = describeBridged(reader.getExperiment().model);
  inferred.remarks.insert(inferred.remarks.end(), bridged.begin(), bridged.end());
  return explained;
}

void nameUnstatedNoise(ExplainedRecording& explained) {
  InferredMeasurement& inferred = explained.inferred;
  if (inferred.fault.empty() && !inferred.nuisance) {
    const std::vector<std::string> noisy =
        describeUnstatedNoise(*explained.setup.reader, *explained.setup.simulator, explained.found,
                              explained.known, *inferred.posterior);
    inferred.remarks.insert(inferred.remarks.end(), noisy.begin(), noisy.end());
  }
}

bool tryNuisance(const SimulatorPosteriorOptions& options, ExplainedRecording& explained) {
  const ExperimentSpec& experiment = explained.setup.reader->getExperiment();
  const AvailableFeatures& found = explained.found;
  if (!isMismatch(listStatuses(explained.inferred)) || findFit(explained.inferred) == nullptr ||
      found.stated.isGiven() || experiment.model.source || !areSamples(experiment.features) ||
      !explained.setup.simulator->samplesFast() ||
      static_cast<Index>(found.available.size()) < kFewestTested) {
    return false;
  }
  const NoiseHypothesis noise = explained.setup.simulator->describeNoise(found.clipped);
  const RecordedSamples recorded{experiment, explained.setup.reader->getLayout(), found.features,
                                 explained.known, noise};
  return std::any_of(std::begin(kNuisances), std::end(kNuisances),
                     [&](const NuisanceKind& kind) { return explainBy(kind, recorded, options, explained); });
}

}  // namespace twinmap
