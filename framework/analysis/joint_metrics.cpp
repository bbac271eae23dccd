#include "framework/analysis/joint_metrics.hpp"

#include <boost/math/constants/constants.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <cassert>
#include <cmath>

#include "framework/analysis/jackknife.hpp"
#include "framework/analysis/sample_terms.hpp"
#include "framework/base/random/random.hpp"
#include "framework/estimation/draws.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::ArrayXd;

/// Of each sample: the squared Mahalanobis distance, and log det R / 2.
struct Distances {
  ArrayXd squared, half_log_determinant;
};

Distances calcDistances(const Eigen::MatrixXd& z, const std::vector<Eigen::MatrixXd>& correlations) {
  const Eigen::Index n = z.cols();
  Distances distances{ArrayXd(n), ArrayXd(n)};
  linalg::Cholesky factor;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (i == 0 || correlations.size() > 1) {
      factor = linalg::calcCholesky(correlations[static_cast<std::size_t>(i)]);
      assert(factor.positive_definite);
    }
    distances.squared[i] = linalg::solveLower(factor.lower, z.col(i)).squaredNorm();
    distances.half_log_determinant[i] = factor.lower.diagonal().array().log().sum();
  }
  return distances;
}

/// The share of a mixture's draws whose density is above that of a point.
double calcCredibility(const Mixture& mixture, const MixtureDensity& mixed, double log_density,
                       const RandomStream& random) {
  constexpr int kDraws = 400;  // to 1 % at 95 %, which many samples average
  const Eigen::MatrixXd draws = drawFrom(mixture, kDraws, random);
  int above = 0;
  for (const auto& draw : draws.colwise()) {
    above += mixed.calcLog(draw) > log_density ? 1 : 0;
  }
  return static_cast<double>(above) / kDraws;
}

Eigen::MatrixXd calcMixtureTerms(const Eigen::MatrixXd& truth, const std::vector<Mixture>& mixtures) {
  Eigen::MatrixXd terms(kJointColumns.size(), truth.cols());
  for (Eigen::Index i = 0; i < truth.cols(); ++i) {
    const Mixture& mixture = mixtures[static_cast<std::size_t>(i)];
    const RandomStream random(static_cast<std::uint64_t>(i), RandomPurpose::kJointCoverage);
    const MixtureDensity mixed(mixture);
    const double log_density = mixed.calcLog(truth.col(i));
    const double credibility = calcCredibility(mixture, mixed, log_density, random);
    const auto holds = [&](double probability) { return credibility < probability ? 1.0 : 0.0; };
    terms.col(i) << holds(0.95), holds(0.90), holds(0.50), -log_density;
  }
  return terms;
}

/// Rows as in kJointColumns.
Eigen::MatrixXd calcTerms(const Eigen::MatrixXd& truth, const Estimates& predictions) {
  if (!predictions.mixtures.empty()) {
    return calcMixtureTerms(truth, predictions.mixtures);
  }
  const Distances distances =
      calcDistances((predictions.mean - truth).cwiseQuotient(predictions.stddev), predictions.correlations);
  const auto parameters = static_cast<double>(truth.rows());
  const boost::math::chi_squared chi_squared(parameters);
  const auto within = [&](double probability) -> Eigen::RowVectorXd {
    return (distances.squared < boost::math::quantile(chi_squared, probability)).cast<double>().transpose();
  };
  const double log_normalization = 0.5 * parameters * std::log(boost::math::constants::two_pi<double>());
  Eigen::MatrixXd terms(kJointColumns.size(), truth.cols());
  terms.row(0) = within(0.95);
  terms.row(1) = within(0.90);
  terms.row(2) = within(0.50);
  terms.row(3) = (0.5 * distances.squared + distances.half_log_determinant + log_normalization).transpose() +
                 predictions.stddev.array().log().colwise().sum();
  return terms;
}

}  // namespace

JointMetrics calcJointMetrics(const Eigen::MatrixXd& truth, const Estimates& estimates) {
  const JackknifeFigures figures = calcWithJackknife(
      sumUp(calcTerms(estimates.repeat(truth), estimates), estimates.weights, estimates.repeated),
      [](const Eigen::VectorXd& mean, double) { return mean; });
  JointMetrics metrics;
  for (std::size_t i = 0; i < kJointColumns.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    metrics.*kJointColumns[i].value = figures.value[row];
    metrics.se.*kJointColumns[i].value = figures.standard_error[row];
  }
  return metrics;
}

}  // namespace twinmap
