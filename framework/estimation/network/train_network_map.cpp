#include "framework/estimation/network/train_network_map.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "framework/data/features/labelled_features.hpp"
#include "framework/estimation/folds.hpp"
#include "framework/estimation/interval_factor.hpp"
#include "framework/estimation/network/canonical_inputs.hpp"
#include "framework/estimation/network/training_warnings.hpp"
#include "framework/estimation/run_tasks.hpp"
#include "framework/estimation/surrogate/cross_validation.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "kernels/linalg/order.hpp"
#include "kernels/linalg/paired_matrix.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Of held-out samples with draws of their noise: enough for quantiles, and where these alone tell how
// calibrated a network is, for a factor within 1 %.
constexpr Index kColumnsOfFew = 2000, kColumnsOfMany = 8000;

/// One of how many is held out: of five, until a tenth are enough to tell how calibrated the network is.
Index calcPeriod(Index samples) {
  return samples < NetworkMapSpec::kVeryMany ? 5 : 10;
}

/// count: of all samples, where `all` are those of a fold.
Split split(const std::vector<Index>& all, Index count) {
  const auto period = static_cast<std::size_t>(calcPeriod(count));
  Split parts;
  for (std::size_t i = 0; i < all.size(); ++i) {
    (i % period == period - 1 ? parts.held_out : parts.training).push_back(all[i]);
  }
  return parts;
}

/// Parameters on [-1, 1] of their bounds.
MatrixXd makeTargets(const NetworkMap& map, const MatrixXd& points) {
  return map.half_width.cwiseInverse().asDiagonal() *
         (points.topRows(map.center.size()).colwise() - map.center);
}

void setBounds(const ModelSpec& model, NetworkMap& map) {
  map.center = calcBoxCenter(model.parameters);
  map.half_width = 0.5 * calcWidths(model.parameters);
  map.inputs.known = makeKnownInputs(model.inputs);
}

/// A matrix F with F F' = covariance, which may be singular.
MatrixXd calcFactor(const MatrixXd& covariance) {
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(covariance);
  return eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

/// What networks say of samples that they had not seen.
struct HeldOutTargets {
  Estimates predictions;
  MatrixXd truth;
  int draws = 1;
};

HeldOutTargets predictHeldOut(const NetworkSet& set, const std::vector<network::Member>& members,
                              const std::vector<Index>& chosen, Index draws, std::uint64_t seed,
                              int threads) {
  return {predictTargets(members, drawMeasured(set.samples, chosen, draws, seed), threads),
          MatrixXd(set.targets(Eigen::all, chosen)).replicate(1, draws), static_cast<int>(draws)};
}

/// Sets columns of `all`.
void place(const Estimates& some, const std::vector<Index>& columns, Estimates& all) {
  all.mean(Eigen::all, columns) = some.mean;
  all.stddev(Eigen::all, columns) = some.stddev;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto column = static_cast<std::size_t>(columns[i]);
    all.correlations[column] = some.correlations[i];
    if (!some.mixtures.empty()) {
      all.mixtures[column] = some.mixtures[i];
    }
  }
}

/// Parts of the samples, each left out in turn: none of many; else ten, as a few more of them tell much.
/// Kinds of network that are several already have five, for the time.
Index countFolds(const NetworkMapSpec& spec, Index samples) {
  if (samples >= NetworkMapSpec::kMany) {
    return 0;
  }
  return spec.bayesian == NetworkBayes::kNone ? 10 : 5;
}

/// Networks that a part of the samples is left out of in turn, and what they say of it.
HeldOutTargets crossValidate(const NetworkSet& set, const NetworkTask& task, const TrainingControl& control) {
  const Index n = set.targets.cols(), p = set.targets.rows(), draws = countDraws(n, kColumnsOfFew);
  const MatrixXd measured = drawMeasured(set.samples, listIndices(n), draws, task.seed);
  const auto columns_in_all = static_cast<std::size_t>(n * draws);
  HeldOutTargets held_out{
      {MatrixXd(p, n * draws), MatrixXd(p, n * draws), std::vector<MatrixXd>(columns_in_all),
       std::vector<Mixture>(task.spec.countComponents() > 1 ? columns_in_all : 0)},
      set.targets.replicate(1, draws),
      static_cast<int>(draws)};
  const Index folds = countFolds(task.spec, n);
  runTasks(control.threads, static_cast<std::size_t>(folds), [&](std::size_t fold) {
    const Split parts = split(listKept(n, folds, static_cast<Index>(fold)), n);
    const NetworkFit fit = fitNetwork(set, parts, {task.spec, task.seed, fold + 1}, {1, control.stop});
    std::vector<Index> columns;
    for (Index draw = 0; draw < draws; ++draw) {
      for (const Index i : listLeftOut(n, folds, static_cast<Index>(fold))) {
        columns.push_back(i + draw * n);
      }
    }
    const Estimates found = predictTargets(fit.members, measured(Eigen::all, columns), 1);
    place(found, columns, held_out.predictions);
  });
  return held_out;
}

