#include "kernels/surrogate/local_variance.hpp"

#include <algorithm>
#include <numeric>

namespace twinmap::gp {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;

namespace {

constexpr Index kNeighbours = 20;  // with more, no error was foretold better
using Local = Eigen::Matrix<double, kNeighbours, kNeighbours>;

/// The nearest points come first.
void sortNearest(const ArrayXd& squares, Index but, std::vector<Index>& order) {
  order.resize(static_cast<std::size_t>(squares.size()));
  std::iota(order.begin(), order.end(), Index{0});
  if (but >= 0) {
    order.erase(order.begin() + but);
  }
  const auto reach = std::min<std::ptrdiff_t>(kNeighbours, static_cast<std::ptrdiff_t>(order.size()));
  const auto nearer = [&](Index a, Index b) {
    return squares[a] < squares[b] || (squares[a] == squares[b] && a < b);
  };
  std::nth_element(order.begin(), order.begin() + (reach - 1), order.end(), nearer);
  std::sort(order.begin(), order.begin() + reach, nearer);
}

/// What of the variance of a value is explained by others: v' K^-1 v, in place. A pivot below `least` is
/// rounding: its point says nothing that those before have not said.
double explain(Index count, double least, Local& covariance, Eigen::Matrix<double, kNeighbours, 1>& cross) {
  double explained = 0.0;
  for (Index k = 0; k < count; ++k) {
    const double pivot = covariance(k, k);
    if (pivot <= least) {
      continue;
    }
    const Index rest = count - k - 1;
    const double factor = cross(k) / pivot;
    explained += factor * cross(k);
    const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kNeighbours, 1> column =
        covariance.col(k).segment(k + 1, rest);
    cross.segment(k + 1, rest) -= factor * column;
    for (Index j = 0; j < rest; ++j) {
      covariance.col(k + 1 + j).segment(k + 1 + j, rest - j) -= (column(j) / pivot) * column.tail(rest - j);
    }
  }
  return explained;
}

}  // namespace

double LocalVariance::calc(const MatrixXd& scaled_points, const ArrayXd& squares, const ArrayXd& covariances,
                           Index but, Workspace& workspace) const {
  constexpr double kLeast = 1e-13;
  sortNearest(squares, but, workspace.order);
  const Index count = std::min<Index>(kNeighbours, static_cast<Index>(workspace.order.size()));
  workspace.values.setZero(count * (count - 1) / 2);
  workspace.slopes.resize(workspace.values.size());
  for (Index v = 0; v < scaled_points.cols(); ++v) {
    for (Index j = 0, at = 0; j < count; ++j) {
      const double x = scaled_points(workspace.order[static_cast<std::size_t>(j)], v);
      for (Index i = j + 1; i < count; ++i, ++at) {
        const double apart = scaled_points(workspace.order[static_cast<std::size_t>(i)], v) - x;
        workspace.values(at) += apart * apart;
      }
    }
  }
  calcSmoothCovariance(covariance_, workspace.values, workspace.slopes);
  Local covariance;
  Eigen::Matrix<double, kNeighbours, 1> cross;
  for (Index j = 0, at = 0; j < count; ++j) {
    covariance(j, j) = 1.0 + nugget_;
    cross(j) = covariances(workspace.order[static_cast<std::size_t>(j)]);
    for (Index i = j + 1; i < count; ++i, ++at) {
      covariance(i, j) = workspace.values(at);
    }
  }
  return std::max(1.0 - explain(count, kLeast, covariance, cross), kLeast) + nugget_;
}

}  // namespace twinmap::gp
