#include "framework/optimal_design/excitation_evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "framework/data/features/experiment_features.hpp"
#include "framework/data/measurement/signal_experiment.hpp"
#include "framework/data/noise/feature_noise.hpp"
#include "framework/data/sensitivity/feature_sensitivities.hpp"
#include "framework/data/sensitivity/fisher_information.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/make_simulator.hpp"
#include "framework/optimal_design/criterion.hpp"
#include "framework/simulation/number_evaluator.hpp"
#include "framework/simulation/sample_generator.hpp"

namespace twinmap::experiment_design {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kOutputTimes = 400;  // at which outputs are held against their limits, besides the features'

VectorXd calcTimes(const ExperimentSpec& experiment, bool dense) {
  const VectorXd needed = collectTimes(experiment.features);
  std::set<double> times(needed.begin(), needed.end());
  for (int i = 1; dense && i <= kOutputTimes; ++i) {
    const double time = experiment.model.simulation.duration * i / kOutputTimes;
    const auto next = times.lower_bound(time - 1e-9);
    if (next == times.end() || *next > time + 1e-9) {
      times.insert(time);
    }
  }
  VectorXd sorted(static_cast<Index>(times.size()));
  std::copy(times.begin(), times.end(), sorted.begin());
  return sorted;
}

std::unique_ptr<Simulator> makeDesignSimulator(const ExperimentSpec& experiment,
                                               const std::vector<Limit>& limits) {
  return makeSimulator(experiment.model, calcTimes(experiment, limitsOutputs(limits)),
                       countModes(experiment.features));
}

/// Sums over the points as they come.
struct LimitSum {
  const ExperimentSpec& experiment;
  const Criterion& criterion;
  DesignLimit& limit;

  void add(Index point, const MatrixXd& information) const {
    constexpr double kHalfWidths = 4.0;  // information per width^2 over that per half-width^2
    const VectorXd widths = calcWidths(experiment.model.parameters);
    const MatrixXd covariance = calcLimitCovariance(information);
    const MatrixXd prior = kHalfWidthInformation * MatrixXd::Identity(widths.size(), widths.size());
    limit.costs[point] = calcCost(criterion, information / kHalfWidths + prior);
    limit.stddev.col(point) = covariance.diagonal().cwiseSqrt().cwiseProduct(widths);
    limit.mean_information += information;
    limit.mean_covariance += covariance;
  }
};

DesignLimit makeEmpty(Index parameters, Index points) {
  DesignLimit limit;
  limit.stddev.setConstant(parameters, points, kNaN);
  limit.costs.setConstant(points, kNaN);
  limit.mean_information.setZero(parameters, parameters);
  limit.mean_covariance.setZero(parameters, parameters);
  return limit;
}

/// Adds the information of every point; returns the largest outputs.
VectorXd addPoints(const std::vector<LocalModel>& models, const FeatureNoise& noise,
                   const ResponseLayout& layout, const LimitSum& sum) {
  const auto p = static_cast<Index>(sum.experiment.model.parameters.size());
  VectorXd largest = VectorXd::Zero(layout.getOutputCount());
  std::optional<NoiseWhitener> whitener;
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (!models[i].status.ok) {
      sum.limit.score.failure = models[i].status.reason;
      return largest;
    }
    if (!whitener || !noise.isConstant()) {
      whitener.emplace(noise.calcCovariance(models[i].response));
    }
    sum.add(static_cast<Index>(i),
            calcMarginalInformation(calcFisherInformation(*whitener, models[i].sensitivities), p));
    largest = largest.cwiseMax(calcLargestOutputs(layout, models[i].response));
  }
  return largest;
}

}  // namespace

ExcitationEvaluator::ExcitationEvaluator(YamlNode tree, std::vector<FreeNumber> numbers, int threads)
    : tree_(std::move(tree)),
      numbers_(std::move(numbers)),
      threads_(threads),
      experiment_(readExperimentWithSignals(tree_)),
      limits_(listLimits(experiment_)),
      criterion_(makeCriterion(experiment_.design.excitation->criterion, experiment_.model.parameters)) {}

ExperimentSpec ExcitationEvaluator::makeExperiment(const VectorXd& values) const {
  return readExperimentWithSignals(makeTree(values));
}

DesignScore ExcitationEvaluator::calcScore(const VectorXd& values, const MatrixXd& points) const {
  return calcLimit(values, points).score;
}

DesignLimit ExcitationEvaluator::calcLimit(const VectorXd& values, const MatrixXd& points) const {
  const ExperimentSpec experiment = makeExperiment(values);
  const std::vector<ParameterSpec>& parameters = experiment.model.parameters;
  DesignLimit limit = makeEmpty(static_cast<Index>(parameters.size()), points.cols());
  limit.score.cost = kNaN;
  limit.score.measures.setConstant(static_cast<Index>(limits_.size()), kNaN);
  try {
    const std::vector<SignalMeasure> signals = calcSignalMeasures(experiment.model);
    const std::unique_ptr<Simulator> simulator = makeDesignSimulator(experiment, limits_);
    const ResponseLayout& layout = simulator->getLayout();
    const FeatureExtractor extractor = makeExtractor(experiment, layout);
    const FeatureNoise noise(extractor, ResponseNoise(experiment.noise, layout), experiment.seed);
    const std::vector<LocalModel> models =
        calcLocalModels(*simulator, extractor, collectUnknown(experiment.model), points, threads_);
    const VectorXd largest = addPoints(models, noise, layout, {experiment, criterion_, limit});
    limit.score.measures = measureLimits(limits_, signals, largest);
  } catch (const SimulationFailure& failure) {
    limit.score.failure = failure.what();
  }
  const auto count = static_cast<double>(points.cols());
  limit.mean_information /= count;
  limit.mean_covariance /= count;
  limit.score.cost = limit.score.failure.empty() ? limit.costs.mean() : kNaN;
  return limit;
}

DesignScore ExcitationEvaluator::calcMeasures(const VectorXd& values, const MatrixXd& points) const {
  const ExperimentSpec experiment = makeExperiment(values);
  DesignScore score;
  const std::unique_ptr<Simulator> simulator = makeDesignSimulator(experiment, limits_);
  GeneratorOptions options;
  options.threads = threads_;
  const Trajectories samples = generateSamples(*simulator, points, options);
  for (const SampleStatus& status : samples.statuses) {
    if (!status.ok) {
      score.failure = status.reason;
      return score;
    }
  }
  score.measures = measureLimits(limits_, calcSignalMeasures(experiment.model),
                                 calcLargestOutputs(samples.layout, samples.responses));
  return score;
}

}  // namespace twinmap::experiment_design