/// Held-out samples in the parameters' units, and what follows from them: factors of standard deviations, how
/// wide intervals are, and whether estimates have the shape of the network's.
void validateMap(const HeldOutTargets& targets, const NetworkTask& task, NetworkMapTraining& training) {
  NetworkMap& map = training.map;
  HeldOut found;
  found.truth = (map.half_width.asDiagonal() * targets.truth).colwise() + map.center;
  found.predictions = map.convertTargets(targets.predictions, VectorXd::Ones(map.center.size()));
  found.limit_stddev =
      MatrixXd::Constant(found.truth.rows(), found.truth.cols(), std::numeric_limits<double>::quiet_NaN());
  map.validation = validate(found);
  training.held_out = map.convertTargets(targets.predictions, map.validation.stddev_scale);
  map.validation.interval_factors = calcIntervalFactors(training.held_out, found.truth, targets.draws);
  training.held_out.interval_factors = replicate(map.validation.interval_factors, found.truth.cols());
  training.held_out_truth = std::move(found.truth);
  training.held_out_draws = targets.draws;
  warnOfShape(task.model.parameters, training);
}

/// The factors (p) with which a student's intervals hold what they say of its teacher's simulations, where
/// the teacher is as wrong as it was about those left out.
VectorXd calcDistillationScale(const SurrogatePool& pool, const NetworkTask& task, const NetworkMap& map,
                               int threads) {
  const Index n = pool.left_out_points.cols();
  const Index draws = (kColumnsOfMany + n - 1) / n;  // noise is free, so that it leaves no doubt
  const NormalSamples samples(pool.left_out);
  const MatrixXd targets = makeTargets(map, pool.left_out_points);
  const HeldOutTargets found =
      predictHeldOut({samples, targets}, map.members, listIndices(n), draws, task.seed, threads);
  VectorXd scale(targets.rows());
  for (Index k = 0; k < scale.size(); ++k) {
    scale[k] = calcStddevScale(calcDepths(found.predictions, found.truth, k));
  }
  return scale;
}

/// Makes standard deviations up for what the teacher's lack. Both factors make up for the same posteriors
/// that are not normal, so that their product would do so twice. It was up to 4 % too wide, and 50 %
/// intervals held 58 %.
void inflateForTeacher(const VectorXd& student_scale, const HeldOutTargets& targets,
                       NetworkMapTraining& training) {
  const NetworkMap& map = training.map;
  VectorXd& scale = training.map.validation.stddev_scale;
  scale = scale.cwiseMax(student_scale);
  IntervalFactors factors = std::move(training.held_out.interval_factors);
  training.held_out = map.convertTargets(targets.predictions, scale);
  training.held_out.interval_factors = std::move(factors);
}

/// Takes what a fit gives into the map.
void setMembers(NetworkFit fit, NetworkMapTraining& training) {
  warnOfRestarts(fit.restarts, training.warnings);
  if (fit.chains) {
    warnOfChains(*fit.chains, training.warnings);
  }
  training.chains = std::move(fit.chains);
  training.map.members = std::move(fit.members);
}

/// Features with one draw of their noise, and where they were simulated; without those that lack a feature.
struct DrawnFeatures {
  MatrixXd features;  ///< d x n
  MatrixXd points;    ///< m x n
};

DrawnFeatures drawFeatures(const NetworkSimulations& simulations, std::uint64_t seed) {
  constexpr Index kMax = 4000;  // for means, covariances and polynomials
  const Index count = std::min(simulations.responses.cols(), kMax);
  const MatrixXd features = simulations.extractor.extract(
      simulations.noise.add(simulations.responses.leftCols(count), {seed, RandomPurpose::kNetworkNoise}, 0));
  std::vector<Index> complete;
  for (Index i = 0; i < count; ++i) {
    if (features.col(i).allFinite()) {
      complete.push_back(i);
    }
  }
  return {features(Eigen::all, complete), simulations.points(Eigen::all, complete)};
}

