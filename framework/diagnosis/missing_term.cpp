#include "framework/diagnosis/missing_term.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "framework/base/text/source_location.hpp"
#include "framework/diagnosis/best_term.hpp"
#include "framework/diagnosis/blind_spots.hpp"
#include "framework/diagnosis/problem/sensor_faults.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/measurement/inference_source.hpp"
#include "framework/inference/select_estimate.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// What explains a measurement best, as far as is known: a point, and by how much it misses.
struct KnownFit {
  VectorXd point;  ///< u; empty where nothing is known
  double chi_square = 0.0, degrees = 0.0;
  CandidateKinds asked = CandidateKinds::kWithoutStates;
};

/// Terms with states, whose scores take most of the time, are asked where noise has faults or the residual is
/// among the 27 % of good ones that look least like noise. All 10 recordings of three machines that lacked
/// LuGre friction, and were silent otherwise, are among them.
CandidateKinds chooseKinds(const SimulatorFit& fit, double recordings) {
  constexpr double kSuspicious = 0.3;
  const bool has_faults = !fit.outliers.empty() || fit.isColoured() || fit.hasOffset();
  return has_faults || recordings * fit.test.calcPValue() < kSuspicious ? CandidateKinds::kAll
                                                                        : CandidateKinds::kWithoutStates;
}

KnownFit findBest(const InferredMeasurement& inferred, Index u) {
  const SimulatorFit* fit = findFit(inferred);
  if (fit != nullptr && fit->best.size() >= u) {
    // before the sizes of a recording's nuisance
    return {fit->best.head(u), fit->chi_square, fit->degrees, chooseKinds(*fit, 1.0)};
  }
  if (inferred.refined && inferred.refined->isAccepted() && inferred.refined->point.size() >= u) {
    return {inferred.refined->point.head(u), inferred.refined->chi_square, inferred.refined->degrees};
  }
  return {};
}

/// Of the terms that are tied with the best, that with the largest evidence of those that have some and move
/// a parameter by more than its standard deviation; null of none.
const RankedTerm* findMoving(const RankedTerm& best, const std::vector<RankedTerm>& ranked) {
  const RankedTerm* moving = nullptr;
  for (const RankedTerm& one : ranked) {
    const bool moves = isTied(one, best) && one.finding.log_evidence > kTiedEvidence &&
                       one.finding.shifts.cwiseAbs().maxCoeff() > 1.0;
    moving = moves && (moving == nullptr || hasMoreEvidence(one, *moving)) ? &one : moving;
  }
  return moving;
}

/// The blind spot that moves a parameter most, up to the size that matters.
std::optional<UnnoticedTerm> findUnnoticed(const ScoredCandidates& scored,
                                           const std::vector<ParameterSpec>& parameters) {
  const auto p = static_cast<Index>(parameters.size());
  std::optional<UnnoticedTerm> worst;
  for (const BlindSpot& spot : calcBlindSpots(scored, p, kMismatchLevel)) {
    if (!std::isfinite(spot.noticed) || spot.candidate.has_states) {
      continue;
    }
    const TermCandidate& candidate = spot.candidate;
    const double size = std::min(spot.noticed, candidate.size);
    const VectorXd shifts =
        keepWithinBounds(spot.shifts.cwiseAbs() * (size / spot.noticed), scored, parameters);
    Index moved = 0;
    if (const double shift = shifts.maxCoeff(&moved); !worst || shift > worst->shift) {
      worst = {candidate.term, candidate.meaning, candidate.unit, size, static_cast<std::size_t>(moved),
               shift};
    }
  }
  return worst;
}

/// The term of some kinds that would explain a misfit; `explains` where noise remains with it.
std::optional<MissingTerm> explainMisfit(const CurrentFit& current, const RecordedFeatures& recording,
                                         CandidateKinds kinds) {
  const ScoredCandidates scored = scoreCandidates(current.experiment, recording, current.point, {kinds});
  const auto p = static_cast<Index>(current.experiment.model.parameters.size());
  std::vector<RankedTerm> ranked = rankTerms(scored, current, p);
  const RankedTerm* best = fitBest(current, recording, scored, p, ranked);
  if (best == nullptr) {
    return {};
  }
  MissingTerm missing = describeMissing(*best, ranked, current.chi_square);
  missing.explains = explains(current, recording, best->fitted);
  return missing;
}

