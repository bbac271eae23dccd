#include "framework/estimation/network/surrogate_pool.hpp"

#include "framework/data/features/labelled_features.hpp"
#include "framework/data/reduction/affine_step.hpp"
#include "framework/data/reduction/principal_components.hpp"
#include "framework/experiment/points/experiment_points.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "kernels/linalg/order.hpp"
#include "kernels/linalg/paired_matrix.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Scores at points, with the standard deviations of the surrogate's error.
struct PooledScores {
  MatrixXd mean, stddev;  // r x n
};

/// Draws of the prior, normalised.
MatrixXd drawPoints(const Surrogate& surrogate, const ModelSpec& model, Index n, std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::kNetworkPool);
  const MatrixXd unit = MatrixXd::NullaryExpr(surrogate.center.size(), n, [&](Index i, Index j) {
    return random.calcUniform(static_cast<std::uint64_t>(j), static_cast<std::uint64_t>(i));
  });
  if (surrogate.prior.isUniform()) {
    return 2.0 * unit.array() - 1.0;
  }
  return surrogate.half_width.cwiseInverse().asDiagonal() *
         (placeInPrior(model, unit, seed, RandomPurpose::kPriorPool).colwise() - surrogate.center);
}

PooledScores calcScores(const ForwardSurrogate& forward, const MatrixXd& points,
                        const TrainingControl& control) {
  const Index r = forward.getScoreCount(), n = points.cols();
  PooledScores scores{MatrixXd(r, n), MatrixXd(r, n)};
  runChunks(control.threads, n, [&](Index begin, Index end) {
    gp::throwIfStopped(control.stop);
    gp::SharedProcess::Workspace workspace;
    for (Index i = begin; i < end; ++i) {
      Index first = 0;
      for (const gp::SharedProcess& process : forward.windows) {
        const Index count = process.getFunctionCount();
        process.evaluate(points.col(i), scores.mean.col(i).segment(first, count), workspace);
        process.calcStddev(scores.stddev.col(i).segment(first, count), workspace);
        first += count;
      }
    }
  });
  return scores;
}

/// One draw of error and noise, to see how much the scores of measurements vary.
MatrixXd drawScores(const PooledScores& scores, const MatrixXd& error_factor, std::uint64_t seed) {
  const Index r = scores.mean.rows();
  const MatrixXd identity = MatrixXd::Identity(r, r);
  const NormalSamples once({scores.mean, identity, identity, scores.stddev, error_factor});
  MatrixXd drawn(r, scores.mean.cols());
  once.draw(listIndices(drawn.cols()), {seed, RandomPurpose::kNetworkPool}, {}, drawn);
  return drawn;
}

/// Scores (r x n) of the simulations, changed by the error that the processes make where each is left out.
MatrixXd calcLeftOutScores(const ForwardSurrogate& forward) {
  MatrixXd scores = forward.scores;
  Index first = 0;
  for (const gp::SharedProcess& process : forward.windows) {
    scores.middleRows(first, process.getFunctionCount()) += process.getLeftOut().residual.transpose();
    first += process.getFunctionCount();
  }
  return scores;
}

}  // namespace

SurrogatePool makeSurrogatePool(const Surrogate& surrogate, const ModelSpec& model, Index n,
                                std::uint64_t seed, const TrainingControl& control) {
  const ForwardSurrogate& forward = *surrogate.forward;
  const MatrixXd normalised = drawPoints(surrogate, model, n, seed);
  PooledScores scores = calcScores(forward, normalised, control);
  const MatrixXd error_factor = linalg::calcCholesky(forward.error_correlation).lower;
  const MatrixXd drawn = drawScores(scores, error_factor, seed);
  const MatrixXd components = fitPrincipalComponents({}, drawn).projection;
  const VectorXd scale = fitZScore(components * drawn).scale;
  const Index known = surrogate.center.size() - surrogate.unknown;
  SurrogatePool pool;
  const auto convert = [&](const MatrixXd& points) -> MatrixXd {
    return (surrogate.half_width.asDiagonal() * points).colwise() + surrogate.center;
  };
  pool.points = convert(normalised);
  const MatrixXd projection = scale.cwiseInverse().asDiagonal() * components;
  pool.center = forward.center;
  pool.projection = linalg::roundToHalves(projection * forward.projection);
  const MatrixXd noise_factor = linalg::calcCholesky(projection * projection.transpose()).lower;
  pool.inputs = {stackRows(projection * scores.mean, normalised.bottomRows(known)), noise_factor, projection,
                 std::move(scores.stddev), error_factor};
  pool.left_out_points = convert(forward.points);
  pool.left_out = {stackRows(projection * calcLeftOutScores(forward), forward.points.bottomRows(known)),
                   noise_factor,
                   {},
                   {},
                   {}};
  return pool;
}

}  // namespace twinmap
