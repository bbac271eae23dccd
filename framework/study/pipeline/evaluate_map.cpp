#include "framework/study/pipeline/evaluate_map.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "framework/analysis/information_limit.hpp"
#include "framework/base/log/notice.hpp"
#include "framework/base/log/stage_timer.hpp"
#include "framework/data/sensitivity/fisher_information.hpp"
#include "framework/estimation/box_prior.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/prior.hpp"
#include "framework/study/pipeline/baselines.hpp"
#include "framework/study/pipeline/calibrate_posteriors.hpp"
#include "framework/study/pipeline/evaluate_estimates.hpp"
#include "framework/study/pipeline/exact_posteriors.hpp"
#include "framework/study/pipeline/select_answers.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

const std::vector<ParameterSpec>& getParameters(const Study& study) {
  return study.experiment.model.parameters;
}

/// Empty where all is uniform.
VectorXd calcPriorStddev(const Study& study) {
  const auto p = static_cast<Index>(getParameters(study).size());
  const std::shared_ptr<const Prior> prior = findPrior(study.experiment.model);
  return prior ? VectorXd(prior->calcStddevs().head(p)) : VectorXd();
}

/// The limit, if the experiment has one.
std::optional<InformationLimit> findLimit(const Study& study, const PreparedData& data, StageNotes& notes) {
  const LabelledFeatures& test = data.labelled.test;
  if (hasInformationLimit(study.experiment, test)) {
    return timeStage(fmt::format("information limit of {} test samples", test.parameters.cols()), notes, [&] {
      const Prior prior(collectUnknown(study.experiment.model), study.experiment.model.priors);
      return calcInformationLimit(calcLocalModels(study, test.collectPoints()), study.noise,
                                  getParameters(study), prior.calcInformation(test.collectUnknown()));
    });
  }
  if (study.experiment.evaluation.limit) {
    notes.warn(makeWarning(Notice::kNoLimit));
  }
  return std::nullopt;
}

/// The exact posteriors of the first test samples.
std::vector<SimulatorPosterior> calcPosteriors(const Study& study, const LabelledFeatures& test,
                                               StageNotes& notes) {
  const PosteriorSpec& spec = *study.experiment.evaluation.posterior;
  const Index count = std::min<Index>(spec.samples, test.features.cols());
  return timeStage(fmt::format("exact posterior of {} test samples", count), notes,
                   [&] { return sampleTestPosteriors(study, test, count, spec.draws); });
}

/// Exact posteriors beside what the map infers.
std::vector<PosteriorComparison> comparePosteriors(const PreparedData& data,
                                                   const std::vector<SimulatorPosterior>& exact,
                                                   const Estimates& predictions,
                                                   const Eigen::MatrixXd& limit_stddev, StageNotes& notes) {
  const Index p = predictions.mean.rows();
  const VectorXd unknown = VectorXd::Constant(p, std::numeric_limits<double>::quiet_NaN());
  std::vector<PosteriorComparison> compared;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const auto column = static_cast<Index>(i);
    const int sample = data.test_indices[i];
    const bool reliable = exact[i].isReliable();
    compared.push_back({sample, reliable ? VectorXd(exact[i].mean.head(p)) : unknown,
                        reliable ? VectorXd(exact[i].stddev.head(p)) : unknown,
                        exact[i].effective_sample_size, exact[i].simulations, predictions.mean.col(column),
                        predictions.stddev.col(column),
                        limit_stddev.cols() > 0 ? VectorXd(limit_stddev.col(column)) : VectorXd()});
    if (!reliable) {
      notes.warn(makeWarning(Notice::kExactPosterior, sample, exact[i].message));
    }
  }
  return compared;
}

/// The exact posteriors in the evaluation, beside the map's and the refined estimates, with a warning where
/// these differ.
void addPosteriors(const Study& study, const PreparedData& data, const Estimates& predictions,
                   const Eigen::MatrixXd& limit_stddev, MapEvaluation& result) {
  const LabelledFeatures& test = data.labelled.test;
  const std::vector<SimulatorPosterior> exact = calcPosteriors(study, test, result.notes);
  Evaluation& evaluation = result.evaluation;
  evaluation.posteriors = comparePosteriors(data, exact, predictions, limit_stddev, result.notes);
  const PosteriorDifference difference =
      compareRefined(evaluation.refined, exact, static_cast<Index>(getParameters(study).size()));
  if (difference.compared > 0) {
    evaluation.methods.back().apart_from_posterior = difference.calcShare();
  }
  if (difference.compared > 0 && difference.isConspicuous()) {
    result.notes.warn(makeWarning(Notice::kPosteriorDiffers, difference.apart, difference.compared));
  }
  evaluation.methods.push_back(
      summarizePosteriors(getParameters(study), test.parameters, exact, limit_stddev));
}