/// Those with states, which take time, are asked where no other explains most.
std::optional<MissingTerm> explainMisfit(const ExperimentSpec& experiment, const RecordedFeatures& recording,
                                         const VectorXd& start) {
  const CurrentFit current = fitFrom(experiment, recording, start);
  if (current.point.size() == 0) {
    return {};
  }
  std::optional<MissingTerm> missing = explainMisfit(current, recording, CandidateKinds::kWithoutStates);
  if (!missing || missing->share < kMostOfMisfit) {
    missing = explainMisfit(current, recording, CandidateKinds::kAll);
  }
  if (missing && hasUnknownNoise(experiment.noise)) {
    missing->share = missing->share_of_all;  // what is noise is not known
  }
  return missing;
}

/// Of recordings that noise explains, as large as it was found (takeFaults).
ModelTest testTerms(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                    const KnownFit& known) {
  const bool unstated = hasUnknownNoise(experiment.noise);
  const ScoredCandidates scored = scoreCandidates(experiment, recordings, known.point, {known.asked});
  const auto p = static_cast<Index>(experiment.model.parameters.size());
  ModelTest test;
  if (!unstated) {
    test.unnoticed = findUnnoticed(scored, experiment.model.parameters);
  }
  CurrentFit current{experiment, known.point, known.chi_square, known.degrees};
  std::vector<RankedTerm> ranked = rankTerms(scored, current, p);
  if (ranked.empty() || !(ranked.front().finding.p_value < kMismatchLevel)) {
    return test;
  }
  current = fitFrom(experiment, recordings, known.point);
  const RankedTerm* best =
      current.point.size() > 0 ? fitBest(current, recordings, scored, p, ranked) : nullptr;
  best = best != nullptr ? findMoving(*best, ranked) : nullptr;
  if (best == nullptr) {
    return test;
  }
  MissingTerm missing = describeMissing(*best, ranked, current.chi_square);
  const bool leaves_noise = explains(current, recordings, best->fitted);
  RecordedFeatures stated = recordings;
  stated.noise.clear();
  missing.explains = leaves_noise && (unstated || explains(current, stated, best->fitted));
  if (leaves_noise || best->finding.holds_cautiously) {
    test.missing = std::move(missing);
  }
  return test;
}

Index countMissing(const RecordedFeatures& recordings) {
  Index missing = 0;
  for (const VectorXd& features : recordings.features) {
    missing += features.array().isNaN().count();
  }
  return missing;
}

/// Of recordings that have outliers, or noise with offsets, a colour or another size than stated: beside
/// these, or in their place. That is where noise as it is stated remains with a term other than an offset.
/// without: where they do not count.
ModelTest testBesideFaults(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                           const RecordedFeatures& without, const KnownFit& known) {
  ModelTest test = testTerms(experiment, recordings, known);
  if (!recordings.hasFaults() && countMissing(recordings) == countMissing(without)) {
    return test;
  }
  ModelTest instead = testTerms(experiment, without, known);
  const bool replaces =
      instead.missing && instead.missing->explains && instead.missing->term.rfind("offset.", 0) != 0;
  if (replaces) {
    test.missing = std::move(instead.missing);
  }
  return test;
}

ModelTest testExplained(const ExperimentSpec& experiment, const RecordedFeatures& recording,
                        const InferredMeasurement& inferred, const KnownFit& known) {
  const SimulatorFit* fit = findFit(inferred);
  RecordedFeatures explained = recording;
  if (fit == nullptr) {
    return testTerms(experiment, recording, known);
  }
  takeFaults(*fit, {true, true, true}, 0, explained);
  return testBesideFaults(experiment, explained, recording, known);
}

/// The recordings without a nuisance, and the point without what is of the others alone.
std::pair<RecordedFeatures, VectorXd> leaveNuisance(const ExperimentSpec& experiment,
                                                    const RecordedFeatures& recordings,
                                                    const JointInference& inferred) {
  std::vector<std::size_t> kept;
  auto next = static_cast<Index>(experiment.model.parameters.size());
  VectorXd point = inferred.joint.best.head(next);
  for (std::size_t k = 0; k < inferred.alone.size(); ++k) {
    const auto own = static_cast<Index>(recordings.makeExperiment(experiment, k).model.nuisance.size());
    const std::size_t faults = inferred.alone[k].inferred.countSizes();
    if (faults == 0) {
      kept.push_back(k);
      point.conservativeResize(point.size() + own);
      point.tail(own) = inferred.joint.best.segment(next, own);
    }
    next += own + static_cast<Index>(faults);
  }
  return {recordings.select(kept), point};
}

/// Whether the model, and that of each trial, is a system of bodies that is simulated in time.
bool isKnown(const ExperimentSpec& experiment) {
  const auto is_known = [](const ModelSpec& model) {
    return isGiven(model.system) && model.simulation.duration > 0.0;
  };
  return is_known(experiment.model) &&
         std::all_of(experiment.trials.begin(), experiment.trials.end(),
                     [&](const TrialExperiment& trial) { return is_known(trial.experiment.model); });
}

