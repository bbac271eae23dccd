#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "framework/estimation/posterior/noise/output_loss.hpp"

namespace twinmap {

/// -2 log likelihood, but for a summand, of whitened residuals (k) under a hypothesis of their noise.
/// - Outliers have a Cauchy distribution of ten noise standard deviations, so that spikes of 20 and of 500
///   are nothing unusual (calcOutlierLoss); of noise of unknown size, of its likeliest (findOutlierSize).
/// - Of an output with n samples r, correlation R and unknown size, n log(r' R^-1 r / n) + log |R|. An offset
///   c is projected out, which leaves n - 1 for n, and adds log(c' R^-1 c).
/// - Over the colours that R may have it is the mixture of likelihoods.
/// - Of a censored feature the likelihood is the probability of noise that brings the response beyond.
/// Immutable.
class ResidualLoss {
 public:
  /// Of the features of a window of the model. Outputs without times are as stated, and so are all where the
  /// window's noise is singular, or not constant for an offset.
  ResidualLoss(const NoiseHypothesis& hypothesis, const RefinementModel& model, const GrowingWindow& window);

  double calc(const Eigen::VectorXd& residual) const;
  /// jacobian: J, k x u.
  LinearLoss linearize(const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian) const;

  /// Residuals at the best point as they should be independent and of unit variance, if the hypothesis is
  /// true; degrees: of freedom of the whole residual.
  struct Standardized {
    Eigen::VectorXd residual;  ///< k; NaN of censored features, where the response is beyond
    Eigen::MatrixXd jacobian;  ///< k x u, likewise; 0 of censored features
    double degrees = 0.0;      ///< those that offsets and autoregressions take left out
    std::vector<FoundNoise> noise;
  };
  /// jacobian: k x u; in half-widths of the bounds the standard deviations of offsets follow it.
  Standardized standardize(const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian,
                           double degrees) const;

 private:
  /// A row that is censored.
  struct Censored {
    Eigen::Index row;
    double side, scale;
  };

  /// An output of which some samples may be outliers of noise of unknown size.
  struct OfUnknownSize {
    int output;
    std::vector<Eigen::Index> rows;
  };

  /// `scaled` with the residuals of these outputs in units of their likeliest size.
  Eigen::VectorXd scaleBySizes(const Eigen::VectorXd& residual, Eigen::VectorXd scaled) const;
  Eigen::VectorXd scale(const Eigen::VectorXd& residual) const;

  Eigen::VectorXd scale_;  // k: of residuals that count one by one; 0 of the others; empty: 1 of all
  bool has_outliers_;
  std::vector<OfUnknownSize> of_unknown_size_;
  std::vector<Censored> censored_;
  std::vector<std::shared_ptr<const OutputLoss>> outputs_;
};

/// Of each window of a model; empty where the hypothesis is that the noise is as it is stated.
std::vector<ResidualLoss> makeLosses(const NoiseHypothesis& hypothesis, const RefinementModel& model);

}  // namespace twinmap
