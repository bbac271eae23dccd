#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "kernels/gp/covariance/covariance.hpp"

namespace twinmap::gp {

/// log(2 pi), of every normal density.
inline constexpr double kLogTwoPi = 1.8378770664093454836;

/// The prior mean m(x) = h(x)' b. The coefficients b have a flat prior and are integrated out (Rasmussen and
/// Williams section 2.7), so they are no hyperparameters. h is empty, [1], or [1; x - c] with c the mean
/// training input.
enum class MeanFunction { kZero, kConstant, kLinear };

/// What is fixed before training:
///   y(x) = m(x) + f(x) + noise,   cov f = s_f^2 k(r) + s_l^2 (x - c)'(x' - c),   var noise = s_n^2.
struct ModelStructure {
  CovarianceFunction covariance = CovarianceFunction::kSquaredExponential;
  /// Feature i uses the length scale length_scale_groups[i], numbered from 0 without gaps; size d. Empty: one
  /// length scale shared by all features.
  std::vector<int> length_scale_groups;
  /// Adds the linear term s_l^2 (x - c)'(x' - c). Off: features rarely map linearly over a whole box.
  bool linear_term = false;
  /// Constant: parameters are rarely centred on zero, and the exact integration costs next to nothing.
  MeanFunction mean = MeanFunction::kConstant;
};

/// All in the units of the inputs (length scales) or the target (the stddevs); all positive.
struct Hyperparameters {
  Eigen::VectorXd length_scales;  ///< l, one per group
  double signal_stddev = 1.0;     ///< s_f
  double noise_stddev = 0.3;      ///< s_n
  double shape = 1.0;             ///< a of the rational quadratic; unused by the others
  double linear_stddev = 1.0;     ///< s_l; unused without the linear term
};

/// One group of a structure per feature: the features 0 ... d-1, each with its own length scale.
std::vector<int> oneGroupPerFeature(int feature_count);

int getGroupCount(const ModelStructure& structure);
int getMeanCoefficientCount(const ModelStructure& structure, Eigen::Index feature_count);

/// The hyperparameters that the structure uses, as logarithms: length scales, signal, noise, then shape, then
/// linear stddev.
Eigen::VectorXd toLog(const ModelStructure& structure, const Hyperparameters& hyperparameters);
Hyperparameters fromLog(const ModelStructure& structure, const Eigen::VectorXd& log_hyperparameters);
/// Where to_log puts what follows the length scales.
struct HyperparameterLayout {
  explicit HyperparameterLayout(const ModelStructure& structure);
  int signal;
  int noise;
  int shape;   ///< -1 when unused
  int linear;  ///< -1 when unused
  int count;
};
/// Their names in the same order: length_scale[0], ..., signal_stddev, noise_stddev, shape, linear_stddev.
std::vector<std::string> getHyperparameterNames(const ModelStructure& structure);

/// Throw std::invalid_argument naming the offending value and the broken rule.
void checkStructure(const ModelStructure& structure, Eigen::Index feature_count);
void checkHyperparameters(const ModelStructure& structure, const Hyperparameters& hyperparameters);
void checkInputs(const Eigen::Ref<const Eigen::MatrixXd>& inputs, const char* caller);

}  // namespace twinmap::gp
