#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/estimation/posterior/noise/noise_hypothesis.hpp"
#include "framework/estimation/refined/refinement_model.hpp"
#include "kernels/linalg/autoregressive_whitener.hpp"

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

/// The samples of an output in time among the features of a window.
struct OutputSamples {
  std::vector<Eigen::Index> rows;  ///< of the window's features, in the order of time
  /// In the smallest of their differences; where they are on no such grid, as of stamps that jitter, in their
  /// median, rounded.
  std::vector<long> lags;
};
/// Without those that are censored.
OutputSamples findSamples(const RefinementModel& model, const GrowingWindow& window, int output,
                          const std::vector<CensoredFeature>& censored = {});

/// What one more of an output, in its unit, is in its samples, whitened (n, in the order of `samples`). Only
/// where the noise is the same for every response.
Eigen::VectorXd makeOffset(const GrowingWindow& window, const OutputSamples& samples);

/// -2 log likelihood, but for a summand, of one output's samples under a hypothesis of their noise
/// (ResidualLoss). Residuals and jacobians are those of all features (k, k x u). Immutable.
class OutputLoss {
 public:
  /// offset: makeOffset(). The samples have lags where the noise has colours.
  OutputLoss(OutputNoise noise, OutputSamples samples, Eigen::VectorXd offset);

  const std::vector<Eigen::Index>& getRows() const { return samples_.rows; }

  double calc(const Eigen::VectorXd& residual) const;
  /// Adds all but the loss.
  void addTo(const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian, LinearLoss& sum) const;

  /// Makes its rows independent and of unit variance, and says what was found. scale: of the squares, for the
  /// degrees of freedom that parameters take.
  FoundNoise standardize(Eigen::VectorXd& residual, Eigen::MatrixXd& jacobian, double scale) const;
  /// Degrees of freedom that an offset and an autoregression take.
  double countTaken() const;

 private:
  /// Whitened residual (row 0), offset (row 1) and derivatives (the others), the offset projected out.
  struct Projected {
    Eigen::MatrixXd series;
    double squares = 0.0, degrees = 0.0, log_determinant = 0.0;
    double offset = 0.0, offset_information = 0.0;
  };
  struct ColourMixture {
    double loss;             // -2 log of the likelihood
    Eigen::VectorXd shares;  // of the colours in it
  };

  Projected makeProjected(const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian) const;
  void projectOffset(Projected& projected) const;
  std::vector<Projected> project(const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian) const;
  double calcPrecision(const Projected& one) const;
  ColourMixture calcMixture(const std::vector<Projected>& all) const;
  Eigen::VectorXd calcAutoregression(const Eigen::VectorXd& shares) const;

  const OutputNoise noise_;
  const OutputSamples samples_;
  const Eigen::VectorXd offset_;
  std::vector<AutoregressiveWhitener> whiteners_;
};

}  // namespace twinmap
