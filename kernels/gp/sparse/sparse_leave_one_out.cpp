#include "kernels/gp/sparse/sparse_leave_one_out.hpp"

#include <stdexcept>

#include "kernels/linalg/flush_denormals.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr std::size_t kProjectionBlock =
    256;  // samples projected together: the factors are read once for all of them

MatrixXd calcPrecision(const SparseProjection& block, Index first, Index count, double noise_variance) {
  const auto corrected = block.corrected.middleRows(first, count);
  MatrixXd precision = MatrixXd::Identity(count, count);
  precision -= corrected * corrected.transpose() / noise_variance;
  if (block.basis_error.cols() > 0) {
    const auto basis = block.basis_error.middleRows(first, count);
    precision -= basis * basis.transpose() / noise_variance;
  }
  return precision / noise_variance;
}

// The samples of groups [first, last), where last is where a block is full.
std::vector<Index> collectBlock(const SampleGroups& groups, std::size_t first, std::size_t& last) {
  std::vector<Index> samples;
  for (last = first; last < groups.size() && (last == first || samples.size() < kProjectionBlock); ++last) {
    samples.insert(samples.end(), groups[last].begin(), groups[last].end());
  }
  return samples;
}

}  // namespace

LeaveOneOut calcLeaveGroupsOut(const SparseGaussianProcess& process, const Eigen::Ref<const MatrixXd>& inputs,
                               const Eigen::Ref<const VectorXd>& target, const SampleGroups& groups) {
  checkGroups(groups, inputs.cols());
  if (target.size() != inputs.cols()) {
    throw std::invalid_argument("calcLeaveGroupsOut: the target needs one value per sample");
  }
  const linalg::FlushDenormals flush;
  const double noise_stddev = process.getHyperparameters().noise_stddev;
  const double noise_variance = noise_stddev * noise_stddev;
  VectorXd residual(target.size()), stddev(target.size());
  std::size_t last = 0;
  for (std::size_t first = 0; first < groups.size(); first = last) {
    const std::vector<Index> samples = collectBlock(groups, first, last);
    const SparseProjection block = process.project(inputs(Eigen::all, samples));
    const VectorXd alpha = (VectorXd(target(samples)) - block.mean) / noise_variance;
    Index row = 0;
    for (std::size_t g = first; g < last; ++g) {
      const auto count = static_cast<Index>(groups[g].size());
      const GroupPrediction left_out = predictGroup(calcPrecision(block, row, count, noise_variance),
                                                    alpha.segment(row, count), noise_variance);
      const VectorXd missed = block.missed_variance.segment(row, count).cwiseMax(0.0);
      residual(groups[g]) = left_out.residual;
      stddev(groups[g]) = (left_out.variance + missed).cwiseSqrt();
      row += count;
    }
  }
  return summarizeLeaveOneOut(residual, stddev);
}

}  // namespace twinmap::gp
