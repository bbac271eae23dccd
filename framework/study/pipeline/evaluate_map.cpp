#include "framework/study/pipeline/evaluate_map.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>

#include "framework/analysis/baselines.hpp"
#include "framework/analysis/information_limit.hpp"
#include "framework/base/log/stage_timer.hpp"
#include "framework/data/sensitivity/fisher_information.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/study/pipeline/answers.hpp"
#include "framework/study/pipeline/calibrate_posteriors.hpp"
#include "framework/study/pipeline/refine_test_samples.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

const std::vector<ParameterSpec>& getParameters(const EvaluationContext& context) {
  return context.experiment.model.parameters;
}

const LabelledFeatures& getTest(const EvaluationContext& context) {
  return context.data.labelled.test;
}

/// The limit, if the experiment has one.
std::optional<InformationLimit> findLimit(const EvaluationContext& context, StageNotes& notes) {
  const LabelledFeatures& test = getTest(context);
  if (hasInformationLimit(context.experiment, test)) {
    return timeStage(fmt::format("information limit of {} test samples", test.parameters.cols()), notes, [&] {
      return calcInformationLimit(context.local_models(test.collectPoints()), context.data.noise,
                                  getParameters(context));
    });
  }
  if (context.experiment.evaluation.limit) {
    notes.warn(Severity::kInfo, "no information limit: the noise of a feature is 0");
  }
  return std::nullopt;
}

/// The posterior of the first `count` parameters, those that are inferred.
ExactPosterior takeUpdating(ExactPosterior posterior, Index count) {
  posterior.mean.conservativeResize(count);
  posterior.stddev.conservativeResize(count);
  return posterior;
}

std::vector<ExactPosterior> calcPosteriors(const EvaluationContext& context, Index count, StageNotes& notes) {
  const PosteriorSpec& spec = *context.experiment.evaluation.posterior;
  const LabelledFeatures& test = getTest(context);
  return timeStage(fmt::format("exact posterior of {} test samples", count), notes, [&] {
    return calcExactPosteriors(
        context.simulator, context.extractor, NoiseWhitener(test.noise_covariance),
        collectUnknown(context.experiment.model),
        {test.features.leftCols(count), test.collectUnknown().leftCols(count), test.inputs},
        {spec.draws, context.experiment.seed, context.control.threads});
  });
}

/// The exact posteriors of the first test samples beside what the map infers of them.
std::vector<PosteriorComparison> comparePosteriors(const EvaluationContext& context,
                                                   const Predictions& predictions,
                                                   const Eigen::MatrixXd& limit_stddev, StageNotes& notes) {
  const Index count =
      std::min<Index>(context.experiment.evaluation.posterior->samples, getTest(context).features.cols());
  const std::vector<ExactPosterior> exact = calcPosteriors(context, count, notes);
  std::vector<PosteriorComparison> compared;
  for (Index i = 0; i < count; ++i) {
    const int sample = context.data.test_indices[i];
    compared.push_back({sample, takeUpdating(exact[i], predictions.mean.rows()), predictions.mean.col(i),
                        predictions.stddev.col(i),
                        limit_stddev.cols() > 0 ? VectorXd(limit_stddev.col(i)) : VectorXd()});
    if (!exact[i].warning.empty()) {
      notes.warn(Severity::kInfo,
                 fmt::format("exact posterior of test sample {}: {}", sample, exact[i].warning));
    }
  }
  return compared;
}

BaselineSummary summarizeBaseline(const EvaluationContext& context, const BaselineResult& result) {
  const Eigen::MatrixXd truth = getTest(context).parameters.leftCols(result.samples);
  return {result.method, result.samples, calcMetrics(getParameters(context), truth, result.predictions),
          result.seconds_per_update, result.unconverged};
}

