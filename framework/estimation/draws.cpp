#include "framework/estimation/draws.hpp"

#include "kernels/linalg/decompositions.hpp"
#include "kernels/sampling/weighted_draws.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd drawNormal(const VectorXd& mean, const VectorXd& stddev, const MatrixXd& correlation, int draws,
                    const RandomStream& random) {
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(correlation);
  const VectorXd scale = eigen.values.cwiseMax(0.0).cwiseSqrt();
  const MatrixXd factor = stddev.asDiagonal() * eigen.vectors * scale.asDiagonal();
  const MatrixXd normal = MatrixXd::NullaryExpr(mean.size(), draws, [&](Index p, Index j) {
    return random.calcNormal(static_cast<std::uint64_t>(j), static_cast<std::uint64_t>(p));
  });
  return (factor * normal).colwise() + mean;
}

MatrixXd drawFrom(const Mixture& mixture, int draws, const RandomStream& random) {
  const Index p = mixture.means.rows();
  std::vector<MatrixXd> of_components;
  for (Index c = 0; c < mixture.countComponents(); ++c) {
    of_components.push_back(drawNormal(mixture.means.col(c), mixture.stddevs.col(c),
                                       mixture.correlations[static_cast<std::size_t>(c)], draws, random));
  }
  MatrixXd drawn(p, draws);
  for (Index draw = 0; draw < draws; ++draw) {
    double rest = random.calcUniform(static_cast<std::uint64_t>(draw), static_cast<std::uint64_t>(p));
    Index chosen = 0;
    while (chosen + 1 < mixture.countComponents() && rest >= mixture.weights[chosen]) {
      rest -= mixture.weights[chosen++];
    }
    drawn.col(draw) = of_components[static_cast<std::size_t>(chosen)].col(draw);
  }
  return drawn;
}

MatrixXd drawFrom(const Estimate& estimate, int draws, const RandomStream& random) {
  if (estimate.draws.isGiven()) {
    const VectorXd uniforms = VectorXd::NullaryExpr(
        draws, [&](Index i) { return random.calcUniform(static_cast<std::uint64_t>(i), 0); });
    return importance::resample({estimate.draws.points, estimate.draws.weights}, uniforms)
        .topRows(estimate.mean.size());
  }
  return estimate.mixture.isGiven()
             ? drawFrom(estimate.mixture, draws, random)
             : drawNormal(estimate.mean, estimate.stddev, estimate.correlation, draws, random);
}

}  // namespace twinmap
