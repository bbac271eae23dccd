#include "kernels/gp/online_predictor.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <stdexcept>

#include "kernels/covariance/radial.hpp"
#include "kernels/linalg/flush_denormals.hpp"
#include "kernels/linalg/triangular.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

bool share_inputs(const GaussianProcess& one, const GaussianProcess& other) {
  return one.parts().inputs == other.parts().inputs ||
         (one.sample_count() == other.sample_count() && one.inputs() == other.inputs());
}

void check(const std::vector<const GaussianProcess*>& processes) {
  if (processes.empty()) throw std::invalid_argument("OnlinePredictor: there are no processes");
  for (const GaussianProcess* process : processes) {
    if (process == nullptr) {
      throw std::invalid_argument("OnlinePredictor: a process is null; its training failed");
    }
    if (process->feature_count() != processes.front()->feature_count()) {
      throw std::invalid_argument("OnlinePredictor: the processes differ in their number of features");
    }
  }
}

}  // namespace

OnlinePredictor::OnlinePredictor(const std::vector<std::shared_ptr<const GaussianProcess>>& processes) {
  std::vector<const GaussianProcess*> pointers;
  for (const auto& process : processes) pointers.push_back(process.get());
  build(pointers);
}

OnlinePredictor::OnlinePredictor(const std::vector<GaussianProcess>& processes) {
  std::vector<const GaussianProcess*> pointers;
  for (const auto& process : processes) pointers.push_back(&process);
  build(pointers);
}

void OnlinePredictor::build(const std::vector<const GaussianProcess*>& processes) {
  check(processes);
  feature_count_ = processes.front()->feature_count();
  const auto total = static_cast<Index>(processes.size());
  for (Index first = 0; first < total;) {
    Index count = 1;
    while (count < kBatch && first + count < total &&
           share_inputs(*processes[first], *processes[first + count])) {
      ++count;
    }
    batches_.push_back(make_batch(processes, first, count));
    first += count;
  }
  for (const GaussianProcess* process : processes) targets_.push_back(make_target(*process));
}

OnlinePredictor::Batch OnlinePredictor::make_batch(const std::vector<const GaussianProcess*>& processes,
                                                   Index first, Index count) {
  const GaussianProcess& process = *processes[first];
  Batch batch;
  batch.first = first;
  batch.count = count;
  batch.center = process.center();
  batch.samples = linalg::PackedSamples(process.inputs().colwise() - batch.center);
  batch.weights = MatrixXd::Zero(count == 1 ? 1 : kBatch, process.feature_count());
  for (Index t = 0; t < count; ++t) {
    batch.weights.row(t) = processes[first + t]->inverse_length_scales().cwiseAbs2().transpose();
  }
  return batch;
}

OnlinePredictor::Target OnlinePredictor::make_target(const GaussianProcess& process) {
  Target target;
  target.structure = process.structure();
  target.hyperparameters = process.hyperparameters();
  target.factor = linalg::PackedLower(linalg::view_of(process.factor()));
  target.sample_count = process.sample_count();
  const Index padding = target.factor.padded_size();
  target.alpha = VectorXd::Zero(padding);
  target.alpha.head(target.sample_count) = process.alpha();
  target.whitened_basis = MatrixXd::Zero(padding, process.whitened_basis().cols());
  target.whitened_basis.topRows(target.sample_count) = process.whitened_basis();
  target.basis_factor = process.basis_factor();
  target.mean_coefficients = process.mean_coefficients();
  return target;
}

OnlinePredictor::Workspace::Workspace(const OnlinePredictor& predictor) {
  Index largest = 0;
  Index coefficients = 0;
  for (const Target& target : predictor.targets_) {
    largest = std::max(largest, target.factor.padded_size());
    coefficients = std::max(coefficients, target.mean_coefficients.size());
  }
  point.setZero(predictor.feature_count());
  linear.setZero(predictor.feature_count());
  distances.setZero(largest, kBatch);
  covariance.setZero(largest);
  weight.setZero(largest);
  error.setZero(coefficients);
}

void OnlinePredictor::predict(const Eigen::Ref<const VectorXd>& x, Eigen::Ref<VectorXd> mean,
                              Eigen::Ref<VectorXd> stddev, Workspace& workspace) const {
  assert(x.size() == feature_count() && mean.size() == target_count() && stddev.size() == target_count());
  const linalg::FlushDenormals flush;
  for (const Batch& batch : batches_) {
    workspace.point = x - batch.center;
    if (batch.count == 1) {
      batch.samples.weighted_distances<1>(workspace.point.data(), batch.weights.data(),
                                          workspace.distances.data());
    } else {
      batch.samples.weighted_distances<kBatch>(workspace.point.data(), batch.weights.data(),
                                               workspace.distances.data());
    }
    for (Index t = batch.first; t < batch.first + batch.count; ++t) {
      predict_target(t, batch, mean(t), stddev(t), workspace);
    }
  }
}

void OnlinePredictor::predict_target(Index index, const Batch& batch, double& mean, double& stddev,
                                     Workspace& workspace) const {
  const Target& target = targets_[index];
  const Hyperparameters& h = target.hyperparameters;
  const Index size = target.factor.padded_size();
  AlignedColumn covariance(workspace.covariance.data(), size);
  const ConstAlignedColumn distances(workspace.distances.data() + (index - batch.first) * size, size);
  evaluate_radial(target.structure.covariance, h.shape, distances, covariance,
                  AlignedColumn(workspace.weight.data(), size));
  double variance = h.signal_stddev * h.signal_stddev;
  covariance *= variance;
  if (target.structure.linear_term) {
    workspace.linear = h.linear_stddev * h.linear_stddev * workspace.point;
    batch.samples.add_product(workspace.linear.data(), covariance.data());
    variance += workspace.linear.dot(workspace.point);
  }
  covariance.tail(size - target.sample_count).setZero();
  mean = covariance.matrix().dot(target.alpha);
  target.factor.solve(covariance.data());
  variance = apply_mean(target, variance - covariance.matrix().squaredNorm(), mean, workspace);
  stddev = std::sqrt(std::max(variance, 0.0) + h.noise_stddev * h.noise_stddev);
}

// Adds h(x)'b to the mean and e'A^-1 e to the variance.
double OnlinePredictor::apply_mean(const Target& target, double variance, double& mean,
                                   Workspace& workspace) {
  const Index count = target.mean_coefficients.size();
  if (count == 0) return variance;
  const auto whitened = workspace.covariance.head(target.factor.padded_size());
  for (Index k = 0; k < count; ++k) {
    const double basis = k == 0 ? 1.0 : workspace.point(k - 1);
    mean += basis * target.mean_coefficients(k);
    workspace.error(k) = basis - target.whitened_basis.col(k).dot(whitened);
  }
  linalg::solve_lower(linalg::view_of(target.basis_factor), workspace.error.data());
  return variance + workspace.error.head(count).squaredNorm();
}

}  // namespace twinmap::gp
