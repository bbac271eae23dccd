#include "kernels/network/density.hpp"

#include <algorithm>
#include <cmath>

namespace twinmap::network {
namespace {

constexpr double kHalfLogTwoPi = 0.9189385332046727;

double calcPenalty(double residual) {
  const double size = std::abs(residual);
  return size <= kLargestResidual ? 0.5 * size * size : kLargestResidual * (size - 0.5 * kLargestResidual);
}

/// u = D (t - m) and r = (1 + A)' u of one sample.
struct Standardised {
  Eigen::ArrayXd scaled, residual;
};

void standardise(const double* head, const double* target, Standardised& sample) {
  const Index p = sample.scaled.size();
  for (Index j = 0; j < p; ++j) {
    sample.scaled[j] = std::exp(head[p + j]) * (target[j] - head[j]);
  }
  for (Index i = 0; i < p; ++i) {
    double sum = sample.scaled[i];
    for (Index j = i + 1; j < p; ++j) {
      sum += head[getTriangleRow(p, j, i)] * sample.scaled[j];
    }
    sample.residual[i] = sum;
  }
}

double calcLossOf(const double* head, const Standardised& sample) {
  const Index p = sample.scaled.size();
  double loss = static_cast<double>(p) * kHalfLogTwoPi;
  for (Index i = 0; i < p; ++i) {
    loss += calcPenalty(sample.residual[i]) - head[p + i];
  }
  return loss;
}

/// The derivative of the penalty is the clamped residual.
void calcGradientOf(const double* head, const Standardised& sample, double* gradient) {
  const Index p = sample.scaled.size();
  const auto slope = [&](Index i) {
    return std::clamp(sample.residual[i], -kLargestResidual, kLargestResidual);
  };
  for (Index j = 0; j < p; ++j) {
    double of_scaled = slope(j);
    for (Index i = 0; i < j; ++i) {
      const Index row = getTriangleRow(p, j, i);
      of_scaled += head[row] * slope(i);
      gradient[row] = sample.scaled[j] * slope(i);
    }
    gradient[j] = -of_scaled * std::exp(head[p + j]);
    gradient[p + j] = of_scaled * sample.scaled[j] - 1.0;
  }
}

}  // namespace

double calcLoss(const Ref<const MatrixXd>& head, const Ref<const MatrixXd>& targets, Ref<MatrixXd> gradient) {
  Standardised sample{Eigen::ArrayXd(targets.rows()), Eigen::ArrayXd(targets.rows())};
  double loss = 0.0;
  for (Index column = 0; column < targets.cols(); ++column) {
    standardise(head.col(column).data(), targets.col(column).data(), sample);
    loss += calcLossOf(head.col(column).data(), sample);
    calcGradientOf(head.col(column).data(), sample, gradient.col(column).data());
  }
  return loss;
}

double calcLoss(const Ref<const MatrixXd>& head, const Ref<const MatrixXd>& targets) {
  Standardised sample{Eigen::ArrayXd(targets.rows()), Eigen::ArrayXd(targets.rows())};
  double loss = 0.0;
  for (Index column = 0; column < targets.cols(); ++column) {
    standardise(head.col(column).data(), targets.col(column).data(), sample);
    loss += calcLossOf(head.col(column).data(), sample);
  }
  return loss;
}

void calcMoments(const Ref<const VectorXd>& head, Ref<VectorXd> mean, Ref<MatrixXd> covariance,
                 Ref<MatrixXd> inverse) {
  const Index p = mean.size();
  mean = head.head(p);
  inverse.setIdentity();  // becomes (1 + A)^-1, row by row
  for (Index j = 1; j < p; ++j) {
    for (Index i = 0; i < j; ++i) {
      double sum = 0.0;
      for (Index between = i; between < j; ++between) {
        sum += head[getTriangleRow(p, j, between)] * inverse(between, i);
      }
      inverse(j, i) = -sum;
    }
  }
  for (Index i = 0; i < p; ++i) {
    inverse.col(i) *= std::exp(-head[p + i]);
  }
  for (Index i = 0; i < p; ++i) {
    for (Index j = 0; j <= i; ++j) {
      covariance(i, j) = inverse.col(i).tail(p - i).dot(inverse.col(j).tail(p - i));
      covariance(j, i) = covariance(i, j);
    }
  }
}

}  // namespace twinmap::network
