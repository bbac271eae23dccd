#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/analysis/information_limit.hpp"
#include "framework/analysis/metrics.hpp"
#include "framework/estimation/derived/derived_quantities.hpp"

namespace twinmap {

/// How well q derived quantities are inferred in n samples.
struct DerivedEvaluation {
  std::vector<ParameterSpec> quantities;             ///< DerivedQuantities::getSpecs()
  Eigen::MatrixXd truth;                             ///< q x n
  Eigen::MatrixXd mean, stddev, lower95, upper95{};  ///< q x n
  Eigen::MatrixXd limit_stddev{};                    ///< q x n; empty where there is no limit
  std::vector<ParameterMetrics> metrics{};           ///< coverage is that of the quantiles
};

/// What estimates of the parameters, with their correlations, say of the derived quantities. `truth`: p x n;
/// `limit_stddev`: q x n or empty. The factor of intervals is the largest of the parameters'.
DerivedEvaluation evaluateDerived(const DerivedQuantities& quantities, const Eigen::MatrixXd& truth,
                                  const Estimates& estimates, const Eigen::MatrixXd& limit_stddev);

/// The limit of the derived quantities (q x n, their units) at the points (p x n) that the limit is of, to
/// first order: with the gradient g the square root of g' C g. NaN where the limit has failed.
Eigen::MatrixXd calcDerivedLimit(const DerivedQuantities& quantities,
                                 const std::vector<ParameterSpec>& parameters, const Eigen::MatrixXd& points,
                                 const InformationLimit& limit);

}  // namespace twinmap