BaselineSummary summarizeBaseline(const Study& study, const LabelledFeatures& test,
                                  const BaselineResult& result) {
  const Eigen::MatrixXd truth = test.parameters.leftCols(result.samples);
  return {result.method, result.samples, calcMetrics(getParameters(study), truth, result.predictions),
          result.seconds_per_update, result.unconverged};
}

/// The map on the same first samples.
BaselineResult runMap(const TrainedMap& map, const LabelledFeatures& test, int samples) {
  BaselineResult result{"map", samples, {}};
  const Eigen::MatrixXd features = test.features.leftCols(samples), inputs = test.inputs.leftCols(samples);
  const auto start = std::chrono::steady_clock::now();
  for (Index i = 0; i < samples; ++i) {
    map.predict(features.col(i), inputs.col(i));
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  result.predictions = map.predict(features, inputs);
  result.seconds_per_update = elapsed.count() / samples;
  return result;
}

BaselineResult timeBaseline(const BaselineSpec& spec, const Study& study, const LabelledSets& samples,
                            const FeatureTransform& transform, StageNotes& notes) {
  BaselineResult result =
      timeStage("baseline", notes, [&] { return runBaseline(spec, study, samples, transform); });
  notes.times.back().stage = "baseline " + result.method;
  if (result.unconverged > 0) {
    notes.warn(makeWarning(Notice::kUnconverged, result.unconverged, result.samples, result.method));
  }
  return result;
}

/// The baselines, each after the map's own row on the same samples.
std::vector<BaselineSummary> runBaselines(const Study& study, const LabelledSets& samples,
                                          const TrainedMap& map, StageNotes& notes) {
  std::vector<BaselineSummary> rows;
  int compared = 0;  // samples of the map's own row before
  for (const BaselineSpec& spec : study.experiment.evaluation.baselines) {
    const BaselineResult result = timeBaseline(spec, study, samples, map.transform, notes);
    if (result.samples != compared) {
      rows.push_back(summarizeBaseline(study, samples.test, runMap(map, samples.test, result.samples)));
      compared = result.samples;
    }
    rows.push_back(summarizeBaseline(study, samples.test, result));
  }
  return rows;
}

/// What the answers say of the derived quantities, if there are any.
std::optional<DerivedEvaluation> evaluateDerivedOf(const Study& study, const LabelledFeatures& test,
                                                   const Estimates& estimates,
                                                   const std::optional<InformationLimit>& limit) {
  const DerivedQuantities quantities(study.experiment);
  if (quantities.count() == 0) {
    return std::nullopt;
  }
  return evaluateDerived(quantities, test.parameters, estimates,
                         limit ? calcDerivedLimit(quantities, getParameters(study), test.parameters, *limit)
                               : Eigen::MatrixXd());
}

void addLimit(const Study& study, const LabelledFeatures& test, const InformationLimit& limit,
              MapEvaluation& result) {
  result.evaluation.relevance =
      FeatureRelevance{test.infos, test.noise_covariance.diagonal().cwiseSqrt(), limit.relevance};
  result.evaluation.identifiability = calcIdentifiability(limit, getParameters(study));
  result.notes.warn(Severity::kDegraded, result.evaluation.identifiability->warnings);
  const DerivedQuantities quantities(study.experiment);
  result.evaluation.ridges = findRidges(limit.information, test.parameters, getParameters(study));
  result.notes.warn(Severity::kDegraded,
                    adviseOnRidges(result.evaluation.ridges, study.experiment.model.parameters,
                                   quantities.count() > 0 ? &quantities : nullptr, test.parameters.col(0)));
  if (limit.failures > 0) {
    result.notes.warn(makeWarning(Notice::kLimitFailed, limit.failures));
  }
}

OnlineTimes summarizeTimes(VectorXd seconds) {
  constexpr double kMicro = 1e6;
  std::sort(seconds.begin(), seconds.end());
  const Index last = seconds.size() - 1;
  return {static_cast<int>(seconds.size()), kMicro * seconds[last / 2], kMicro * seconds[last * 99 / 100]};
}

/// A warning of those that are not reliable, or an error where too few are.
void requireReliable(const std::vector<SimulatorPosterior>& exact, std::size_t reliable, StageNotes& notes) {
  constexpr std::size_t kMin = 3;  // for a standard error
  const auto first = std::find_if(exact.begin(), exact.end(),
                                  [](const SimulatorPosterior& one) { return !one.isReliable(); });
  if (first == exact.end()) {
    return;
  }
  const std::string text =
      fmt::format("the posteriors of {} of {} test samples are not reliable and left out of the tables: {}",
                  exact.size() - reliable, exact.size(), first->message);
  if (reliable < kMin) {
    throw std::runtime_error(text + ". Give narrower bounds");
  }
  notes.warn(Severity::kDegraded, std::vector<std::string>{text});
}

}  // namespace

