#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/optimal_design/criterion.hpp"
#include "framework/optimal_design/excitation_limits.hpp"
#include "framework/optimal_design/free_values.hpp"

namespace twinmap::experiment_design {

/// What the search asks of one design.
struct DesignScore {
  double cost = 0.0;         ///< mean of calcCost() over the points; NaN where a simulation failed
  Eigen::VectorXd measures;  ///< of each limit, in its unit
  std::string failure;       ///< "" if none
};

/// What a design leaves unknown over the box, and how far its outputs go.
struct DesignLimit {
  DesignScore score;
  Eigen::MatrixXd stddev;            ///< p x points, of the information limit, in the parameters' units
  Eigen::VectorXd costs;             ///< at each point
  Eigen::MatrixXd mean_information;  ///< p x p, per width
  Eigen::MatrixXd mean_covariance;   ///< p x p, in widths
};

/// Judges designs of an experiment's excitation. Each costs one simulation with derivatives a point and the
/// building of the model: a few ms on a small mechanism in lanes.
class ExcitationEvaluator {
 public:
  /// `tree`: of the experiment, whose free numbers are written out (resolveFreeNumbers).
  ExcitationEvaluator(YamlNode tree, std::vector<FreeNumber> numbers, int threads);

  const std::vector<FreeNumber>& getNumbers() const { return numbers_; }
  const std::vector<Limit>& getLimits() const { return limits_; }
  const ExperimentSpec& getExperiment() const { return experiment_; }

  /// The experiment with such values (not fractions).
  YamlNode makeTree(const Eigen::VectorXd& values) const { return setValues(tree_, numbers_, values); }
  ExperimentSpec makeExperiment(const Eigen::VectorXd& values) const;

  /// At points of the sampled box (columns). Values that no excitation can have (a pulse that ends before it
  /// starts) are a failure of the score; wrong input throws ExperimentError.
  DesignScore calcScore(const Eigen::VectorXd& values, const Eigen::MatrixXd& points) const;
  DesignLimit calcLimit(const Eigen::VectorXd& values, const Eigen::MatrixXd& points) const;

  /// The measures of the limits alone, without derivatives.
  DesignScore calcMeasures(const Eigen::VectorXd& values, const Eigen::MatrixXd& points) const;

 private:
  YamlNode tree_;
  std::vector<FreeNumber> numbers_;
  int threads_;
  ExperimentSpec experiment_;
  std::vector<Limit> limits_;
  Criterion criterion_;
};

}  // namespace twinmap::experiment_design
