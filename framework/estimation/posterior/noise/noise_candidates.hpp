#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/estimation/posterior/noise/noise_hypothesis.hpp"
#include "framework/estimation/posterior/noise/residual_test.hpp"
#include "framework/estimation/refined/refinement_model.hpp"

namespace twinmap {

/// A measurement about the best point that was found for it.
struct LinearFit {
  const RefinementModel* model;
  Eigen::VectorXd residual;  ///< whitened, k
  Eigen::MatrixXd jacobian;  ///< minus its derivatives by the unknown, in half-widths of their bounds, k x u
};

/// What else than `stated` the noise of a measurement may be that `stated` does not explain, the likeliest
/// first: a few samples that are not noise; sizes other than stated; both; sensors with an offset; colours
/// (fitColours), of any size, where neighbours agree too much; and these with an offset. Each without
/// outliers is tried on the linear model and left out where it explains the residual no better; offsets are
/// supposed of those outputs alone that have one of more than 3.3 standard deviations there, under the
/// colours where there are any.
std::vector<NoiseHypothesis> listNoiseHypotheses(const NoiseHypothesis& stated, const LinearFit& fit);

/// `stated` with a guess in the place of sizes that are not known, from the second differences of the
/// measured samples (as features, d): of the noise or, where samples lie far apart, larger. With it a search
/// can see whether it came near the measurement.
NoiseHypothesis guessSizes(NoiseHypothesis stated, const RefinementModel& model,
                           const Eigen::VectorXd& features);

/// Whether the size of noise that was found is significantly above that stated (once in a thousand).
bool isLargerThanStated(const FoundNoise& noise);
/// The same on either side, in standard errors of the factor's logarithm.
double calcSizeDeviation(const FoundNoise& noise);

}  // namespace twinmap
