#include "framework/study/pipeline/shared_error.hpp"

#include <algorithm>

#include "framework/estimation/interval_factor.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The standard deviation of the normal distribution that holds 95 % of the sizes in its 95 % interval.
double calcSpread(VectorXd sizes) {
  std::sort(sizes.begin(), sizes.end());
  return calcConformalQuantile(sizes, 0.95) / kNormal95;
}

}  // namespace

VectorXd calcSharedError(const Study& study, const PreparedData& data, const TrainedMap& map) {
  constexpr Index kMost = 200;
  const LabelledFeatures& test = data.labelled.test;
  const std::vector<int> successful = findSuccessful(data.sets.test);
  const Index count = std::min<Index>(kMost, test.features.cols());
  const std::vector<int> first(successful.begin(), successful.begin() + count);
  const MatrixXd features = study.extractor.extract(data.sets.test.responses(Eigen::all, first));
  const Estimates estimates = map.predict(features, test.inputs.leftCols(count));
  const MatrixXd sizes =
      ((estimates.mean - test.parameters.leftCols(count)).array() / estimates.stddev.array()).abs();
  return VectorXd::NullaryExpr(sizes.rows(), [&](Index j) { return calcSpread(sizes.row(j)); });
}

}  // namespace twinmap
