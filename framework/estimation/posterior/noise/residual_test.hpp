#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/data/features/feature_block.hpp"
#include "framework/estimation/levels.hpp"

namespace twinmap {

/// Over so many lags of samples, whatever swings shows.
constexpr Eigen::Index kMostLags = 10;

/// Whether a residual could be noise: three tests, each with its p-value.
struct ResidualTest {
  double chi_square_p = 1.0;  ///< of a sum of squares as large
  double whiteness_p = 1.0;   ///< of neighbours in time that agree as much (Ljung and Box 1978)
  double largest_p = 1.0;     ///< of a single residual as large
  int largest = -1;           ///< its feature
  int output = -1;            ///< whose samples depend most on each other; -1 where too few have times
  int lag = 0;                ///< of them, those so many samples apart
  double correlation = 0.0;   ///< of their residuals

  /// That of the smallest of three, by Bonferroni's bound: below it in at most as many of the good
  /// measurements.
  double calcPValue() const;

  /// Whether nothing speaks against the noise as it is supposed: neither a test of what is too much, nor a
  /// sum of squares that is too small, in one of a thousand good measurements.
  bool isPlausible() const;
};

/// residual: whitened, one for each of `infos` (none: not plausible); degrees: of freedom of its sum of
/// squares. Whiteness is tested within each output whose samples have times, over one, three and ten lags
/// (Bonferroni), where there are at least 20 samples and the residual is not below a hundredth of the noise;
/// the parameters that were fitted make neighbours a little less alike, so that the test is on the safe side.
ResidualTest testResidual(const Eigen::VectorXd& residual, double degrees,
                          const std::vector<FeatureInfo>& infos);

}  // namespace twinmap
