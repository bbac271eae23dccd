#include "framework/study/pipeline/baselines.hpp"

#include <algorithm>
#include <chrono>

#include "framework/analysis/linear_map.hpp"
#include "framework/data/sensitivity/stencil_simulator.hpp"
#include "framework/estimation/box_prior.hpp"
#include "framework/estimation/refined/search.hpp"
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

/// How many iterations `most` simulations are, by a linearisation each (search.hpp).
int countIterations(const Simulator& simulator, const RefinementModel& model, int most) {
  constexpr int kTrials = 4;
  const int linearization = simulator.hasDerivatives() ? 1 : countNeighbours(model.getUnknown().size());
  return std::max(0, (most - linearization) / (kTrials + linearization));
}

/// The end of a search with the inputs held.
struct LeastSquaresFit {
  VectorXd mean, stddev;  ///< of all that is unknown
  bool converged = false;
};

LeastSquaresFit fitLeastSquares(Simulator& simulator, const RefinementModel& model, const VectorXd& start,
                                const VectorXd& inputs, const VectorXd& measured, int max_simulations) {
  VectorXd point(start.size() + inputs.size());
  point << start, inputs;
  const SearchBox box(model.getUnknown(), {0, start.size()}, point);
  Misfit misfit(simulator, model, box, measured);
  const SearchEnd end =
      search(misfit, box.normalize(point), countIterations(simulator, model, max_simulations));
  LeastSquaresFit fit{start, 0.5 * calcWidths(model.getUnknown()), end.converged};
  if (end.local.status.ok) {
    fit.mean = box.makePoint(end.local.at).head(start.size());
    fit.stddev = fit.stddev.cwiseProduct(end.local.calcCovariance().diagonal().cwiseSqrt());
  }
  return fit;
}

BaselineResult runLeastSquares(const LeastSquaresSpec& spec, const Study& study, const LabelledSets& sets) {
  const LabelledFeatures& test = sets.test;
  const RefinementModel model(collectUnknown(study.experiment.model), study.extractor, study.noise);
  const NoiseWhitener noise(test.noise_covariance);
  const VectorXd center = calcBoxCenter(model.getUnknown());
  const auto p = static_cast<Index>(study.experiment.model.parameters.size());
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
    const LeastSquaresFit fit =
        fitLeastSquares(simulator, model, start, inputs, measured, spec.max_simulations);
    result.predictions.mean.col(i) = fit.mean.head(p);
    result.predictions.stddev.col(i) = fit.stddev.head(p);
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
