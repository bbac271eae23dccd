#include "framework/study/pipeline/baselines.hpp"

#include <algorithm>
#include <chrono>

#include "framework/analysis/least_squares.hpp"
#include "framework/analysis/linear_map.hpp"
#include "framework/data/sensitivity/fisher_information.hpp"
#include "framework/estimation/box_prior.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/simulation/simulator_team.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

class Stopwatch {
 public:
  double getSeconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The unknown of the training sample whose features are nearest in units of noise.
VectorXd findNearest(const NoiseWhitener& noise, const LabelledFeatures& train, const VectorXd& measured) {
  Index nearest = 0;
  noise.apply(train.features.colwise() - measured).colwise().squaredNorm().minCoeff(&nearest);
  return train.collectUnknown().col(nearest);
}

BaselineResult runPriorMean(const ModelSpec& model, const LabelledFeatures& test) {
  const auto samples = test.features.cols();
  return {"prior_mean", static_cast<int>(samples), predictPriorMean(model, samples)};
}

BaselineResult runLinearRegression(const FeatureTransform& transform, const LabelledSets& sets) {
  const LinearMap map = trainLinearMap(transform, sets.train);
  const auto samples = static_cast<int>(sets.test.features.cols());
  const Stopwatch stopwatch;
  BaselineResult result{"linear_regression", samples, map.predict(sets.test.features, sets.test.inputs)};
  result.seconds_per_update = stopwatch.getSeconds() / samples;
  return result;
}

BaselineResult runLeastSquares(const LeastSquaresSpec& spec, const Study& study, const LabelledSets& sets) {
  const LabelledFeatures& test = sets.test;
  const std::vector<ParameterSpec> unknown = collectUnknown(study.experiment.model);
  const NoiseWhitener noise(test.noise_covariance);
  const VectorXd widths = calcWidths(study.experiment.model.parameters), center = calcBoxCenter(unknown);
  const Index p = widths.size();
  const int samples = std::min(spec.samples, static_cast<int>(test.features.cols()));
  BaselineResult result{"least_squares", samples, {MatrixXd(p, samples), MatrixXd(p, samples)}};
  VectorXd seconds(samples);
  std::vector<char> converged(samples);
  runOnTeam(study.simulator, samples, study.control.threads, [&](Simulator& simulator, int i) {
    const Stopwatch stopwatch;
    const VectorXd measured = test.features.col(i);
    const VectorXd start =
        spec.start == LeastSquaresStart::kBoxCenter ? center : findNearest(noise, sets.train, measured);
    const VectorXd inputs = test.inputs.rows() > 0 ? VectorXd(test.inputs.col(i)) : VectorXd();
    const LeastSquaresFit fit = fitLeastSquares(
        simulator, {study.extractor, noise, unknown, measured, inputs}, start, spec.max_simulations);
    result.predictions.mean.col(i) = fit.parameters.head(p);
    result.predictions.stddev.col(i) =
        calcLimitCovariance(fit.information).diagonal().head(p).cwiseSqrt().cwiseProduct(widths);
    converged[i] = fit.converged;
    seconds[i] = stopwatch.getSeconds();
  });
  result.seconds_per_update = seconds.mean();
  result.unconverged = static_cast<int>(std::count(converged.begin(), converged.end(), 0));
  return result;
}

}  // namespace

Estimates predictPriorMean(const ModelSpec& model, Index samples) {
  const PriorMoments prior = calcPriorMoments(model);
  const auto p = static_cast<Index>(model.parameters.size());
  return {prior.mean.head(p).replicate(1, samples), prior.stddev.head(p).replicate(1, samples)};
}

BaselineResult runBaseline(const BaselineSpec& spec, const Study& study, const LabelledSets& samples,
                           const FeatureTransform& transform) {
  if (std::holds_alternative<PriorMeanSpec>(spec)) {
    return runPriorMean(study.experiment.model, samples.test);
  }
  if (std::holds_alternative<LinearRegressionSpec>(spec)) {
    return runLinearRegression(transform, samples);
  }
  return runLeastSquares(std::get<LeastSquaresSpec>(spec), study, samples);
}

}  // namespace twinmap
