#include "framework/estimation/posterior/noise/colour_fit.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "framework/estimation/levels.hpp"
#include "kernels/linalg/autoregressive_whitener.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kLargestTangent = 3.8;  // of a hyperbolic tangent: a partial autocorrelation of .999
constexpr double kWidest = 0.5;          // its spread where the likelihood is flat, towards 1

VectorXd toAutoregression(const VectorXd& at) {
  return makeAutoregression(at.array().tanh().matrix());
}

/// -2 log of the restricted likelihood, but for a summand: log |R| + log |X' R^-1 X| + (n - u) log r' R^-1 r
/// with the coefficients of X at their best. What X does not determine is left alone by a millionth of it.
double calcRestricted(const ResidualSeries& series, const VectorXd& at) {
  MatrixXd whitened(1 + series.regressors.cols(), series.residual.size());
  whitened << series.residual.transpose(), series.regressors.transpose();
  double log_determinant = 0.0;
  if (at.size() > 0) {
    const AutoregressiveWhitener whitener(toAutoregression(at), series.lags);
    whitener.apply(whitened);
    log_determinant = whitener.getLogDeterminant();
  }
  const Index u = series.regressors.cols();
  MatrixXd information = whitened.bottomRows(u) * whitened.bottomRows(u).transpose();
  information.diagonal() *= 1.0 + kRegular;
  information.diagonal().array() += std::numeric_limits<double>::min();
  const MatrixXd lower = linalg::calcCholesky(information).lower;
  const VectorXd explained = linalg::solveLower(lower, whitened.bottomRows(u) * whitened.row(0).transpose());
  const double squares = whitened.row(0).squaredNorm() - explained.squaredNorm();
  if (!(squares > 0.0)) {
    return std::numeric_limits<double>::infinity();
  }
  return log_determinant + 2.0 * lower.diagonal().array().log().sum() +
         static_cast<double>(series.residual.size() - u) * std::log(squares);
}

/// Half of it, less the log of the density that is uniform in partial autocorrelations.
double calcMisfit(const ResidualSeries& series, const VectorXd& at) {
  if (at.size() > 0 && at.cwiseAbs().maxCoeff() > kLargestTangent) {
    return std::numeric_limits<double>::infinity();
  }
  return 0.5 * calcRestricted(series, at) + 2.0 * at.array().cosh().log().sum();
}

/// Steps along the coordinates that halve where none helps, down to a part of what n samples leave open.
VectorXd minimize(const std::function<double(const VectorXd&)>& calc, VectorXd at, Index n) {
  double least = calc(at);
  for (double step = kWidest; step > kImmaterial / std::sqrt(static_cast<double>(n));) {
    bool moved = false;
    for (Index j = 0; j < at.size(); ++j) {
      for (const double side : {1.0, -1.0}) {
        VectorXd next = at;
        next[j] += side * step;
        if (const double there = calc(next); there < least) {
          least = there;
          at = next;
          moved = true;
          break;
        }
      }
    }
    step *= moved ? 1.0 : 0.5;
  }
  return at;
}

/// Central differences, from within kLargestTangent. A coefficient that n samples determine has a spread of
/// about 1 / sqrt(n).
MatrixXd calcHessian(const std::function<double(const VectorXd&)>& calc, const VectorXd& minimum, Index n) {
  const double step = 0.5 / std::sqrt(static_cast<double>(n)), largest = kLargestTangent - step;
  const VectorXd at = minimum.cwiseMin(largest).cwiseMax(-largest);
  const Index p = at.size();
  const auto move = [&](Index i, double by_i, Index j, double by_j) {
    VectorXd moved = at;
    moved[i] += by_i * step;
    moved[j] += by_j * step;
    return calc(moved);
  };
  MatrixXd hessian(p, p);
  const double middle = calc(at);
  for (Index i = 0; i < p; ++i) {
    hessian(i, i) = (move(i, 1, i, 0) + move(i, -1, i, 0) - 2.0 * middle) / (step * step);
    for (Index j = 0; j < i; ++j) {
      hessian(i, j) = hessian(j, i) =
          (move(i, 1, j, 1) - move(i, 1, j, -1) - move(i, -1, j, 1) + move(i, -1, j, -1)) /
          (4.0 * step * step);
    }
  }
  return hessian;
}

