#include "kernels/gp/online/online_predictor.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <stdexcept>
#include <string>

#include "kernels/gp/covariance/radial.hpp"
#include "kernels/linalg/flush_denormals.hpp"
#include "kernels/linalg/triangular.hpp"

namespace twinmap::gp {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

void require(bool condition, const char* message) {
  if (!condition) {
    throw std::invalid_argument(std::string("OnlinePredictor: ") + message);
  }
}

MatrixXd padRows(const MatrixXd& matrix, Index rows) {
  MatrixXd padded = MatrixXd::Zero(rows, matrix.cols());
  padded.topRows(matrix.rows()) = matrix;
  return padded;
}

}  // namespace

OnlinePredictor::OnlinePredictor(const std::vector<Process>& processes) {
  require(!processes.empty(), "there are no processes");
  std::vector<ProcessView> sources;
  for (const Process& process : processes) {
    require(std::visit([](const auto& trained) { return trained != nullptr; }, process),
            "a process is null; its training failed");
    sources.push_back(viewProcess(process));
    require(sources.back().inputs.rows() == sources.front().inputs.rows(),
            "the processes differ in their number of features");
  }
  feature_count_ = sources.front().inputs.rows();
  for (const ProcessView& source : sources) {
    targets_.push_back(makeTarget(source));
  }
  for (Index first = 0; first < getTargetCount(); first += batches_.back().count) {
    batches_.push_back(makeBatch(sources, first));
  }
}

OnlinePredictor::Batch OnlinePredictor::makeBatch(const std::vector<ProcessView>& sources, Index first) {
  const auto total = static_cast<Index>(sources.size());
  const ProcessView& source = sources[first];
  Batch batch;
  batch.first = first;
  batch.count = 1;
  while (batch.count < kBatch && first + batch.count < total &&
         source.sharesInputs(sources[first + batch.count])) {
    ++batch.count;
  }
  batch.center = source.mean.getCenter();
  batch.inputs = linalg::PackedSamples(source.inputs.colwise() - batch.center);
  batch.weights = MatrixXd::Zero(batch.count == 1 ? 1 : kBatch, source.inputs.rows());
  for (Index t = 0; t < batch.count; ++t) {
    batch.weights.row(t) = sources[first + t].mean.getInverseLengthScales().cwiseAbs2().transpose();
  }
  return batch;
}

OnlinePredictor::Target OnlinePredictor::makeTarget(const ProcessView& source) {
  Target target;
  target.structure = source.structure;
  target.hyperparameters = source.hyperparameters;
  target.factor = linalg::PackedLower(linalg::viewOf(source.factor));
  if (source.correction) {
    target.correction.emplace(linalg::viewOf(*source.correction));
  }
  const Index padding = target.factor.paddedSize();
  target.input_count = source.inputs.cols();
  target.weights = padRows(source.weights, padding);
  target.whitened_basis = padRows(source.whitened_basis, padding);
  target.basis_factor = source.basis_factor;
  target.mean_coefficients = source.mean_coefficients;
  target.constant_gradient = source.calcConstantGradient();
  return target;
}

OnlinePredictor::Workspace::Workspace(const OnlinePredictor& predictor) {
  const Index features = predictor.getFeatureCount(), targets = predictor.getTargetCount();
  Index largest = 0;
  Index coefficients = 0;
  for (const Target& target : predictor.targets_) {
    largest = std::max(largest, target.factor.paddedSize());
    coefficients = std::max(coefficients, target.mean_coefficients.size());
  }
  values.mean.setZero(targets);
  values.latent_variance.setZero(targets);
  values.stddev.setZero(targets);
  values.gradient.setZero(features, targets);
  point.setZero(features);
  linear.setZero(features);
  distances.setZero(largest, kBatch);
  covariance.setZero(largest);
  weight.setZero(largest);
  error.setZero(coefficients);
}

void OnlinePredictor::predict(const Eigen::Ref<const VectorXd>& x, Workspace& workspace) const {
  predictAll(x, Extent::kVariance, workspace);
}

void OnlinePredictor::predictMean(const Eigen::Ref<const VectorXd>& x, Workspace& workspace) const {
  predictAll(x, Extent::kMean, workspace);
}