/// The map on the same first samples.
BaselineResult runMap(const EvaluationContext& context, int samples) {
  BaselineResult result{"map", samples, {}};
  const LabelledFeatures& test = getTest(context);
  const Eigen::MatrixXd features = test.features.leftCols(samples), inputs = test.inputs.leftCols(samples);
  const auto start = std::chrono::steady_clock::now();
  for (Index i = 0; i < samples; ++i) {
    context.map.predict(features.col(i), inputs.col(i));
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  result.predictions = context.map.predict(features, inputs);
  result.seconds_per_update = elapsed.count() / samples;
  return result;
}

BaselineResult timeBaseline(const BaselineSpec& spec, const EvaluationContext& context, StageNotes& notes) {
  const std::vector<ParameterSpec> unknown = collectUnknown(context.experiment.model);
  const BaselineContext baseline{context.simulator,      context.extractor, context.map.transform,
                                 getParameters(context), unknown,           context.control.threads};
  BaselineResult result = timeStage("baseline", notes, [&] {
    return runBaseline(spec, baseline, context.data.labelled.train, getTest(context));
  });
  notes.times.back().stage = "baseline " + result.method;
  if (result.unconverged > 0) {
    notes.warn(Severity::kInfo, fmt::format("baseline {}: {} of {} searches did not converge", result.method,
                                            result.unconverged, result.samples));
  }
  return result;
}

/// The baselines, each after the map's own row on the same samples.
std::vector<BaselineSummary> runBaselines(const EvaluationContext& context, StageNotes& notes) {
  std::vector<BaselineSummary> rows;
  int compared = 0;  // samples of the map's own row before
  for (const BaselineSpec& spec : context.experiment.evaluation.baselines) {
    const BaselineResult result = timeBaseline(spec, context, notes);
    if (result.samples != compared) {
      rows.push_back(summarizeBaseline(context, runMap(context, result.samples)));
      compared = result.samples;
    }
    rows.push_back(summarizeBaseline(context, result));
  }
  return rows;
}

/// The test samples refined, where the experiment asks for it.
std::vector<Refined> refine(const EvaluationContext& context, StageNotes& notes) {
  RefinedTests refined = refineTestSamples({context.experiment, context.simulator, context.extractor,
                                            context.data, context.map.online, context.control});
  notes.append(refined.notes);
  return std::move(refined.refined);
}

void addLimit(const EvaluationContext& context, const InformationLimit& limit, MapEvaluation& result) {
  const LabelledFeatures& test = getTest(context);
  result.evaluation.relevance =
      FeatureRelevance{test.infos, test.noise_covariance.diagonal().cwiseSqrt(), limit.relevance};
  result.evaluation.identifiability = calcIdentifiability(limit, getParameters(context));
  result.notes.warn(Severity::kDegraded, result.evaluation.identifiability->warnings);
  if (limit.failures > 0) {
    result.notes.warn(
        Severity::kInfo,
        fmt::format("the information limit of {} test samples could not be computed", limit.failures));
  }
}

}  // namespace

MapEvaluation evaluateMap(const EvaluationContext& context) {
  const LabelledFeatures& test = getTest(context);
  const std::vector<ParameterSpec>& parameters = getParameters(context);
  MapEvaluation result;
  const Predictions predictions = timeStage("infer the test samples", result.notes,
                                            [&] { return context.map.predict(test.features, test.inputs); });
  const std::optional<InformationLimit> limit = findLimit(context, result.notes);
  const Eigen::MatrixXd limit_stddev = limit ? limit->stddev : Eigen::MatrixXd();
  const std::vector<Refined> refined = refine(context, result.notes);
  result.evaluation =
      evaluateAnswers(parameters, test.parameters,
                      makeAnswers(predictions, context.map.residual_correlation, refined), limit_stddev);
  result.evaluation.methods = {
      summarizeMap(context.map.name, parameters, test.parameters, predictions, limit_stddev)};
  if (!refined.empty()) {
    result.evaluation.methods.push_back(summarizeRefined(parameters, test.parameters, refined, limit_stddev));
    result.evaluation.refined = refined;
  }
  if (limit) {
    addLimit(context, *limit, result);
  }
  if (context.experiment.evaluation.posterior) {
    result.evaluation.posteriors = comparePosteriors(context, predictions, limit_stddev, result.notes);
  }
  if (context.experiment.evaluation.calibration == PosteriorCalibrationMethod::kSimulationBased) {
    CalibratedPosteriors calibrated = calibratePosteriors(context);
    result.evaluation.calibration = std::move(calibrated.calibration);
    result.notes.append(calibrated.notes);
  }
  result.evaluation.baselines = runBaselines(context, result.notes);
  return result;
}

}  // namespace twinmap
