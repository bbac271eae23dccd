#include "kernels/linalg/autocorrelation.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// rho_k = sum_i a_i rho_|k-i|, k = 1 .. p, with rho_0 = 1.
VectorXd solveYuleWalker(const VectorXd& a) {
  const Index p = a.size();
  MatrixXd system = MatrixXd::Identity(p, p);
  VectorXd right = VectorXd::Zero(p);
  for (Index k = 1; k <= p; ++k) {
    for (Index i = 1; i <= p; ++i) {
      const Index lag = std::abs(k - i);
      (lag == 0 ? right[k - 1] : system(k - 1, lag - 1)) += lag == 0 ? a[i - 1] : -a[i - 1];
    }
  }
  return linalg::solveLinear(system, right);
}

}  // namespace

bool isStationary(const std::vector<double>& autoregression) {
  VectorXd a = Eigen::Map<const VectorXd>(autoregression.data(), Index(autoregression.size()));
  for (Index p = a.size(); p > 0; --p) {
    const double reflection = a[p - 1];
    if (!(std::abs(reflection) < 1.0)) {
      return false;
    }
    const VectorXd shorter = a.head(p - 1);
    a = (shorter + reflection * shorter.reverse()) / (1.0 - reflection * reflection);
  }
  return true;
}

VectorXd calcAutocorrelation(const std::vector<double>& autoregression, Index lags) {
  const auto p = static_cast<Index>(autoregression.size());
  const Eigen::Map<const VectorXd> a(autoregression.data(), p);
  VectorXd rho(std::max(lags, p) + 1);
  rho[0] = 1.0;
  rho.segment(1, p) = solveYuleWalker(a);
  for (Index k = p + 1; k <= lags; ++k) {
    rho[k] = a.dot(rho.segment(k - p, p).reverse());
  }
  return rho.head(lags + 1);
}

bool isPositiveDefinite(const VectorXd& autocorrelation) {
  VectorXd a(0);
  double error = autocorrelation[0];
  for (Index p = 1; p < autocorrelation.size() && error > 0.0; ++p) {
    const double reflection =
        (autocorrelation[p] - a.dot(autocorrelation.segment(1, p - 1).reverse())) / error;
    VectorXd longer(p);
    longer << a - reflection * a.reverse(), reflection;
    a = longer;
    error *= 1.0 - reflection * reflection;
  }
  return error > 0.0;
}

std::vector<long> findLags(const std::vector<double>& times, double sample_time) {
  constexpr double kTolerance = 1e-6;  // of sample_time, far above the rounding of times
  std::vector<long> lags;
  for (const double time : times) {
    const double steps = (time - times.front()) / sample_time;
    lags.push_back(std::lround(steps));
    if (std::abs(steps - static_cast<double>(lags.back())) > kTolerance * std::max(1.0, steps)) {
      return {};
    }
  }
  return lags;
}

}  // namespace twinmap
