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
using ConstVectorRef = Eigen::Ref<const VectorXd>;

namespace {

bool can_share_distances(const std::vector<const GaussianProcess*>& processes) {
  const GaussianProcess& first = *processes.front();
  return std::all_of(processes.begin(), processes.end(), [&](const GaussianProcess* process) {
    return process->parts().inputs == first.parts().inputs && group_count(process->structure()) == 1 &&
           !process->structure().linear_term;
  });
}

std::vector<const GaussianProcess*> pointers_to(
    const std::vector<std::shared_ptr<const GaussianProcess>>& processes) {
  std::vector<const GaussianProcess*> pointers;
  for (const auto& process : processes) pointers.push_back(process.get());
  return pointers;
}

std::vector<const GaussianProcess*> pointers_to(const std::vector<GaussianProcess>& processes) {
  std::vector<const GaussianProcess*> pointers;
  for (const auto& process : processes) pointers.push_back(&process);
  return pointers;
}

}  // namespace

OnlinePredictor::OnlinePredictor(const std::vector<std::shared_ptr<const GaussianProcess>>& processes) {
  add_targets(pointers_to(processes));
}

OnlinePredictor::OnlinePredictor(const std::vector<GaussianProcess>& processes) {
  add_targets(pointers_to(processes));
}

void OnlinePredictor::add_targets(const std::vector<const GaussianProcess*>& processes) {
  if (processes.empty()) throw std::invalid_argument("OnlinePredictor: there are no processes");
  for (const GaussianProcess* process : processes) {
    if (process == nullptr)
      throw std::invalid_argument("OnlinePredictor: a process is null (training failed)");
    if (process->feature_count() != processes.front()->feature_count()) {
      throw std::invalid_argument("OnlinePredictor: the processes differ in their number of features");
    }
  }
  center_ = processes.front()->center();
  shares_distances_ = can_share_distances(processes);
  if (shares_distances_) {
    shared_samples_ = linalg::PackedSamples(processes.front()->inputs().colwise() - center_);
  }
  for (const GaussianProcess* process : processes) {
    targets_.push_back(make_target(*process, shares_distances_));
  }
}

OnlinePredictor::Target OnlinePredictor::make_target(const GaussianProcess& process, bool shares_distances) {
  Target target;
  target.structure = process.structure();
  target.hyperparameters = process.hyperparameters();
  target.center = process.center();
  target.inverse_length_scales = process.inverse_length_scales();
  if (process.structure().linear_term) {
    const double linear_stddev = process.hyperparameters().linear_stddev;
    target.linear_weights = linear_stddev * linear_stddev * target.inverse_length_scales.array().pow(-2.0);
  }
  if (!shares_distances) {
    target.samples = linalg::PackedSamples(target.inverse_length_scales.asDiagonal() *
                                           (process.inputs().colwise() - target.center));
  }
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
  distances.setZero(predictor.shared_samples_.padded_size());
  scaled.setZero(largest);
  covariance.setZero(largest);
  weight.setZero(largest);
  error.setZero(coefficients);
}

void OnlinePredictor::predict(const ConstVectorRef& x, Eigen::Ref<VectorXd> mean, Eigen::Ref<VectorXd> stddev,
                              Workspace& workspace) const {
  assert(x.size() == feature_count() && mean.size() == target_count() && stddev.size() == target_count());
  const linalg::FlushDenormals flush;
  if (shares_distances_) {
    workspace.point = x - center_;
    shared_samples_.squared_distances(workspace.point.data(), 0, feature_count(), workspace.distances.data());
  }
  for (Index t = 0; t < target_count(); ++t) {
    const Target& target = targets_[t];
    const double signal_stddev = target.hyperparameters.signal_stddev;
    const double noise_stddev = target.hyperparameters.noise_stddev;
    calc_covariance(target, x, workspace);
    auto covariance = workspace.covariance.head(target.factor.padded_size());
    double variance = signal_stddev * signal_stddev;
    if (target.structure.linear_term) {
      variance += (workspace.point.array().square() * target.linear_weights.array()).sum();
    }
    mean(t) = covariance.dot(target.alpha);
    target.factor.solve(covariance.data());
    variance = apply_mean(target, x, variance - covariance.squaredNorm(), mean(t), workspace);
    stddev(t) = std::sqrt(std::max(variance, 0.0) + noise_stddev * noise_stddev);
  }
}

void OnlinePredictor::calc_covariance(const Target& target, const ConstVectorRef& x,
                                      Workspace& workspace) const {
  const Index size = target.factor.padded_size();
  if (shares_distances_) {
    const double inverse = target.inverse_length_scales(0);
    workspace.scaled.head(size) = inverse * inverse * workspace.distances;
  } else {
    workspace.point = (x - target.center).cwiseProduct(target.inverse_length_scales);
    target.samples.squared_distances(workspace.point.data(), 0, feature_count(), workspace.scaled.data());
  }
  AlignedColumn covariance(workspace.covariance.data(), size);
  evaluate_radial(target.structure.covariance, target.hyperparameters.shape,
                  ConstAlignedColumn(workspace.scaled.data(), size), covariance,
                  AlignedColumn(workspace.weight.data(), size));
  covariance *= target.hyperparameters.signal_stddev * target.hyperparameters.signal_stddev;
  if (target.structure.linear_term) {
    workspace.point.array() *= target.linear_weights.array();
    target.samples.add_product(workspace.point.data(), covariance.data());
    workspace.point.array() /= target.linear_weights.array();
  }
  covariance.tail(size - target.sample_count).setZero();
}

// Adds h(x)'b to the mean and e'A^-1 e to the variance.
double OnlinePredictor::apply_mean(const Target& target, const ConstVectorRef& x, double variance,
                                   double& mean, Workspace& workspace) const {
  const Index count = target.mean_coefficients.size();
  if (count == 0) return variance;
  const auto whitened = workspace.covariance.head(target.factor.padded_size());
  for (Index k = 0; k < count; ++k) {
    const double basis = k == 0 ? 1.0 : x(k - 1) - target.center(k - 1);
    mean += basis * target.mean_coefficients(k);
    workspace.error(k) = basis - target.whitened_basis.col(k).dot(whitened);
  }
  linalg::solve_lower(linalg::view_of(target.basis_factor), workspace.error.data());
  return variance + workspace.error.head(count).squaredNorm();
}

}  // namespace twinmap::gp
