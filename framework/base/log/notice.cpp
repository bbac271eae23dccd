#include "framework/base/log/notice.hpp"

#include <algorithm>
#include <cassert>

namespace twinmap {
namespace {

constexpr Severity kMisleading = Severity::kMisleading, kDegraded = Severity::kDegraded,
                   kInfo = Severity::kInfo;

const std::vector<NoticeText> kStatuses{
    {Notice::kOk, "ok", true, kInfo, "the model explains the measurement", "", "No test found a fault."},
    {Notice::kModelMismatch, "model_mismatch", true, kMisleading,
     "the model does not explain the measurement: {0}",
     "Ask what the model lacks: twinmap diagnose RUN FILE.",
     "The model lacks something, a sensor, sign, unit or trigger is wrong, or the noise is larger than "
     "stated."},
    {Notice::kModelIncomplete, "model_incomplete", true, kMisleading,
     "no candidate explains what remains; the intervals are those of effective parameters in this test",
     "Add terms of your own to the experiment file: candidates.",
     "Something acts on the machine, or on its sensors, that none of the tested terms describes."},
    {Notice::kMissingTerm, "missing_term", true, kMisleading, "{0} may be missing ({1}): {2}",
     "Ask what the model lacks: twinmap diagnose FILE RECORDINGS.",
     "Noise explains the measurement, but a term that the model lacks explains it better, and parameters "
     "stand in for it."},
    {Notice::kOutsideTraining, "outside_training", true, kMisleading,
     "the features are {0:.2g} times as far from the training samples as any simulated measurement",
     "Widen the bounds and train again: here the estimator extrapolates.",
     "The machine behaves as no simulated one does, mostly because a parameter is far outside its bounds."},
    {Notice::kAtBounds, "at_bounds", true, kMisleading, "{0} lies at its bounds",
     "Widen the bounds of {0}; a run must be trained again then.",
     "The measurement fits best at or beyond a bound, so that the bound decides the estimate."},
    {Notice::kUninformative, "uninformative", true, kDegraded,
     "the measurement reduces the uncertainty of {0} by only {1}",
     "Measure another output or excite {0} more (twinmap design).",
     "The response hardly depends on the parameter, or other parameters make up for its changes."},
    {Notice::kOutliers, "outliers", true, kInfo, "{0} not noise and left out: {1}",
     "Look at these samples of the recording; the estimate does not rest on them.",
     "A spike of a sensor or a lost packet; without these few samples the model explains the recording.",
     Concern::kSensor},
    {Notice::kClockFault, "clock_fault", true, kDegraded, "{0}; the intervals follow it",
     "Look at the recorder, its trigger and sample rate; if it is sound, ask what the model lacks: twinmap "
     "diagnose FILE RECORDINGS.",
     "The residuals are noise where the times of the recording are corrected like this; a little friction or "
     "damping that the model lacks may look alike.",
     Concern::kNuisance},
    {Notice::kNoiseLarger, "noise_larger", true, kDegraded,
     "the noise is {0:.3g} times what the file states; the intervals are those of the noise found",
     "State the noise that was found: noise.stddev.",
     "The residuals are as independent as noise, but larger than stated.", Concern::kSensor},
    {Notice::kNoiseSmaller, "noise_smaller", true, kInfo,
     "the noise is {0:.3g} times what the file states; the intervals are those of the noise found",
     "State the noise that was found: noise.stddev.",
     "The residuals are as independent as noise, but smaller than stated.", Concern::kSensor},
    {Notice::kNoiseColoured, "noise_coloured", true, kInfo,
     "the noise of {0} is coloured, {1}; the intervals follow it",
     "State it: noise.correlation; or look whether the model lacks something small.",
     "Neighbouring residuals are alike, or alternate, and are no larger than the stated noise.",
     Concern::kSensor},
    {Notice::kSensorOffset, "sensor_offset", true, kInfo,
     "{0} reads {1} too much (sd {2}); the estimate does without this constant",
     "Take the offset off the recording, or let the model have it as a nuisance parameter.",
     "The residuals are noise about a constant that no parameter explains.", Concern::kSensor},
    {Notice::kMultimodal, "multimodal", true, kMisleading,
     "several separate sets of parameter values fit the measurement",
     "Measure another output that separates them, or exclude all but one by the bounds.",
     "The model has a symmetry, or its response repeats itself, as an oscillation by another period does."},
    {Notice::kTrialsDisagree, "trials_disagree", true, kMisleading, "the {0} recordings disagree ({1}): {2}",
     "Ask what the model lacks: twinmap diagnose FILE RECORDINGS.",
     "Each recording is explained by parameters of its own, as where friction has another shape than the "
     "model's."},
    {Notice::kUncalibrated, "uncalibrated", true, kDegraded,
     "of the run's test samples the 95 % intervals of a parameter held less than 92 %, which chance does in "
     "one of 1000 runs",
     "Sample the posterior, which needs no normal distribution: --posterior.",
     "The estimator takes its errors for smaller than they are, as along a ridge; refined, least squares "
     "ended in another basin, or at a bound."},
    {Notice::kPosteriorUncalibrated, "posterior_uncalibrated", true, kDegraded,
     "the posterior under the surrogate is not to be relied on: {0}",
     "Take the simulator's: --posterior-from simulator.",
     "The surrogate's errors are not normal, or not known, as where impacts or friction bend the response."},
    {Notice::kNonlinear, "nonlinear", true, kDegraded,
     "the parameters fit, but the misfit around them is not that of a normal distribution",
     "Sample the posterior, which needs no normal distribution: --posterior.",
     "The measurement leaves a bent or one-sided region of parameters, or a force jumps with the state."},
    {Notice::kNotRefined, "not_refined", true, kDegraded, "fit rejected: {0}",
     "Replay the measurement and look at its residuals: twinmap replay RUN FILE.",
     "Least squares on the simulator found no parameters that explain the measurement; the unconfirmed quick "
     "estimate stands."},
    {Notice::kEstimatorLimited, "estimator_limited", true, kDegraded,
     "the sd of {0} larger than the data would permit", "Refine the estimate: --refine.",
     "The trained estimator is less accurate than the measurement; its own error dominates the sd."},
    {Notice::kUnreliable, "unreliable", true, kMisleading, "the posterior cannot be trusted: {0}",
     "Take more draws: --posterior=4000.",
     "Few draws carry most of the weight; means and intervals from them would scatter."},
    {Notice::kNotSimulated, "not_simulated", true, kMisleading,
     "no simulation within the bounds succeeded: {0}",
     "Mend the cause that is named, and try one sample: twinmap simulate FILE.",
     "The solver fails everywhere in the bounds."},
    {Notice::kError, "error", true, kMisleading, "the measurement cannot be used: {0}",
     "Correct what the message names.", "A column, unit, time or value of the file is missing or wrong."}};

const std::vector<NoticeText> kSimulation{
    {Notice::kSamplesFailed, "samples_failed", false, kMisleading,
     "{0} of the samples could not be simulated; the estimator is neither trained nor tested there",
     "Read the reasons in failures.csv.",
     "The solver failed, reached its limit of steps or time, or a response lacks a feature."},
    {Notice::kAllFailed, "all_failed", false, kMisleading, "the first {0} {1} simulations all failed: {2}",
     "Mend the cause that is named, and try one sample: twinmap simulate FILE.",
     "The model fails everywhere in the bounds; the run stops at once."},
    {Notice::kStiff, "stiff", false, kInfo,
     "{0} of the {1} samples reached the step limit and were simulated by an implicit method",
     "Nothing need be done; less stiffness or damping would be faster.",
     "The equations are stiff there: an explicit method needs very small steps."},
    {Notice::kNoEffect, "no_effect", false, kMisleading, "{0} has no effect on any output at three points",
     "Check the parameter's name in the model.",
     "The model does not use the parameter, or its name in the FMU or program is another."}};

const std::vector<NoticeText> kAccuracy{
    {Notice::kIntervalsTooNarrow, "intervals_too_narrow", false, kMisleading,
     "the 95 % intervals contain too few of the true values: {0}", "{1}",
     "The estimator takes its errors for smaller than they are; or chance, in 1 % of runs with four "
     "parameters."},
    {Notice::kIntervalsTooWide, "intervals_too_wide", false, kInfo,
     "the 95 % intervals contain more of the true values than they claim: {0}",
     "Nothing need be done: these intervals are conservative.",
     "The estimator takes its errors for larger than they are."},
    {Notice::kMultimodalTests, "multimodal_tests", false, kInfo,
     "fraction of the test samples with several separate estimates: {0}",
     "Measure another output to separate them; errors are to the nearest where estimates are refined, else "
     "to the mean of all.",
     "More than one set of parameter values fits the same response."},
    {Notice::kAboveLimit, "above_limit", false, kDegraded,
     "the estimation error exceeds the information limit by these factors: {0}", "{1}",
     "The estimator is less accurate than the measurements permit."},
    {Notice::kMoreSamplesHardlyHelp, "more_samples_hardly_help", false, kInfo,
     "from {0} to {1} training samples the errors fell by less than 30 %: {2}",
     "Refine the estimates instead of adding samples: refine=always.",
     "The response is too nonlinear to be learnt from a few hundred samples."},
    {Notice::kDataUninformative, "data_uninformative", false, kDegraded,
     "the measurement reduces the uncertainty by only: {0}",
     "Measure another output or excite the machine differently (twinmap design).",
     "The response hardly depends on these parameters compared with its noise."},
    {Notice::kNotDetermined, "not_determined", false, kDegraded,
     "the data reduce the uncertainty of {0} by only {1}, even if all other parameters were known",
     "Measure an output that {0} acts on, or make it a constant.",
     "No feature follows the parameter more than the noise."},
    {Notice::kConfounded, "confounded", false, kDegraded,
     "the data reduce the uncertainty of {0} by only {1}: its effect looks like that of {2}",
     "Make one of them a constant, or measure an output that separates them.",
     "Only a combination of the parameters changes the response."},
    {Notice::kCorrelated, "correlated", false, kInfo, "strongly correlated: {0}",
     "Use the joint covariance where both matter, not each sd alone.",
     "An error of one parameter makes up for an error of the other; each is still determined."},
    {Notice::kNoLimit, "no_limit", false, kInfo, "no information limit: the noise of a feature is 0",
     "State the noise of every output.", "Without noise there is no smallest sd."},
    {Notice::kLimitFailed, "limit_failed", false, kInfo,
     "the information limit of {0} test samples could not be computed",
     "Nothing need be done: the others give the limit.", "Simulations beside these samples failed."},
    {Notice::kFewRefined, "few_refined", false, kDegraded,
     "{0} of {1} test samples passed the test of their refinement ({2})",
     "Replay one that failed and look at its residuals.",
     "Searches ended in another basin, at the bounds, or where no normal distribution describes the misfit."},
    {Notice::kCannotRefine, "cannot_refine", false, kDegraded, "test samples cannot be refined: {0}",
     "Mend the cause that is named, or set refine=never.",
     "Refinement needs noise on every feature and a simulator that can be called again."},
    {Notice::kUnconverged, "unconverged", false, kInfo, "{0} of {1} searches of {2} did not converge",
     "Allow more simulations: evaluation.baselines, max_simulations.",
     "Least squares used up its simulations before the steps became small."},
    {Notice::kExactPosterior, "exact_posterior", false, kInfo, "exact posterior of test sample {0}: {1}",
     "Take more draws: evaluation.posterior.draws.",
     "Importance sampling from a normal distribution has few effective draws where the posterior is bent."},
    {Notice::kPosteriorDiffers, "posterior_differs", false, kMisleading,
     "{0} of {1} refined estimates differ from the exact posterior by more than 0.3 of its standard "
     "deviations",
     "Infer with the experiment file, which samples the posterior: twinmap infer FILE.",
     "The posterior is not normal: bent, one-sided or of several modes, as least squares cannot see."},
    {Notice::kUnfinishedTraining, "unfinished_training", false, kInfo, "{0}",
     "Allow more: inverse_map.gp.max_evaluations or starts.",
     "The search for the hyperparameters of a Gaussian process used up its evaluations or found noise only."},
    {Notice::kNuisanceSearch, "nuisance_search", false, kInfo,
     "the fit of the unknown initial state and offsets of the {0} model did not converge",
     "Narrow the bounds of the nuisance parameters.",
     "Least squares on the replayed measurement ended at its limit of steps."}};

const std::vector<NoticeText> kTraining{
    {Notice::kNoTrustModel, "no_trust_model", false, kMisleading, "measurements will not be judged: {0}",
     "State the noise of every output and take enough samples.",
     "The goodness-of-fit test needs noise on every feature and some twenty training samples."},
    {Notice::kBlindSpots, "blind_spots", false, kInfo, "blind spot: {0} would go unnoticed",
     "Measure an output on which it acts, if it may be wrong.",
     "The parameters to estimate absorb this error of the model, or the measurement does not show it."},
    {Notice::kSurrogateRescaled, "surrogate_rescaled", false, kInfo,
     "cross-validation: 95 % intervals contained the truth too rarely, so that sds were enlarged: {0}",
     "Nothing need be done; the run's test samples say whether the enlarged intervals hold.",
     "The fast model underestimates its own errors; left-out samples show by how much."},
    {Notice::kSurrogateUncalibrated, "surrogate_uncalibrated", false, kDegraded,
     "the error estimate of the fast model is unreliable (cross-validation)",
     "Refine the estimates on the simulator: refine=always.",
     "Fewer than 80 % of the left-out samples were within their 95 % intervals."},
    {Notice::kHyperparametersAtBound, "hyperparameters_at_bound", false, kInfo,
     "hyperparameters ended at a bound: {0}", "Widen inverse_map.gp.bounds.",
     "The best fit of a Gaussian process lies outside the range that is searched."},
    {Notice::kRestarts, "restarts", false, kDegraded,
     "the network's training diverged {0} times and was set back to its best checkpoint",
     "Lower inverse_map.network.learning_rate.", "Steps were too large for a strongly nonlinear response."},
    {Notice::kChains, "chains", false, kDegraded,
     "the chains of the network's weights have not converged: R-hat {0:.3f}, {1:.0f} effective draws, "
     "{2:.1f} % divergent",
     "Take more draws: inverse_map.network.draws.", "The posterior of the weights is hard to explore."},
    {Notice::kShape, "shape", false, kDegraded,
     "{0}: {1:.0f} % intervals contain {2:.0f} % of the left-out samples; the estimates are not {3}",
     "Describe them by a mixture: inverse_map.network.head=mixture, components={4}.",
     "The errors of the network have another distribution than the one that it states."},
    {Notice::kTeacherFar, "teacher_far", false, kInfo,
     "the surrogate that trains the network is {0:.1f} times above the information limit",
     "Train on simulations alone: design.train.samples={1}.",
     "A network cannot be better than the surrogate whose samples it is trained on."},
    {Notice::kStudentFar, "student_far", false, kInfo,
     "{0}: the network's sd is {1:.1f} times that of the surrogate that trained it",
     "Use the surrogate itself, in milliseconds: inverse_map=surrogate.",
     "The network is too small, or was trained too briefly, to reproduce the surrogate."},
    {Notice::kNotCompared, "not_compared", false, kInfo, "the estimator {0} is not compared: {1}",
     "Mend the cause that is named, or leave it out of evaluation.maps.",
     "The estimator cannot be trained on these samples."},
    {Notice::kPosteriorsUnreliable, "posteriors_unreliable", false, kDegraded,
     "calibration: {0} of {1} posteriors are unreliable", "Refine the estimates: refine=always.",
     "The surrogate is too inaccurate for importance sampling there."},
    {Notice::kPosteriorsUncalibrated, "posteriors_uncalibrated", false, kDegraded,
     "posteriors are not calibrated: {0}", "Look at the histograms of sbc.csv.",
     "The ranks of the true values among the draws are not uniform: the posteriors are biased or of the "
     "wrong width."},
    {Notice::kNoCalibration, "no_calibration", false, kInfo,
     "the calibration of posteriors is not tested: {0}",
     "Leave out evaluation.calibration, or set 'inverse_map: surrogate' or 'none'.",
     "Simulation-based calibration needs a surrogate, or no map at all, and enough reliable posteriors."}};

const std::vector<NoticeText> kFiles{
    {Notice::kRelativeToRange, "relative_to_range", false, kInfo,
     "the bounds of {0} contain 0: its errors are in % of its range",
     "Nothing need be done; write 'relative_to: range' to leave this remark out.",
     "A relative error is undefined where the value may be 0."},
    {Notice::kPlainSweep, "plain_sweep", false, kInfo,
     "design.{0}.method is latin_hypercube: each of its {1} sizes is simulated anew",
     "Take nested_latin_hypercube or sobol, whose larger sizes contain the smaller.",
     "The points of a plain Latin hypercube change with its size."},
    {Notice::kOtherBuild, "other_build", false, kInfo,
     "{0}: samples of the same model are there, computed by another build or machine",
     "Nothing need be done: they are simulated again, as different bits are not mixed.",
     "Processor, compiler or version differ; simulation.portable=true avoids it."},
    {Notice::kSetAside, "set_aside", false, kInfo, "{0}: set aside: {1}",
     "Nothing need be done: its samples are simulated again.", "The file is damaged or incomplete."}};

std::vector<NoticeText> joinAll() {
  std::vector<NoticeText> all;
  for (const auto* part : {&kStatuses, &kSimulation, &kAccuracy, &kTraining, &kFiles}) {
    all.insert(all.end(), part->begin(), part->end());
  }
  std::sort(all.begin(), all.end(),
            [](const NoticeText& a, const NoticeText& b) { return a.notice < b.notice; });
  return all;
}

}  // namespace

const std::vector<NoticeText>& listNotices() {
  static const std::vector<NoticeText> all = joinAll();
  return all;
}

const NoticeText& getNotice(Notice notice) {
  const NoticeText& found = listNotices().at(static_cast<std::size_t>(notice));
  assert(found.notice == notice);
  return found;
}

const NoticeText& getStatus(const std::string& name) {
  const auto found = std::find_if(listNotices().begin(), listNotices().end(), [&](const NoticeText& notice) {
    return notice.is_status && name == notice.name;
  });
  return found == listNotices().end() ? getNotice(Notice::kOk) : *found;
}

bool saysNotice(const std::string& text, Notice notice) {
  const std::string pattern = getNotice(notice).happened;
  std::size_t at = 0;
  for (std::size_t from = 0; from <= pattern.size();) {
    const std::size_t open = std::min(pattern.find('{', from), pattern.size());
    const std::string part = pattern.substr(from, open - from);
    const std::size_t found = text.find(part, at);
    if (found == std::string::npos || (from == 0 && found != 0)) {
      return false;
    }
    at = found + part.size();
    from = open == pattern.size() ? open + 1 : pattern.find('}', open) + 1;
  }
  return true;
}

bool isRemark(const std::string& text) {
  return text.find("\n  Nothing need be done") != std::string::npos;
}

}  // namespace twinmap
