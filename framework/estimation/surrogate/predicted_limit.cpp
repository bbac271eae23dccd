#include "framework/estimation/surrogate/predicted_limit.hpp"

#include "framework/estimation/levels.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// J'J of the scores at a point, J = ds / dx with respect to the first u variables.
MatrixXd calcNoiseInformation(const ForwardSurrogate& surrogate, const VectorXd& point, Index unknown) {
  MatrixXd jacobian(surrogate.getScoreCount(), unknown);
  gp::SharedProcess::Workspace workspace;
  Index first = 0;
  for (const gp::SharedProcess& process : surrogate.windows) {
    const Index count = process.getFunctionCount();
    VectorXd values(count);
    process.linearize(point, values, jacobian.middleRows(first, count), workspace);
    first += count;
  }
  return jacobian.transpose() * jacobian;
}

}  // namespace

VectorXd calcScoreLimit(const MatrixXd& information, const BoxPrior& prior) {
  return linalg::invertPositiveDefinite(information + prior.calcInformation()).diagonal().cwiseSqrt();
}

VectorXd calcLimitScale(const ForwardSurrogate& surrogate, const ForwardSamples& samples,
                        const BoxPrior& prior) {
  const NoiseWhitener noise(samples.noise_covariance);
  const Index unknown = prior.count();
  VectorXd of_simulator = VectorXd::Zero(unknown), of_scores = VectorXd::Zero(unknown);
  int count = 0;
  for (std::size_t i = 0; i < samples.slopes.size() && count < kStandingDraws; ++i) {
    if (samples.slopes[i].size() > 0) {
      const MatrixXd slopes = noise.apply(samples.slopes[i]);
      const VectorXd point = samples.points.col(static_cast<Index>(i));
      of_simulator += calcScoreLimit(slopes.transpose() * slopes, prior).cwiseAbs2();
      of_scores += calcScoreLimit(calcNoiseInformation(surrogate, point, unknown), prior).cwiseAbs2();
      ++count;
    }
  }
  return count > 0 ? VectorXd(of_simulator.cwiseQuotient(of_scores).cwiseSqrt()) : VectorXd::Ones(unknown);
}

}  // namespace twinmap
