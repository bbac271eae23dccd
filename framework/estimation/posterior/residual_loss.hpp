#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "framework/estimation/posterior/noise_hypothesis.hpp"
#include "framework/estimation/refined/refinement_model.hpp"

namespace twinmap {

/// A loss and its linear model: with the residual r and its derivatives -J,
///   loss(step) ~ loss - 2 step' descent + step' information step.
struct LinearLoss {
  double loss = 0.0;
  double chi_square = 0.0;  ///< a sum of squares of what is noise, that of unknown size in its own units
  Eigen::MatrixXd information;
  Eigen::VectorXd descent;
  Eigen::VectorXd weights;  ///< k: of residuals among outliers, about 0 of an outlier; else 1
};

/// -2 log likelihood, but for a summand, of whitened residuals (k) under a hypothesis of their noise.
/// - Outliers have a Cauchy distribution of ten noise standard deviations, so that spikes of 20 and of 500
///   are nothing unusual.
/// - Of an output with n samples r, correlation R and unknown size, n log(r' R^-1 r / n) + log |R|. A
/// constant
///   offset c is projected out, which leaves n - 1 for n, and adds log(c' R^-1 c).
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
    double degrees = 0.0;      ///< those that offsets and autoregressions take left out
    std::vector<FoundNoise> noise;
  };
  /// jacobian (k x u, in half-widths of the bounds): for the standard deviations of offsets.
  Standardized standardize(const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian,
                           double degrees) const;

 private:
  class Output;
  /// A row that is censored.
  struct Censored {
    Eigen::Index row;
    double side, scale;
  };

  Eigen::VectorXd scale(const Eigen::VectorXd& residual) const;

  Eigen::VectorXd scale_;  // k: of residuals that count one by one; 0 of the others; empty: 1 of all
  bool has_outliers_;
  std::vector<Censored> censored_;
  std::vector<std::shared_ptr<const Output>> outputs_;
};

/// The samples of an output in time among the features of a window.
struct OutputSamples {
  std::vector<Eigen::Index> rows;  ///< of the window's features, in the order of time
  std::vector<long> lags;  ///< in the smallest of their differences; empty where they are on no such grid
};
/// Without those that are censored.
OutputSamples findSamples(const RefinementModel& model, const GrowingWindow& window, int output,
                          const std::vector<CensoredFeature>& censored = {});

/// What one more of an output, in its unit, is in its samples, whitened (n, in the order of `samples`). Only
/// where the noise is the same for every response.
Eigen::VectorXd makeOffset(const GrowingWindow& window, const OutputSamples& samples);

}  // namespace twinmap
