#pragma once

#include <string>
#include <vector>

#include "framework/results/run_summary.hpp"

namespace twinmap {

/// Those of the estimator, their errors correlated as it says of each, or else as its cross-validation found
/// for all, with the refined ones in place of those whose refinement was accepted, as `twinmap infer` selects
/// (selectEstimate). `refined`: one for each sample, or empty.
Estimates selectEstimates(Estimates by_estimator, const Eigen::MatrixXd& residual_correlation,
                          const std::vector<Refined>& refined);

/// Intervals of a sample's estimate are of these factors (p x 1), or normal ones where none are given.
void setFactors(const IntervalFactors& of_one, Eigen::Index sample, Estimates& estimates);

/// What follows from the estimates of the test samples alone: metrics, joint metrics and PIT counts.
/// `limit_stddev`: p x n, or empty.
Evaluation evaluateEstimates(const std::vector<ParameterSpec>& parameters, const Eigen::MatrixXd& truth,
                             Estimates estimates, const Eigen::MatrixXd& limit_stddev);

/// A row of methods.csv: an estimator, which gives an estimate of every sample. `name`: of the method.
MethodSummary summarizeMap(const std::string& name, const std::vector<ParameterSpec>& parameters,
                           const Eigen::MatrixXd& truth, const Estimates& predictions,
                           const Eigen::MatrixXd& limit_stddev);

/// The row of what was refined and accepted; without metrics for fewer than three such samples.
MethodSummary summarizeRefined(const std::vector<ParameterSpec>& parameters, const Eigen::MatrixXd& truth,
                               const std::vector<Refined>& refined, const Eigen::MatrixXd& limit_stddev);

/// The rows of methods.csv: the estimator's, and, where samples were refined, that of the accepted ones.
std::vector<MethodSummary> summarizeMethods(const std::string& name,
                                            const std::vector<ParameterSpec>& parameters,
                                            const Eigen::MatrixXd& truth, const Estimates& by_estimator,
                                            const std::vector<Refined>& refined,
                                            const Eigen::MatrixXd& limit_stddev);

/// The samples whose refinement was accepted.
std::vector<Eigen::Index> findAccepted(const std::vector<Refined>& refined);

}  // namespace twinmap
