#include "framework/inference/measurement/explained_recording.hpp"

#include <algorithm>
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

std::optional<ClockedMeasurement> findClock(const RecordingSetup& setup, const AvailableFeatures& found,
                                            const VectorXd& known, const SimulatorPosteriorOptions& options,
                                            const InferredMeasurement& inferred) {
  const ExperimentSpec& experiment = setup.reader->getExperiment();
  const SimulatorFit* fit = findFit(inferred);
  if (!isMismatch(listStatuses(inferred)) || fit == nullptr || found.stated.isGiven() ||
      experiment.model.source || !areSamples(experiment.features) || !setup.simulator->samplesFast() ||
      static_cast<Index>(found.available.size()) < kFewestTested) {
    return std::nullopt;
  }
  const SearchStage stage = SearchStage::supposing("does a fault of the clock explain it");
  return findClockFaults({experiment, setup.reader->getLayout(), found.features, known,
                          setup.simulator->describeNoise(found.clipped)},
                         fit->best, options);
}

void takeClock(const ClockedMeasurement& clocked, const VectorXd& known, InferredMeasurement& inferred) {
  inferred.trust.reset();
  inferred.posterior = clocked.sampled.estimate;
  inferred.clock_faults = clocked.faults;
  inferred.ridges = clocked.simulator->findRidges(*inferred.posterior, known);
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
        take(std::move(stated));
        return std::move(explained_);
      }
      take(explainByNoise(std::move(stated)));
      tryWithoutSpikes();
      tryWithoutAlternation();
    }
    if (!tryClock()) {
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

  void take(SampledMeasurement sampled) {
    explained_.noise = std::move(sampled.noise);
    explained_.posterior = std::move(sampled.posterior);
    upd().posterior = std::move(sampled.estimate);
    upd().ridges = getSimulator().findRidges(*upd().posterior, explained_.known);
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
      take(std::move(other));
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
      take(std::move(other));
      upd().remarks = std::move(alternation.said);
      explained_.found = std::move(even);
    }
  }

  bool tryClock() {
    std::optional<ClockedMeasurement> clocked =
        findClock(explained_.setup, explained_.found, explained_.known, options_, getInferred());
    if (!clocked) {
      return false;
    }
    takeClock(*clocked, explained_.known, upd());
    explained_.noise = std::move(clocked->sampled.noise);
    explained_.posterior = std::move(clocked->sampled.posterior);
    explained_.setup.simulator = std::move(clocked->simulator);
    explained_.found.features = std::move(clocked->features);
    return true;
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
    const std::string status = listStatuses(getInferred()).front();
    const bool explains_nothing = status == getNotice(Notice::kNotSimulated).name ||
                                  status == getNotice(Notice::kModelMismatch).name ||
                                  status == getNotice(Notice::kUnreliable).name;
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
  if (inferred.fault.empty() && inferred.clock_faults.empty()) {
    const std::vector<std::string> noisy =
        describeUnstatedNoise(*explained.setup.reader, *explained.setup.simulator, explained.found,
                              explained.known, *inferred.posterior);
    inferred.remarks.insert(inferred.remarks.end(), noisy.begin(), noisy.end());
  }
}

bool tryClock(const RecordingSetup& setup, const AvailableFeatures& found, const VectorXd& known,
              const SimulatorPosteriorOptions& options, InferredMeasurement& inferred) {
  const std::optional<ClockedMeasurement> clocked = findClock(setup, found, known, options, inferred);
  if (clocked) {
    takeClock(*clocked, known, inferred);
  }
  return clocked.has_value();
}

}  // namespace twinmap
