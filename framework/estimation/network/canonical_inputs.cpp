#include "framework/estimation/network/canonical_inputs.hpp"

#include <cmath>

#include "framework/data/reduction/affine_step.hpp"
#include "framework/data/reduction/principal_components.hpp"
#include "framework/estimation/levels.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Of all variables, of the highest degree that leaves enough samples a term.
network::Products chooseDegree(Index variables, Index samples) {
  for (const network::Products products :
       {network::Products{variables, variables}, network::Products{variables, 0}}) {
    if (sufficeFor(variables, products, samples)) {
      return products;
    }
  }
  return {};
}

/// Centred polynomials of the points: terms x n.
MatrixXd makePolynomials(const MatrixXd& points) {
  const MatrixXd scaled = fitZScore(points).apply(points);
  MatrixXd terms = network::makeTerms(scaled, chooseDegree(points.rows(), points.cols()));
  terms.colwise() -= VectorXd(terms.rowwise().mean());
  return terms;
}

/// What a regression on the terms explains of the inputs' covariance.
MatrixXd calcExplained(const MatrixXd& terms, const MatrixXd& inputs) {
  const auto n = static_cast<double>(inputs.cols());
  MatrixXd squares = terms * terms.transpose() / n;
  squares.diagonal().array() += kSameNumber;  // of a variance of 1: parameters on a grid may repeat
  const MatrixXd cross = terms * inputs.transpose() / n;
  const MatrixXd half = linalg::solveLower(linalg::calcCholesky(squares).lower, cross);
  return half.transpose() * half;
}

/// W with W C W' = 1, but for directions of no variance.
MatrixXd calcWhitening(const MatrixXd& covariance) {
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(covariance);
  const double least = kRegular * eigen.values.maxCoeff();
  const VectorXd scale =
      eigen.values.unaryExpr([least](double value) { return value > least ? 1.0 / std::sqrt(value) : 0.0; });
  return scale.asDiagonal() * eigen.vectors.transpose();
}

}  // namespace

bool sufficeFor(Index variables, const network::Products& products, Index samples) {
  return kPerUnknown * (variables + products.count()) <= samples;
}

CanonicalInputs calcCanonicalInputs(const MatrixXd& inputs, const MatrixXd& points) {
  const auto n = static_cast<double>(inputs.cols());
  const MatrixXd whitening = calcWhitening(inputs * inputs.transpose() / n);
  const MatrixXd explained = calcExplained(makePolynomials(points), whitening * inputs);
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(explained);
  MatrixXd directions = eigen.vectors.rowwise().reverse();
  fixSigns(directions);
  return {directions.transpose() * whitening, eigen.values.reverse().cwiseMax(0.0).cwiseMin(1.0).cwiseSqrt()};
}

}  // namespace twinmap
