#include "framework/experiment/evaluate_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "framework/evaluation/baselines.hpp"
#include "framework/evaluation/calibration.hpp"
#include "framework/evaluation/information_limit.hpp"
#include "framework/monitoring/stage_timer.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

const std::vector<ParameterSpec>& getParameters(const EvaluationContext& context) {
  return context.experiment.model.parameters;
}

void addLimit(const EvaluationContext& context, RunSummary& run) {
  const LabelledFeatures& test = context.samples.test;
  const InformationLimit limit =
      timeStage(fmt::format("information limit of {} test samples", test.parameters.cols()), run.times, [&] {
        return calcInformationLimit(context.local_models(test.collectPoints()), context.noise,
                                    getParameters(context));
      });
  run.limit_stddev = limit.stddev;
  run.relevance = FeatureRelevance{test.infos, test.noise_covariance.diagonal().cwiseSqrt(), limit.relevance};
  run.identifiability = calcIdentifiability(limit, getParameters(context));
  run.warnings.insert(run.warnings.end(), run.identifiability->warnings.begin(),
                      run.identifiability->warnings.end());
  if (limit.failures > 0) {
    run.warnings.push_back(
        fmt::format("the information limit of {} test samples could not be computed", limit.failures));
  }
}

/// The posterior of the first `count` parameters, those that are inferred.
ExactPosterior takeUpdating(ExactPosterior posterior, Index count) {
  posterior.mean.conservativeResize(count);
  posterior.stddev.conservativeResize(count);
  return posterior;
}

void addPosteriors(const EvaluationContext& context, RunSummary& run) {
  const PosteriorSpec& spec = *context.experiment.evaluation.posterior;
  const LabelledFeatures& test = context.samples.test;
  const Index count = std::min<Index>(spec.samples, test.features.cols());
  const std::vector<ExactPosterior> exact =
      timeStage(fmt::format("exact posterior of {} test samples", count), run.times, [&] {
        return calcExactPosteriors(context.simulator, context.extractor, NoiseWhitener(test.noise_covariance),
                                   context.unknown, test.features.leftCols(count),
                                   test.collectUnknown().leftCols(count), test.inputs, context.threads,
                                   {spec.draws, context.experiment.seed});
      });
  for (Index i = 0; i < count; ++i) {
    run.posteriors.push_back({run.test_indices[i], takeUpdating(exact[i], test.parameters.rows()),
                              run.predictions.mean.col(i), run.predictions.stddev.col(i),
                              run.limit_stddev.cols() > 0 ? VectorXd(run.limit_stddev.col(i)) : VectorXd()});
    if (!exact[i].warning.empty()) {
      run.warnings.push_back(
          fmt::format("exact posterior of test sample {}: {}", run.test_indices[i], exact[i].warning));
    }
  }
}

BaselineSummary summarize(const EvaluationContext& context, const BaselineResult& result) {
  const Eigen::MatrixXd truth = context.samples.test.parameters.leftCols(result.samples);
  return {result.method, result.samples, calcMetrics(getParameters(context), truth, result.predictions),
          result.seconds_per_update, result.unconverged};
}

/// The map on the same first samples.
BaselineResult runMap(const EvaluationContext& context, int samples) {
  BaselineResult result{"map", samples, {}};
  const LabelledFeatures& test = context.samples.test;
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

void addBaselines(const EvaluationContext& context, RunSummary& run) {
  const BaselineContext baseline{context.simulator,      context.extractor, context.map.transform,
                                 getParameters(context), context.unknown,   context.threads};
  int compared = 0;  // samples of the map's own row before
  for (const BaselineSpec& spec : context.experiment.evaluation.baselines) {
    const BaselineResult result = timeStage("baseline", run.times, [&] {
      return runBaseline(spec, baseline, context.samples.train, context.samples.test);
    });
    if (result.samples != compared) {
      run.baselines.push_back(summarize(context, runMap(context, result.samples)));
      compared = result.samples;
    }
    run.baselines.push_back(summarize(context, result));
    run.times.back().stage = "baseline " + result.method;
    if (result.unconverged > 0) {
      run.warnings.push_back(fmt::format("baseline {}: {} of {} searches did not converge", result.method,
                                         result.unconverged, result.samples));
    }
  }
}

}  // namespace

bool hasInformationLimit(const ExperimentSpec& experiment, const LabelledFeatures& test) {
  return experiment.evaluation.limit && test.noise_covariance.diagonal().minCoeff() > 0.0;
}

void calcTestMetrics(const GpMap& map, RunSummary& run) {
  run.metrics = calcMetrics(run.parameters, run.truth, run.predictions, run.limit_stddev);
  run.joint = calcJointMetrics(run.truth, run.predictions, map.residual_correlation);
  const Eigen::MatrixXd pit = calcPit(run.truth, run.predictions);
  for (const auto& row : pit.rowwise()) {
    run.pit_counts.push_back(countPit(row.transpose()));
  }
}

void evaluate(const EvaluationContext& context, RunSummary& run) {
  const EvaluationSpec& spec = context.experiment.evaluation;
  const LabelledFeatures& test = context.samples.test;
  run.truth = test.parameters;
  run.predictions = timeStage("infer the test samples", run.times,
                              [&] { return context.map.predict(test.features, test.inputs); });
  if (hasInformationLimit(context.experiment, test)) {
    addLimit(context, run);
  } else if (spec.limit) {
    run.warnings.push_back("no information limit: the noise of a feature is 0");
  }
  calcTestMetrics(context.map, run);
  if (spec.posterior) {
    addPosteriors(context, run);
  }
  addBaselines(context, run);
}

}  // namespace twinmap
