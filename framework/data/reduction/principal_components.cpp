#include "framework/data/reduction/principal_components.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Index countKept(const PrincipalComponentsSpec& spec, const PrincipalComponents& components, Index samples) {
  const Index most = components.variances.size();
  if (spec.components.number) {
    if (*spec.components.number > most) {
      throw std::invalid_argument(
          fmt::format("principal_components: asked for {} of {}", *spec.components.number, most));
    }
    return *spec.components.number;
  }
  const double edge = calcMarchenkoPasturEdge(components.directions.rows(), samples);
  const double total = components.variances.sum();
  double explained = 0.0;
  Index rank = 0;
  while (rank < most && (spec.explained_variance ? explained < *spec.explained_variance * total
                                                 : components.variances[rank] > edge)) {
    explained += components.variances[rank];
    ++rank;
  }
  return std::max<Index>(rank, 1);
}

}  // namespace

PrincipalComponents calcPrincipalComponents(const MatrixXd& centered) {
  const bool tall = centered.rows() > centered.cols();
  const double degrees_of_freedom = static_cast<double>(centered.cols()) - 1.0;
  const MatrixXd products =
      tall ? MatrixXd(centered.transpose() * centered) : MatrixXd(centered * centered.transpose());
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(products / degrees_of_freedom);
  PrincipalComponents components;
  components.variances = eigen.values.reverse().cwiseMax(0.0);
  components.directions = eigen.vectors.rowwise().reverse();
  if (tall) {
    components.directions = centered * components.directions;
    components.directions.colwise().normalize();
  }
  fixSigns(components.directions);
  return components;
}

void fixSigns(MatrixXd& directions) {
  for (Index k = 0; k < directions.cols(); ++k) {
    Index largest = 0;
    directions.col(k).cwiseAbs().maxCoeff(&largest);
    if (directions(largest, k) < 0.0) {
      directions.col(k) *= -1.0;
    }
  }
}

double calcMarchenkoPasturEdge(Index dimensions, Index samples) {
  const double ratio = static_cast<double>(dimensions) / static_cast<double>(samples);
  return std::pow(1.0 + std::sqrt(ratio), 2);
}

AffineStep fitPrincipalComponents(const PrincipalComponentsSpec& spec, const MatrixXd& features) {
  const VectorXd mean = features.rowwise().mean();
  const PrincipalComponents components = calcPrincipalComponents(features.colwise() - mean);
  const Index rank = countKept(spec, components, features.cols());
  return makeProjection(mean, components.directions.leftCols(rank).transpose());
}

}  // namespace twinmap
