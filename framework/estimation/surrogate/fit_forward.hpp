#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/estimation/run_tasks.hpp"
#include "framework/estimation/surrogate/feature_windows.hpp"
#include "framework/estimation/surrogate/forward_samples.hpp"
#include "framework/estimation/surrogate/forward_surrogate.hpp"
#include "kernels/surrogate/fit_shared_process.hpp"

namespace twinmap {

/// What was chosen for each window of features.
struct ForwardChoices {
  std::vector<FeatureWindow> windows;
  std::vector<gp::SharedChoice> processes;
  std::vector<double> slope_shares;  ///< WindowFit::slope_share
};

/// A forward surrogate, and what was chosen for it.
struct ForwardFit {
  ForwardSurrogate surrogate;
  ForwardChoices choices;
  std::vector<ForwardSurrogate> folds;  ///< fitted without some of the simulations, by the same choices
};

/// Fits processes to the principal components of each window of whitened features (makeFeatureWindows, parted
/// further where that is worth it: divideWindow). Components that move less
/// than 0.2 of the noise are left out; of the others those are kept that say most about the parameters, by sd
/// over sqrt(1 + error variance): at most 200, and as many as the errors of n simulations tell the
/// correlations of, n / 4 where the errors are far above the noise, and more the further they are below. The
/// correlation of the errors is that of the points left out, shrunk towards independence by at least 0.2
/// (Schaefer and Strimmer 2005). Where slopes are given, each window learns from them as well if that
/// predicts simulations left out better (gp::chooseWithSlopes). `similar`: choices for nearly the same
/// samples, to start from; empty to search anew. `folds`: the simulations that each fold of a
/// cross-validation keeps (rising), where all is searched anew; they share factorisations with the whole.
/// Throws std::invalid_argument for a feature without noise and for too few simulations, gp::Stopped. Cost: a
/// window some 40 evaluations of gp::LeftOutDensity on 300 points, 8 from similar choices; then 2 n^3 flops,
/// with slopes (n + u m)^3 for the whole with all its folds.
ForwardFit fitForward(const ForwardSamples& samples, const ForwardChoices& similar,
                      const TrainingControl& control,
                      const std::vector<std::vector<Eigen::Index>>& folds = {});

}  // namespace twinmap