MapEvaluation evaluateMap(const Study& study, const PreparedData& data, TrainedMap& map) {
  const LabelledFeatures& test = data.labelled.test;
  const std::vector<ParameterSpec>& parameters = getParameters(study);
  MapEvaluation result;
  const std::optional<InformationLimit> limit = findLimit(study, data, result.notes);
  const Eigen::MatrixXd limit_stddev = limit ? limit->stddev : Eigen::MatrixXd();
  const InferredTests tests = inferTestSamples(study, data, map);
  result.notes.append(tests.notes);
  const Estimates& predictions = tests.by_estimator;
  const Estimates answers = selectAnswers(tests, map.residual_correlation, test.parameters);
  result.evaluation = evaluateEstimates(parameters, test.parameters, answers, limit_stddev);
  result.evaluation.prior_stddev = calcPriorStddev(study);
  result.evaluation.derived = evaluateDerivedOf(study, test, answers, limit);
  result.evaluation.curves = estimateCurves(study.experiment, test.parameters, answers);
  result.evaluation.methods =
      summarizeMethods(map.name, parameters, test.parameters, predictions, tests.refined, limit_stddev);
  result.evaluation.refined = tests.refined;
  result.evaluation.answers = summarizeAnswers(tests);
  if (limit) {
    addLimit(study, test, *limit, result);
  }
  if (study.experiment.evaluation.posterior) {
    addPosteriors(study, data, predictions, limit_stddev, result);
  }
  if (!tests.listSampled().empty()) {
    result.evaluation.methods.push_back(
        summarizeSampled(parameters, test.parameters, tests, answers, limit_stddev));
  }
  if (study.experiment.evaluation.calibration == PosteriorCalibrationMethod::kSimulationBased) {
    CalibratedPosteriors calibrated = calibratePosteriors(study, data, map);
    result.evaluation.calibration = std::move(calibrated.calibration);
    result.notes.append(calibrated.notes);
  }
  result.evaluation.baselines = runBaselines(study, data.labelled, map, result.notes);
  return result;
}

PosteriorEvaluation evaluatePosteriors(const Study& study, PreparedData& data) {
  const LabelledFeatures& test = data.labelled.test;
  const std::vector<ParameterSpec>& parameters = getParameters(study);
  PosteriorEvaluation result;
  StageNotes& notes = result.evaluated.notes;
  const Index count = test.features.cols();
  VectorXd seconds;
  const std::vector<SimulatorPosterior> exact = timeStage(
      fmt::format("exact posteriors of {} test samples", count), notes,
      [&] { return sampleTestPosteriors(study, test, count, SimulatorPosteriorOptions{}.draws, &seconds); });
  result.times = summarizeTimes(seconds);
  ReliablePosteriors reliable = takeReliable(exact, static_cast<Index>(parameters.size()));
  requireReliable(exact, reliable.samples.size(), notes);
  const std::optional<InformationLimit> limit = findLimit(study, data, notes);
  const Eigen::MatrixXd limit_stddev = limit ? limit->stddev : Eigen::MatrixXd();
  const auto choose = [&](const Eigen::MatrixXd& values) {
    return values.cols() > 0 ? Eigen::MatrixXd(values(Eigen::all, reliable.samples)) : Eigen::MatrixXd();
  };
  Evaluation& evaluation = result.evaluated.evaluation;
  evaluation =
      evaluateEstimates(parameters, choose(test.parameters), reliable.estimates, choose(limit_stddev));
  evaluation.curves = estimateCurves(study.experiment, choose(test.parameters), reliable.estimates);
  evaluation.prior_stddev = calcPriorStddev(study);
  evaluation.methods = {summarizePosteriors(parameters, test.parameters, exact, limit_stddev)};
  if (limit) {
    addLimit(study, test, *limit, result.evaluated);
  }
  if (study.experiment.evaluation.calibration == PosteriorCalibrationMethod::kSimulationBased) {
    CalibratedPosteriors calibrated = calibratePosteriors(study, test, exact);
    evaluation.calibration = std::move(calibrated.calibration);
    notes.append(calibrated.notes);
  }
  std::vector<int> kept;
  for (const Index i : reliable.samples) {
    kept.push_back(data.test_indices[static_cast<std::size_t>(i)]);
  }
  data.test_indices = std::move(kept);
  return result;
}

}  // namespace twinmap