void OnlinePredictor::predictWithGradient(const Eigen::Ref<const VectorXd>& x, Workspace& workspace) const {
  predictAll(x, Extent::kGradient, workspace);
}

void OnlinePredictor::predictAll(const Eigen::Ref<const VectorXd>& x, Extent extent,
                                 Workspace& workspace) const {
  assert(x.size() == getFeatureCount());
  const linalg::FlushDenormals flush;
  for (const Batch& batch : batches_) {
    workspace.point = x - batch.center;
    calcDistances(batch, workspace);
    for (Index t = batch.first; t < batch.first + batch.count; ++t) {
      calcMean(t, batch, workspace);
      if (extent != Extent::kMean) {
        calcVariance(t, workspace);
      }
      if (extent == Extent::kGradient) {
        calcGradient(t, batch, workspace);
      }
    }
  }
}

void OnlinePredictor::calcDistances(const Batch& batch, Workspace& workspace) const {
  const double* point = workspace.point.data();
  if (batch.count == 1) {
    batch.inputs.weightedDistances<1>(point, batch.weights.data(), workspace.distances.data());
  } else {
    batch.inputs.weightedDistances<kBatch>(point, batch.weights.data(), workspace.distances.data());
  }
}

// Leaves k in workspace.covariance and the prior variance in the values.
void OnlinePredictor::calcMean(Index index, const Batch& batch, Workspace& workspace) const {
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
    batch.inputs.addProduct(workspace.linear.data(), covariance.data());
    variance += workspace.linear.dot(workspace.point);
  }
  covariance.tail(size - target.input_count).setZero();
  workspace.values.latent_variance(index) = variance;
  double& mean = workspace.values.mean(index);
  mean = covariance.matrix().dot(target.weights);
  for (Index k = 0; k < target.mean_coefficients.size(); ++k) {
    mean += target.mean_coefficients(k) * (k == 0 ? 1.0 : workspace.point(k - 1));
  }
}

void OnlinePredictor::calcVariance(Index index, Workspace& workspace) const {
  const Target& target = targets_[index];
  auto solution = workspace.covariance.head(target.factor.paddedSize());
  double& variance = workspace.values.latent_variance(index);
  target.factor.solve(solution.data());
  variance -= solution.squaredNorm();
  if (target.correction) {
    target.correction->solve(solution.data());
    variance += solution.squaredNorm();
  }
  variance = std::max(variance + calcMeanFunctionVariance(target, workspace), 0.0);
  const double noise = target.hyperparameters.noise_stddev;
  workspace.values.stddev(index) = std::sqrt(variance + noise * noise);
}

// |R^-1 e|^2; workspace.covariance holds the solution of the factors.
double OnlinePredictor::calcMeanFunctionVariance(const Target& target, Workspace& workspace) {
  const Index count = target.mean_coefficients.size();
  if (count == 0) {
    return 0.0;
  }
  const auto whitened = workspace.covariance.head(target.factor.paddedSize());
  for (Index k = 0; k < count; ++k) {
    const double basis = k == 0 ? 1.0 : workspace.point(k - 1);
    workspace.error(k) = basis - target.whitened_basis.col(k).dot(whitened);
  }
  linalg::solveLower(linalg::viewOf(target.basis_factor), workspace.error.data());
  return workspace.error.head(count).squaredNorm();
}

// With w = -2 dk/dq, of each input: dk/dx = w (z - x) / l^2.
void OnlinePredictor::calcGradient(Index index, const Batch& batch, Workspace& workspace) const {
  const Target& target = targets_[index];
  const double variance = target.hyperparameters.signal_stddev * target.hyperparameters.signal_stddev;
  auto weight = workspace.weight.head(target.factor.paddedSize());
  weight.array() *= variance * target.weights.array();
  auto gradient = workspace.values.gradient.col(index);
  gradient = -weight.sum() * workspace.point;
  batch.inputs.addTransposedProduct(weight.data(), gradient.data());
  gradient.array() *= batch.weights.row(index - batch.first).transpose().array();
  gradient += target.constant_gradient;
}

}  // namespace twinmap::gp