bool isMisfit(const InferredMeasurement& inferred) {
  return isMismatch(listStatuses(inferred)) || inferred.nuisance.has_value();
}

}  // namespace

VectorXd findExplanation(const InferredMeasurement& inferred, const std::vector<ParameterSpec>& unknown) {
  const auto u = static_cast<Index>(unknown.size());
  const KnownFit known = findBest(inferred, u);
  return known.point.size() > 0             ? known.point
         : inferred.explanation.size() >= u ? VectorXd(inferred.explanation.head(u))
                                            : calcBoxCenter(unknown);
}

void testModel(const ExperimentSpec& experiment, const RecordedFeatures& recording,
               InferredMeasurement& inferred) {
  const std::vector<ParameterSpec> unknown = collectUnknown(experiment.model);
  const auto u = static_cast<Index>(unknown.size());
  const KnownFit known = findBest(inferred, u);
  const bool misfits = isMisfit(inferred);
  if (!isKnown(experiment) || (known.point.size() == 0 && !misfits)) {
    return;
  }
  try {
    if (misfits) {
      const VectorXd start = findExplanation(inferred, unknown);
      inferred.model_test = ModelTest{explainMisfit(experiment, recording, start)};
    } else {
      inferred.model_test = testExplained(experiment, recording, inferred, known);
    }
  } catch (const std::runtime_error&) {
    // the best fit cannot be simulated again: the inference's own statuses say what is wrong
  }
}

std::optional<RecordedFeatures> testModel(const MeasurementReader& reader, const Table& table,
                                          std::optional<double> start, const VectorXd& known,
                                          InferredMeasurement& inferred) {
  const ExperimentSpec& experiment = reader.getExperiment();
  const auto u = static_cast<Index>(collectUnknown(experiment.model).size());
  const bool misfits = isMisfit(inferred);
  if (reader.findReduction() != nullptr || !inferred.fault.empty() || !isKnown(experiment) ||
      (!misfits && findBest(inferred, u).point.size() == 0)) {
    return std::nullopt;
  }
  try {
    RecordedFeatures recording = readRecording(reader, table, start, known);
    testModel(experiment, recording, inferred);
    return misfits || inferred.findMissing() != nullptr ? std::make_optional(std::move(recording))
                                                        : std::nullopt;
  } catch (const MeasurementError&) {
    return std::nullopt;  // a map took from the table what is not a recording of the model
  }
}

void testModel(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
               JointInference& inferred) {
  const SimulatorPosterior& joint = inferred.joint;
  if (!isKnown(experiment) || !(joint.degrees > 0.0)) {
    return;
  }
  const std::vector<std::string> statuses =
      listStatuses(inferred, static_cast<Index>(experiment.model.parameters.size()));
  const bool misfits = isMismatch(statuses) || inferred.disagrees();
  RecordedFeatures without = recordings, explained = recordings;
  takeFaults(inferred.alone, {}, without);
  takeFaults(inferred.alone, {true, true, true}, explained);
  const auto [kept, point] = leaveNuisance(experiment, explained, inferred);
  const RecordedFeatures kept_without = leaveNuisance(experiment, without, inferred).first;
  if (kept.features.empty()) {
    return;
  }
  KnownFit known{point, joint.chi_square, joint.degrees};
  for (const RecordingInference& one : inferred.alone) {
    const SimulatorFit* fit = findFit(one.inferred);
    if (fit != nullptr &&
        chooseKinds(*fit, static_cast<double>(inferred.alone.size())) == CandidateKinds::kAll) {
      known.asked = CandidateKinds::kAll;
    }
  }
  try {
    inferred.model_test = misfits ? ModelTest{explainMisfit(experiment, kept_without, point)}
                                  : testBesideFaults(experiment, kept, kept_without, known);
  } catch (const std::runtime_error&) {
    // the best fit cannot be simulated again: the inference's own statuses say what is wrong
  }
}

void testModel(const std::string& experiment_file, const std::vector<Recording>& recordings,
               const std::vector<std::string>& known, JointInference& inferred) {
  try {
    const InferenceSource source = readAllTrials(experiment_file);
    const ExperimentSpec& experiment = source.getExperiment();
    testModel(experiment, readRecordings(experiment, recordings, parseKnownValues(known)), inferred);
  } catch (const ExperimentError&) {
    // trials that cannot be combined, as of modes in two of them
  }
}

}  // namespace twinmap
