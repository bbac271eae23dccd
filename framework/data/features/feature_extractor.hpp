#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "framework/data/features/feature_block.hpp"
#include "framework/experiment/experiment_spec.hpp"
#include "framework/simulation/input_signals.hpp"
#include "framework/simulation/response_layout.hpp"

namespace twinmap {

/// The times at which outputs must be known for all features: sorted, unique; s.
Eigen::VectorXd collectTimes(const std::vector<FeatureSpec>& features);

/// The smallest interval at which a feature samples the outputs, s; none if each takes a single sample.
std::optional<double> findSampleInterval(const std::vector<FeatureSpec>& features);

/// Whether features need the values of the excitation.
bool needExcitation(const std::vector<FeatureSpec>& features);

/// Maps responses to features: the blocks of the experiment's list, one below the other. Immutable.
class FeatureExtractor {
 public:
  /// The layout must contain the features' outputs and times (collectTimes); `inputs`, only where features
  /// need the excitation, the signals at the layout's times. Throws std::invalid_argument, and
  /// ExperimentError for a frequency response where the excitation has no energy.
  FeatureExtractor(const std::vector<FeatureSpec>& features, const ResponseLayout& layout,
                   const InputSignals& inputs = {});

  const std::vector<FeatureInfo>& getInfos() const { return infos_; }
  const std::vector<std::shared_ptr<const FeatureBlock>>& getBlocks() const { return blocks_; }
  Eigen::Index getFeatureCount() const { return static_cast<Eigen::Index>(infos_.size()); }
  bool isLinear() const;  ///< all features are linear in the response

  /// Responses (rows of the layout x n) -> features (d x n). A column of NaN stays one.
  Eigen::MatrixXd extract(const Eigen::MatrixXd& responses) const;

  /// Whether some features have a linear form (FeatureBlock::findLinearForm).
  bool hasLinearForm() const;
  /// The same with these in their linear form, d' <= d.
  FeatureExtractor makeLinearForm() const;
  /// Features (d x n) -> those of the linear form (d' x n).
  Eigen::MatrixXd convertToLinearForm(const Eigen::MatrixXd& features) const;
  /// And back: features of the linear form (d' x n) -> features (d x n).
  Eigen::MatrixXd convertFromLinearForm(const Eigen::MatrixXd& linear) const;
  /// Numbers of the linear form's features (d') in the places (d) of those they stand for; 0 in those left.
  Eigen::VectorXd placeLinearForm(const Eigen::VectorXd& linear) const;

 private:
  explicit FeatureExtractor(std::vector<std::shared_ptr<const FeatureBlock>> blocks);

  std::vector<std::shared_ptr<const FeatureBlock>> blocks_;
  std::vector<FeatureInfo> infos_;
};

}  // namespace twinmap
