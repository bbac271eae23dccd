#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/spec/experiment_spec.hpp"

namespace twinmap {

/// What one feature is.
struct FeatureInfo {
  std::string name;   ///< "y(0.05 s)"
  int output = 0;     ///< index of the output it is made of
  double time = 0.0;  ///< s
};

/// The times at which outputs must be known for all features: sorted, unique; s.
Eigen::VectorXd collectTimes(const std::vector<FeatureSpec>& features);

/// Maps responses to features. Immutable.
class FeatureExtractor {
 public:
  /// `times` are those of the responses and must contain those of the features (collectTimes).
  FeatureExtractor(const std::vector<FeatureSpec>& features, const std::vector<std::string>& output_names,
                   const Eigen::VectorXd& times);

  const std::vector<FeatureInfo>& getInfos() const { return infos_; }

  /// Responses (outputs * times x n, output by output) -> features (d x n). A column of NaN stays one.
  Eigen::MatrixXd extract(const Eigen::MatrixXd& responses) const;

 private:
  std::vector<FeatureInfo> infos_;
  std::vector<Eigen::Index> rows_;  // row of the response of each feature
};

}  // namespace twinmap
