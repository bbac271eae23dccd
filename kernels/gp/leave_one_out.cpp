#include "kernels/gp/leave_one_out.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "kernels/linalg/decompositions.hpp"
#include "kernels/linalg/triangular.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kNormalQuantile975 = 1.959963984540054;  // 95 % lie within it on both sides

// Square roots of both parts of P = M'M - U U': M = L^-1, and U = L^-T V R^-T.
struct PrecisionParts {
  MatrixXd inverse_factor;
  MatrixXd correction;
};

PrecisionParts calcPrecisionParts(const GaussianProcess& process, int threads) {
  linalg::TriangularScratch scratch(process.getSampleCount(), threads);
  PrecisionParts parts{process.getFactor(), process.getWhitenedBasis()};
  linalg::invertLower(linalg::viewOf(parts.inverse_factor), scratch);
  if (parts.correction.cols() == 0) {
    return parts;
  }
  linalg::solveTransposedFromRight(linalg::viewOf(process.getBasisFactor()), linalg::viewOf(parts.correction),
                                   scratch);
  for (Index k = 0; k < parts.correction.cols(); ++k) {
    linalg::solveLowerTransposed(linalg::viewOf(process.getFactor()), parts.correction.col(k).data());
  }
  return parts;
}

MatrixXd calcPrecisionBlock(const PrecisionParts& parts, const std::vector<Index>& group) {
  const auto size = static_cast<Index>(group.size());
  MatrixXd block(size, size);
  for (Index i = 0; i < size; ++i) {
    for (Index j = 0; j <= i; ++j) {
      block(i, j) = parts.inverse_factor.col(group[i]).dot(parts.inverse_factor.col(group[j])) -
                    parts.correction.row(group[i]).dot(parts.correction.row(group[j]));
      block(j, i) = block(i, j);
    }
  }
  return block;
}

}  // namespace

// A group that alone determines a coefficient of the mean has a singular precision: its stddev is huge then,
// not NaN. Noise far below the signal drowns in the rounding of the precision, and a variance below that of
// the noise would leave a negative one for the function without it.
GroupPrediction predictGroup(const MatrixXd& precision, const VectorXd& alpha, double noise_variance) {
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(precision);
  const VectorXd values = eigen.values.cwiseMax(std::numeric_limits<double>::min());
  const MatrixXd& vectors = eigen.vectors;
  return {vectors * (vectors.transpose() * alpha).cwiseQuotient(values),
          (vectors.cwiseAbs2() * values.cwiseInverse()).cwiseMax(noise_variance)};
}

LeaveOneOut summarizeLeaveOneOut(const VectorXd& residual, const VectorXd& stddev) {
  LeaveOneOut result;
  result.residual = residual;
  result.stddev = stddev;
  const Eigen::ArrayXd standardised = residual.array() / stddev.array();
  result.log_density = -0.5 * (standardised.square() + 2.0 * stddev.array().log() + kLogTwoPi);
  result.total_log_density = result.log_density.sum();
  result.coverage95 = (standardised.abs() <= kNormalQuantile975).cast<double>().mean();
  result.root_mean_square = std::sqrt(residual.squaredNorm() / double(residual.size()));
  return result;
}

void checkGroups(const SampleGroups& groups, Index samples) {
  std::vector<int> uses(samples, 0);
  for (const std::vector<Index>& group : groups) {
    for (const Index i : group) {
      if (i < 0 || i >= samples || ++uses[i] > 1) {
        throw std::invalid_argument("calcLeaveGroupsOut: sample " + std::to_string(i) +
                                    " is in two groups or does not exist");
      }
    }
  }
  if (std::accumulate(uses.begin(), uses.end(), Index(0)) != samples) {
    throw std::invalid_argument("calcLeaveGroupsOut: a sample is in no group");
  }
}

SampleGroups makeDrawGroups(Index samples, int draws) {
  if (draws < 1 || samples % draws != 0) {
    throw std::invalid_argument("makeDrawGroups: " + std::to_string(samples) + " samples are not " +
                                std::to_string(draws) + " draws of each");
  }
  const Index count = samples / draws;
  SampleGroups groups(count);
  for (Index i = 0; i < samples; ++i) {
    groups[i % count].push_back(i);
  }
  return groups;
}

LeaveOneOut calcLeaveGroupsOut(const GaussianProcess& process, const SampleGroups& groups, int threads) {
  const Index n = process.getSampleCount();
  checkGroups(groups, n);
  const PrecisionParts parts = calcPrecisionParts(process, threads);
  const double noise_stddev = process.getHyperparameters().noise_stddev;
  VectorXd residual(n), stddev(n);
  for (const std::vector<Index>& group : groups) {
    const GroupPrediction left_out = predictGroup(calcPrecisionBlock(parts, group), process.getAlpha()(group),
                                                  noise_stddev * noise_stddev);
    residual(group) = left_out.residual;
    stddev(group) = left_out.variance.cwiseSqrt();
  }
  return summarizeLeaveOneOut(residual, stddev);
}

LeaveOneOut calcLeaveOneOut(const GaussianProcess& process) {
  return calcLeaveGroupsOut(process, makeDrawGroups(process.getSampleCount(), 1));
}

}  // namespace twinmap::gp
