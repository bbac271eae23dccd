#include "framework/study/pipeline/shared_error.hpp"

#include <algorithm>

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;

Eigen::VectorXd calcSharedError(const Study& study, const PreparedData& data, const TrainedMap& map) {
  constexpr Index kMost = 200;
  const LabelledFeatures& test = data.labelled.test;
  const std::vector<int> successful = findSuccessful(data.sets.test);
  const Index count = std::min<Index>(kMost, test.features.cols());
  const std::vector<int> first(successful.begin(), successful.begin() + count);
  const MatrixXd features = study.extractor.extract(data.sets.test.responses(Eigen::all, first));
  const Estimates estimates = map.predict(features, test.inputs.leftCols(count));
  return ((estimates.mean - test.parameters.leftCols(count)).array() / estimates.stddev.array())
      .square()
      .rowwise()
      .mean()
      .sqrt();
}

}  // namespace twinmap
