#include "framework/estimation/trained/fit_trust.hpp"

#include <algorithm>
#include <stdexcept>

#include "framework/base/random/random.hpp"
#include "framework/data/reduction/affine_step.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Neighbouring features of one output. Where whitening mixes the features to fewer numbers, one run.
std::vector<ResidualRun> collectRuns(const std::vector<FeatureInfo>& infos, Index residuals) {
  if (residuals != static_cast<Index>(infos.size())) {
    return {{0, residuals}};
  }
  std::vector<ResidualRun> runs;
  for (Index i = 0; i < residuals; ++i) {
    if (i == 0 || infos[i].output != infos[i - 1].output) {
      runs.push_back({i, 0});
    }
    ++runs.back().count;
  }
  return runs;
}

TrainingCloud makeCloud(const Estimator& map, const TrustTraining& training, const MatrixXd& known) {
  constexpr Index kMax = 1000;
  const Index n = std::min(training.points.cols(), kMax);
  TrainingCloud cloud;
  cloud.inputs = map.makeInputs(training.clean_features.leftCols(n), known.leftCols(n));
  cloud.scale = fitZScore(cloud.inputs).scale;
  cloud.inputs = cloud.scale.cwiseInverse().asDiagonal() * cloud.inputs;
  return cloud;
}

void sort(VectorXd& values) {
  std::sort(values.data(), values.data() + values.size());
}

/// The statistics of the simulated measurements, by a model whose references are still empty. None depends on
/// the inferred standard deviation.
void fitReferences(const TrustTraining& training, const Estimator& map, const TrainingControl& control,
                   TrustModel& model) {
  const Index count = training.measured.cols();
  VectorXd chi_squares(count), anomalies(count), distances(count);
  runChunks(control.threads, count, [&](Index first, Index end) {
    gp::throwIfStopped(control.stop);
    const std::unique_ptr<Estimator::Workspace> inferring = map.makeWorkspace();
    TrustWorkspace judging(model);
    for (Index i = first; i < end; ++i) {
      const auto features = training.measured.col(i);
      const auto known = training.known.col(i);
      const Estimate& estimate = map.inferMean(features, known, *inferring);
      const Trust trust = judge(model, features, known, estimate, inferring->findExplanation(), judging);
      chi_squares[i] = trust.chi_square;
      anomalies[i] = trust.anomaly.score;
      distances[i] = trust.distance;
    }
  });
  sort(chi_squares);
  sort(anomalies);
  model.chi_square.sorted = std::move(chi_squares);
  model.anomaly.sorted = std::move(anomalies);
  const double reach = distances.maxCoeff();
  model.cloud.reach = reach > 0.0 ? reach : 1.0;
}

/// Anomalys of noise that nothing was fitted to: a search leaves a little less.
ReferenceDistribution calcNoiseAnomalys(const std::vector<ResidualRun>& runs, Index residuals,
                                        std::uint64_t seed, int threads) {
  constexpr Index kDraws = 4000;  // the 0.25 % quantile, half of half of the usual level, to a third
  const RandomStream random(seed, RandomPurpose::kNoiseAnomaly);
  ReferenceDistribution anomalies;
  anomalies.sorted.resize(kDraws);
  runChunks(threads, kDraws, [&](Index first, Index end) {
    VectorXd noise(residuals);
    for (Index draw = first; draw < end; ++draw) {
      random.drawNormals(static_cast<std::uint64_t>(draw), 0, noise.data(),
                         static_cast<std::size_t>(residuals));
      anomalies.sorted[draw] = findAnomaly(noise, runs).score;
    }
  });
  sort(anomalies.sorted);
  return anomalies;
}

}  // namespace

TrustModel fitTrustModel(const TrustTraining& training, std::shared_ptr<const ForwardSurrogate> surrogate,
                         const Estimator& map, double level, const TrainingControl& control) {
  if (training.measured.cols() == 0) {
    throw std::invalid_argument("a trust model needs simulated measurements");
  }
  TrustModel model;
  model.forward = std::move(surrogate);
  model.space =
      fitResidualSpace(training.infos, training.clean_features, training.noise_covariance, *model.forward);
  model.cloud = makeCloud(map, training, training.points.bottomRows(training.known.rows()));
  model.center = calcBoxCenter(training.sampled);
  model.half_width = 0.5 * calcWidths(training.sampled);
  model.unknown = training.prior.count();
  model.prior = training.prior;
  model.level = level;
  const Index residuals = model.space.directions.rows();
  model.runs = collectRuns(training.infos, residuals);
  model.noise_anomaly = calcNoiseAnomalys(model.runs, residuals, training.seed, control.threads);
  fitReferences(training, map, control, model);
  return model;
}

}  // namespace twinmap
