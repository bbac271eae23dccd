#include "framework/evaluation/joint_metrics.hpp"

#include <boost/math/constants/constants.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <cassert>
#include <cmath>

#include "framework/evaluation/jackknife.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::ArrayXd;

/// Rows as in kJointColumns.
Eigen::MatrixXd calcTerms(const Eigen::MatrixXd& truth, const Predictions& predictions,
                          const Eigen::MatrixXd& residual_correlation) {
  const linalg::Cholesky factor = linalg::calcCholesky(residual_correlation);
  assert(factor.positive_definite);
  const Eigen::MatrixXd z = (predictions.mean - truth).cwiseQuotient(predictions.stddev);
  const ArrayXd squared_distance = linalg::solveLower(factor.lower, z).colwise().squaredNorm();
  const auto parameters = static_cast<double>(truth.rows());
  const boost::math::chi_squared chi_squared(parameters);
  const auto within = [&](double probability) -> Eigen::RowVectorXd {
    return (squared_distance < boost::math::quantile(chi_squared, probability)).cast<double>().transpose();
  };
  const double log_normalization = factor.lower.diagonal().array().log().sum() +
                                   0.5 * parameters * std::log(boost::math::constants::two_pi<double>());
  Eigen::MatrixXd terms(kJointColumns.size(), truth.cols());
  terms.row(0) = within(0.95);
  terms.row(1) = within(0.90);
  terms.row(2) = within(0.50);
  terms.row(3) = 0.5 * squared_distance.transpose() + predictions.stddev.array().log().colwise().sum() +
                 log_normalization;
  return terms;
}

}  // namespace

JointMetrics calcJointMetrics(const Eigen::MatrixXd& truth, const Predictions& predictions,
                              const Eigen::MatrixXd& residual_correlation) {
  const Estimates estimates = calcWithJackknife(calcTerms(truth, predictions, residual_correlation),
                                                [](const Eigen::VectorXd& mean, double) { return mean; });
  JointMetrics metrics;
  for (std::size_t i = 0; i < kJointColumns.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    metrics.*kJointColumns[i].value = estimates.value[row];
    metrics.se.*kJointColumns[i].value = estimates.standard_error[row];
  }
  return metrics;
}

}  // namespace twinmap