/// Nodes for a nearly normal density of unit width and their weights over that density: equidistant ones,
/// whose sum converges fastest there; of three coefficients Gauss's and Hermite's three, as their number is
/// cubed.
struct Quadrature {
  std::vector<double> nodes, log_weights;
};

Quadrature makeQuadrature(Index order) {
  if (order > 2) {
    const double far = std::sqrt(3.0);
    return {{-far, 0.0, far}, {std::log(1.0 / 6.0) + 1.5, std::log(2.0 / 3.0), std::log(1.0 / 6.0) + 1.5}};
  }
  const int each_side = order == 1 ? 5 : 3;
  constexpr double kFarthest = 3.75;
  Quadrature quadrature;
  for (int i = -each_side; i <= each_side; ++i) {
    quadrature.nodes.push_back(kFarthest * i / each_side);
    quadrature.log_weights.push_back(0.0);
  }
  return quadrature;
}

/// How far the misfit's minimum reaches along a direction, in standard deviations of a normal density that is
/// as low there: towards an autocorrelation of 1 it is wider than its curvature says.
double calcReach(const std::function<double(const VectorXd&)>& calc, const VectorXd& at, const VectorXd& way,
                 double stddev) {
  constexpr double kDeviations = 2.5, kStep = 1.25, kLongest = 6.0;
  const double limit = calc(at) + 0.5 * kDeviations * kDeviations;
  double reach = kDeviations / kStep;
  while (reach < kDeviations * kLongest && calc(at + kStep * reach * stddev * way) < limit) {
    reach *= kStep;
  }
  return stddev * reach / kDeviations;
}

/// Nodes along the principal directions of a normal density, each side with a width of its own.
std::vector<NoiseColour> makeNodes(const std::function<double(const VectorXd&)>& calc, const VectorXd& at,
                                   const MatrixXd& hessian) {
  const Index p = at.size();
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(hessian);
  MatrixXd reaches(p, 2);
  for (Index j = 0; j < p; ++j) {
    const double value = eigen.values[j];
    const double stddev = value > 0.0 ? std::min(1.0 / std::sqrt(value), kWidest) : kWidest;
    reaches(j, 0) = calcReach(calc, at, -eigen.vectors.col(j), stddev);
    reaches(j, 1) = calcReach(calc, at, eigen.vectors.col(j), stddev);
  }
  const Quadrature one = makeQuadrature(p);
  const auto count = static_cast<Index>(one.nodes.size());
  std::vector<NoiseColour> colours;
  for (Index node = 0; node < static_cast<Index>(std::lround(std::pow(count, p))); ++node) {
    VectorXd point = at;
    double log_weight = 0.0;
    for (Index j = 0, rest = node; j < p; ++j, rest /= count) {
      const auto k = static_cast<std::size_t>(rest % count);
      const double z = one.nodes[k];
      const double reach = z == 0.0 ? reaches.row(j).mean() : reaches(j, z > 0.0 ? 1 : 0);
      point += z * reach * eigen.vectors.col(j);
      log_weight += one.log_weights[k] + std::log(reach);
    }
    if (point.cwiseAbs().maxCoeff() <= kLargestTangent) {
      colours.push_back({toAutoregression(point), log_weight - 2.0 * point.array().cosh().log().sum()});
    }
  }
  return colours;
}

}  // namespace

std::vector<NoiseColour> fitColours(const ResidualSeries& series) {
  const Index n = series.residual.size();
  if (n < series.regressors.cols() + 2 * kMaxOrder || series.lags.empty()) {
    return {};
  }
  const auto calc = [&](const VectorXd& at) { return calcMisfit(series, at); };
  const double per_coefficient = std::log(static_cast<double>(n));
  double least = calcRestricted(series, {});
  VectorXd best(0), from(0);
  for (Index p = 1; p <= kMaxOrder; ++p) {
    from.conservativeResize(p);
    from[p - 1] = 0.0;
    from = minimize(calc, from, n);
    const double information = calcRestricted(series, from) + per_coefficient * static_cast<double>(p);
    if (information < least) {
      least = information;
      best = from;
    }
  }
  return best.size() == 0 ? std::vector<NoiseColour>{} : makeNodes(calc, best, calcHessian(calc, best, n));
}

}  // namespace twinmap