/// Canonical inputs, each scaled by the root of its correlation: those which the parameters do not explain
/// smoothly weigh less at first. On a chaotic pendulum with 100000 simulations errors were 3.0 times the
/// limit, with principal components instead 4.9, unscaled 3.1, scaled by the correlation itself 3.3.
NetworkInputs fitInputs(const NetworkSimulations& simulations, const DrawnFeatures& drawn,
                        const KnownInputs& known) {
  constexpr double kMinCorrelation = 0.01;
  const VectorXd center = drawn.features.rowwise().mean();
  const MatrixXd matrix = simulations.transform.calcMatrix();
  const CanonicalInputs canonical =
      calcCanonicalInputs(matrix * (drawn.features.colwise() - center), drawn.points);
  const VectorXd scale = canonical.correlations.cwiseMax(kMinCorrelation).cwiseSqrt();
  return {center, linalg::roundToHalves(scale.asDiagonal() * canonical.projection * matrix), known};
}

std::unique_ptr<NoisySamples> makeSamples(const NetworkSimulations& simulations, const MatrixXd& known,
                                          const NetworkInputs& inputs) {
  if (!simulations.constant_noise) {
    return std::make_unique<ResponseSamples>(simulations.responses, known, simulations.extractor,
                                             simulations.noise, inputs);
  }
  return std::make_unique<NormalSamples>(NormalInputs{
      inputs.apply(simulations.extractor.extract(simulations.responses), known),
      calcFactor(inputs.projection * (simulations.noise_covariance * inputs.projection.transpose())),
      {},
      {},
      {}});
}

}  // namespace

int countTrainings(const NetworkMapSpec& spec, int simulations) {
  return 1 + static_cast<int>(countFolds(spec, simulations));
}

NetworkMapTraining trainNetworkMap(const NetworkTask& task, const NetworkSimulations& simulations,
                                   const TrainingControl& control) {
  constexpr Index kMin = 50;
  const Index n = simulations.points.cols();
  if (n < kMin) {
    throw std::invalid_argument("a network needs at least 50 training samples");
  }
  NetworkMapTraining training;
  NetworkMap& map = training.map;
  setBounds(task.model, map);
  map.inputs = fitInputs(simulations, drawFeatures(simulations, task.seed), map.inputs.known);
  const MatrixXd known = simulations.points.bottomRows(map.inputs.known.center.size());
  const std::unique_ptr<NoisySamples> samples = makeSamples(simulations, known, map.inputs);
  const MatrixXd targets = makeTargets(map, simulations.points);
  const NetworkSet set{*samples, targets};
  const Split parts = split(listIndices(n), n);
  setMembers(fitNetwork(set, parts, {task.spec, task.seed, 0}, control), training);
  const auto left = static_cast<Index>(parts.held_out.size());
  const HeldOutTargets held_out =
      countFolds(task.spec, n) > 0
          ? crossValidate(set, task, control)
          : predictHeldOut(set, map.members, parts.held_out, countDraws(left, kColumnsOfMany), task.seed,
                           control.threads);
  validateMap(held_out, task, training);
  return training;
}

NetworkMapTraining trainNetworkMap(const NetworkTask& task, const SurrogatePool& pool,
                                   const TrainingControl& control) {
  NetworkMapTraining training;
  NetworkMap& map = training.map;
  setBounds(task.model, map);
  map.inputs.center = pool.center;
  map.inputs.projection = pool.projection;
  const MatrixXd targets = makeTargets(map, pool.points);
  const NormalSamples samples(pool.inputs);
  const NetworkSet set{samples, targets};
  const Split parts = split(listIndices(targets.cols()), targets.cols());
  setMembers(fitNetwork(set, parts, {task.spec, task.seed, 0}, control), training);
  const Index draws = countDraws(static_cast<Index>(parts.held_out.size()), kColumnsOfMany);
  const HeldOutTargets held_out =
      predictHeldOut(set, map.members, parts.held_out, draws, task.seed, control.threads);
  validateMap(held_out, task, training);
  inflateForTeacher(calcDistillationScale(pool, task, map, control.threads), held_out, training);
  return training;
}

}  // namespace twinmap
