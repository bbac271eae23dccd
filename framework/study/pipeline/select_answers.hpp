#pragma once

#include "framework/results/run_summary.hpp"
#include "framework/study/pipeline/infer_test_samples.hpp"

namespace twinmap {

/// What `twinmap infer` answers to the test samples (selectEstimate), where its own estimate stands of each:
/// the estimator's, whose errors are correlated as it says of each, or else as its cross-validation found for
/// all (residual_correlation), the refined one, or the simulator's posterior, whose intervals hold the draws
/// that they say. Where refined answers are several, mean and standard deviation are those of the nearest to
/// the truth (p x n), and intervals those of all of them.
Estimates selectAnswers(const InferredTests& tests, const Eigen::MatrixXd& residual_correlation,
                        const Eigen::MatrixXd& truth);

/// What is to be said of the answers; none where nothing was refined.
std::optional<AnswerSummary> summarizeAnswers(const InferredTests& tests);

/// The row of methods.csv of those whose posterior was sampled.
MethodSummary summarizeSampled(const std::vector<ParameterSpec>& parameters, const Eigen::MatrixXd& truth,
                               const InferredTests& tests, const Estimates& answers,
                               const Eigen::MatrixXd& limit_stddev);

}  // namespace twinmap
