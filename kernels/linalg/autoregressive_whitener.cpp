#include "kernels/linalg/autoregressive_whitener.hpp"

#include <cmath>

#include "kernels/linalg/autocorrelation.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// The last p values, the newest first (rows), one sample time later; columns are series.
void predict(const VectorXd& a, MatrixXd& state) {
  const Eigen::RowVectorXd next = a.transpose() * state;
  for (Index k = a.size() - 1; k > 0; --k) {
    state.row(k) = state.row(k - 1);
  }
  state.row(0) = next;
}

/// Their covariance one sample time later; `innovation`: variance of w.
void predictCovariance(const VectorXd& a, double innovation, MatrixXd& covariance) {
  predict(a, covariance);
  covariance.transposeInPlace();
  predict(a, covariance);
  covariance(0, 0) += innovation;
}

MatrixXd makeStationary(const VectorXd& autocorrelation, Index p) {
  return MatrixXd::NullaryExpr(p, p, [&](Index i, Index j) { return autocorrelation[std::abs(i - j)]; });
}

}  // namespace

VectorXd makeAutoregression(const VectorXd& partial_autocorrelations) {
  VectorXd a(0);
  for (const double reflection : partial_autocorrelations) {
    VectorXd longer(a.size() + 1);
    longer << a - reflection * a.reverse(), reflection;
    a = longer;
  }
  return a;
}

AutoregressiveWhitener::AutoregressiveWhitener(const VectorXd& autoregression, const std::vector<long>& lags)
    : a_(autoregression),
      lags_(lags),
      gains_(autoregression.size(), static_cast<Index>(lags.size())),
      inverse_stddev_(static_cast<Index>(lags.size())) {
  const Index p = a_.size();
  const VectorXd rho = calcAutocorrelation(std::vector<double>(a_.begin(), a_.end()), p);
  const double innovation = 1.0 - a_.dot(rho.tail(p));
  MatrixXd covariance = makeStationary(rho, p);
  for (Index i = 0; i < gains_.cols(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    for (long step = i == 0 ? 0 : lags_[k] - lags_[k - 1]; step > 0; --step) {
      predictCovariance(a_, innovation, covariance);
    }
    const double variance = covariance(0, 0);
    gains_.col(i) = covariance.col(0) / variance;
    inverse_stddev_[i] = 1.0 / std::sqrt(variance);
    log_determinant_ += std::log(variance);
    covariance -= variance * gains_.col(i) * gains_.col(i).transpose();
  }
}

void AutoregressiveWhitener::apply(MatrixXd& series) const {
  const Index p = a_.size();
  MatrixXd state = MatrixXd::Zero(series.rows(), p);  // the last p values, the newest first
  VectorXd next(series.rows());
  for (Index i = 0; i < series.cols(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    for (long step = i == 0 ? 0 : lags_[k] - lags_[k - 1]; step > 0; --step) {
      next.noalias() = state.lazyProduct(a_);
      for (Index lag = p - 1; lag > 0; --lag) {
        state.col(lag) = state.col(lag - 1);
      }
      state.col(0) = next;
    }
    series.col(i) -= state.col(0);
    for (Index lag = 0; lag < p; ++lag) {
      state.col(lag) += gains_(lag, i) * series.col(i);
    }
    series.col(i) *= inverse_stddev_[i];
  }
}

}  // namespace twinmap
