#include "framework/estimation/posterior/colour_fit.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "kernels/linalg/autoregressive_whitener.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr Index kMaxOrder = 3;
constexpr double kLargestTangent = 3.8;  // of a hyperbolic tangent: a partial autocorrelation of .999

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
  constexpr double kRelative = 1e-12;
  const Index u = series.regressors.cols();
  MatrixXd information = whitened.bottomRows(u) * whitened.bottomRows(u).transpose();
  information.diagonal() *= 1.0 + kRelative;
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

/// Steps along the coordinates that halve where none helps.
VectorXd minimize(const std::function<double(const VectorXd&)>& calc, VectorXd at) {
  constexpr double kFirst = 0.4, kLast = 0.01;
  double least = calc(at);
  for (double step = kFirst; step > kLast;) {
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

/// Central differences. A coefficient that n samples determine has a spread of about 1 / sqrt(n).
MatrixXd calcHessian(const std::function<double(const VectorXd&)>& calc, const VectorXd& at, Index n) {
  const double step = 0.5 / std::sqrt(static_cast<double>(n));
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

/// Nodes and weights of Gauss and Hermite for a standard normal density (Abramowitz and Stegun, table 25.10,
/// times sqrt 2 and over sqrt pi).
struct Quadrature {
  std::vector<double> nodes, weights;
};

Quadrature makeQuadrature(Index order) {
  if (order == 1) {
    return {{-3.7504397177257425, -2.3667594107345415, -1.1544053947399682, 0.0, 1.1544053947399682,
             2.3667594107345415, 3.7504397177257425},
            {0.000548268855972219, 0.0307571239675865, 0.2401231786050127, 0.4571428571428571,
             0.2401231786050127, 0.0307571239675865, 0.000548268855972219}};
  }
  if (order == 2) {
    return {
        {-2.8569700138728056, -1.3556261799742659, 0.0, 1.3556261799742659, 2.8569700138728056},
        {0.0112574113277207, 0.2220759220056126, 0.5333333333333333, 0.2220759220056126, 0.0112574113277207}};
  }
  return {{-1.7320508075688772, 0.0, 1.7320508075688772}, {1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0}};
}

std::vector<NoiseColour> makeNodes(const VectorXd& at, const MatrixXd& hessian) {
  const Index p = at.size();
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(hessian);
  constexpr double kWidest = 0.5;  // where the likelihood is flat, towards 1
  const VectorXd spread =
      eigen.values.unaryExpr([](double value) { return value > 0.0 ? 1.0 / std::sqrt(value) : kWidest; })
          .cwiseMin(kWidest);
  const Quadrature one = makeQuadrature(p);
  const auto count = static_cast<Index>(one.nodes.size());
  std::vector<NoiseColour> colours;
  for (Index node = 0; node < static_cast<Index>(std::lround(std::pow(count, p))); ++node) {
    VectorXd z(p);
    double log_weight = 0.0;
    for (Index j = 0, rest = node; j < p; ++j, rest /= count) {
      const auto k = static_cast<std::size_t>(rest % count);
      z[j] = one.nodes[k];
      log_weight += std::log(one.weights[k]) + 0.5 * z[j] * z[j];
    }
    const VectorXd point = at + eigen.vectors * spread.cwiseProduct(z);
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
    from = minimize(calc, from);
    const double information = calcRestricted(series, from) + per_coefficient * static_cast<double>(p);
    if (information < least) {
      least = information;
      best = from;
    }
  }
  return best.size() == 0 ? std::vector<NoiseColour>{} : makeNodes(best, calcHessian(calc, best, n));
}

}  // namespace twinmap
