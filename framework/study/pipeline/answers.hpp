#pragma once

#include <string>
#include <vector>

#include "framework/results/run_summary.hpp"

namespace twinmap {

/// What is answered to the test samples: p parameters, n samples.
struct Answers {
  Predictions predictions;                    ///< p x n
  std::vector<Eigen::MatrixXd> correlations;  ///< p x p, of the errors: one for all samples, or one for each
  std::vector<Mixture> ridges{};              ///< of each sample, where refinement followed one; else empty
};

/// The map's answers, their errors correlated as the map says of each, or else as its cross-validation found
/// for all, with the refined ones in place of those whose refinement was accepted, as `twinmap
/// infer` chooses. `refined`: one for each sample, or empty.
Answers makeAnswers(const Predictions& map, const Eigen::MatrixXd& residual_correlation,
                    const std::vector<Refined>& refined);

/// What follows from the answers alone: metrics, joint metrics and PIT counts. `limit_stddev`: p x n, or
/// empty.
Evaluation evaluateAnswers(const std::vector<ParameterSpec>& parameters, const Eigen::MatrixXd& truth,
                           const Answers& answers, const Eigen::MatrixXd& limit_stddev);

/// A row of methods.csv: a map that answers every sample. `name`: of the method.
MethodSummary summarizeMap(const std::string& name, const std::vector<ParameterSpec>& parameters,
                           const Eigen::MatrixXd& truth, const Predictions& predictions,
                           const Eigen::MatrixXd& limit_stddev);

/// The row of what was refined and accepted; without metrics for fewer than three such samples.
MethodSummary summarizeRefined(const std::vector<ParameterSpec>& parameters, const Eigen::MatrixXd& truth,
                               const std::vector<Refined>& refined, const Eigen::MatrixXd& limit_stddev);

/// The samples whose refinement was accepted.
std::vector<Eigen::Index> findAccepted(const std::vector<Refined>& refined);

}  // namespace twinmap
