#pragma once

#include <Eigen/Core>
#include <cmath>

#include "kernels/gp/model.hpp"
#include "tests/kernels/support/two_beam_data.hpp"

namespace twinmap::bench {

/// The first `features` z-scored features of the two-beam case, taken evenly, and its targets at zero mean
/// and unit variance.
struct Problem {
  Eigen::MatrixXd inputs;   // features x n
  Eigen::MatrixXd targets;  // 4 x n
};

inline Problem makeProblem(int samples, int features, std::uint64_t seed = 1) {
  const test::TwoBeamData data = test::makeTwoBeamData(samples, seed);
  const Eigen::MatrixXd scored = test::zScored(data.features);
  Problem problem{Eigen::MatrixXd(features, samples), test::zScored(data.parameters)};
  for (int f = 0; f < features; ++f) {
    problem.inputs.row(f) = scored.row(f * 200 / features);
  }
  return problem;
}

inline gp::ModelStructure makeStructure(int features, bool per_feature) {
  gp::ModelStructure structure;
  structure.mean = gp::MeanFunction::kZero;  // as in scikit-learn
  if (per_feature) {
    structure.length_scale_groups = gp::oneGroupPerFeature(features);
  }
  return structure;
}

inline gp::Hyperparameters makeHyperparameters(int features, bool per_feature) {
  gp::Hyperparameters hyperparameters;
  hyperparameters.length_scales =
      Eigen::VectorXd::Constant(per_feature ? features : 1, std::sqrt(1.5 * features));
  return hyperparameters;
}

}  // namespace twinmap::bench
