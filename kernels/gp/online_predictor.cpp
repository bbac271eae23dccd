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

bool shareInputs(const GaussianProcess& one, const GaussianProcess& other) {
  return one.getParts().inputs == other.getParts().inputs ||
         (one.getSampleCount() == other.getSampleCount() && one.getInputs() == other.getInputs());
}

void check(const std::vector<const GaussianProcess*>& processes) {
  if (processes.empty()) throw std::invalid_argument("OnlinePredictor: there are no processes");
  for (const GaussianProcess* process : processes) {
    if (process == nullptr) {
      throw std::invalid_argument("OnlinePredictor: a process is null; its training failed");
    }
    if (process->getFeatureCount() != processes.front()->getFeatureCount()) {
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
  feature_count_ = processes.front()->getFeatureCount();
  const auto total = static_cast<Index>(processes.size());
  for (Index first = 0; first < total;) {
    Index count = 1;
    while (count < kBatch && first + count < total &&
           shareInputs(*processes[first], *processes[first + count])) {
      ++count;
    }
    batches_.push_back(makeBatch(processes, first, count));
    first += count;
  }
  for (const GaussianProcess* process : processes) targets_.push_back(makeTarget(*process));
}

OnlinePredictor::Batch OnlinePredictor::makeBatch(const std::vector<const GaussianProcess*>& processes,
                                                  Index first, Index count) {
  const GaussianProcess& process = *processes[first];
  Batch batch;
  batch.first = first;
  batch.count = count;
  batch.center = process.getCenter();
  batch.samples = linalg::PackedSamples(process.getInputs().colwise() - batch.center);
  batch.weights = MatrixXd::Zero(count == 1 ? 1 : kBatch, process.getFeatureCount());
  for (Index t = 0; t < count; ++t) {
    batch.weights.row(t) = processes[first + t]->getInverseLengthScales().cwiseAbs2().transpose();
  }
  return batch;
}

OnlinePredictor::Target OnlinePredictor::makeTarget(const GaussianProcess& process) {
  Target target;
  target.structure = process.getStructure();
  target.hyperparameters = process.getHyperparameters();
  target.factor = linalg::PackedLower(linalg::viewOf(process.getFactor()));
  target.sample_count = process.getSampleCount();
  const Index padding = target.factor.paddedSize();
  target.alpha = VectorXd::Zero(padding);
  target.alpha.head(target.sample_count) = process.getAlpha();
  target.whitened_basis = MatrixXd::Zero(padding, process.getWhitenedBasis().cols());
  target.whitened_basis.topRows(target.sample_count) = process.getWhitenedBasis();
  target.basis_factor = process.getBasisFactor();
  target.mean_coefficients = process.getMeanCoefficients();
  return target;
}

OnlinePredictor::Workspace::Workspace(const OnlinePredictor& predictor) {
  Index largest = 0;
  Index coefficients = 0;
  for (const Target& target : predictor.targets_) {
    largest = std::max(largest, target.factor.paddedSize());
    coefficients = std::max(coefficients, target.mean_coefficients.size());
  }
  point.setZero(predictor.getFeatureCount());
  linear.setZero(predictor.getFeatureCount());
  distances.setZero(largest, kBatch);
  covariance.setZero(largest);
  weight.setZero(largest);
  error.setZero(coefficients);
}

void OnlinePredictor::predict(const Eigen::Ref<const VectorXd>& x, Eigen::Ref<VectorXd> mean,
                              Eigen::Ref<VectorXd> stddev, Workspace& workspace) const {
  assert(x.size() == getFeatureCount() && mean.size() == getTargetCount() &&
         stddev.size() == getTargetCount());
  const linalg::FlushDenormals flush;
  for (const Batch& batch : batches_) {
    workspace.point = x - batch.center;
    if (batch.count == 1) {
      batch.samples.weightedDistances<1>(workspace.point.data(), batch.weights.data(),
                                         workspace.distances.data());
    } else {
      batch.samples.weightedDistances<kBatch>(workspace.point.data(), batch.weights.data(),
                                              workspace.distances.data());
    }
    for (Index t = batch.first; t < batch.first + batch.count; ++t) {
      predictTarget(t, batch, mean(t), stddev(t), workspace);
    }
  }
}

void OnlinePredictor::predictTarget(Index index, const Batch& batch, double& mean, double& stddev,
                                    Workspace& workspace) const {
  const Target& target = targets_[index];
  const Hyperparameters& h = target.hyperparameters;
  const Index size = target.factor.paddedSize();
  AlignedColumn covariance(workspace.covariance.data(), size);
  const ConstAlignedColumn distances(workspace.distances.data() + (index - batch.first) * size, size);
  evaluateRadial(target.structure.covariance, h.shape, distances, covariance,
                 AlignedColumn(workspace.weight.data(), size));
  double variance = h.signal_stddev * h.signal_stddev;
  covariance *= variance;
  if (target.structure.linear_term) {
    workspace.linear = h.linear_stddev * h.linear_stddev * workspace.point;
    batch.samples.addProduct(workspace.linear.data(), covariance.data());
    variance += workspace.linear.dot(workspace.point);
  }
  covariance.tail(size - target.sample_count).setZero();
  mean = covariance.matrix().dot(target.alpha);
  target.factor.solve(covariance.data());
  variance = applyMean(target, variance - covariance.matrix().squaredNorm(), mean, workspace);
  stddev = std::sqrt(std::max(variance, 0.0) + h.noise_stddev * h.noise_stddev);
}

// Adds h(x)'b to the mean and e'A^-1 e to the variance.
double OnlinePredictor::applyMean(const Target& target, double variance, double& mean, Workspace& workspace) {
  const Index count = target.mean_coefficients.size();
  if (count == 0) return variance;
  const auto whitened = workspace.covariance.head(target.factor.paddedSize());
  for (Index k = 0; k < count; ++k) {
    const double basis = k == 0 ? 1.0 : workspace.point(k - 1);
    mean += basis * target.mean_coefficients(k);
    workspace.error(k) = basis - target.whitened_basis.col(k).dot(whitened);
  }
  linalg::solveLower(linalg::viewOf(target.basis_factor), workspace.error.data());
  return variance + workspace.error.head(count).squaredNorm();
}

}  // namespace twinmap::gp
