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

/// The loss of one sample, and its derivatives where `gradient` is not null.
class SampleLoss {
 public:
  SampleLoss(Index targets, Index outputs)
      : targets_(targets),
        components_(countComponents(targets, outputs)),
        sample_{Eigen::ArrayXd(targets), Eigen::ArrayXd(targets)},
        weights_(components_),
        shares_(components_) {}

  double calculate(const double* head, const double* target, double* gradient) {
    return components_ == 1 ? calcNormal(head, target, gradient) : calcMixture(head, target, gradient);
  }

 private:
  double calcNormal(const double* head, const double* target, double* gradient) {
    standardise(head, target, sample_);
    if (gradient != nullptr) {
      calcGradientOf(head, sample_, gradient);
    }
    return calcLossOf(head, sample_);
  }

  double calcMixture(const double* head, const double* target, double* gradient) {
    calcWeights(Eigen::Map<const VectorXd>(head, components_), weights_);
    for (Index c = 0; c < components_; ++c) {
      const Index first = getComponentRow(targets_, components_, c);
      shares_[c] =
          std::log(weights_[c]) - calcNormal(head + first, target, gradient ? gradient + first : nullptr);
    }
    const double largest = shares_.maxCoeff();
    const double sum = (shares_.array() - largest).exp().sum();
    if (gradient != nullptr) {
      shares_ = (shares_.array() - largest).exp() / sum;  // of the density at the target
      for (Index c = 0; c < components_; ++c) {
        gradient[c] = weights_[c] - shares_[c];
        Eigen::Map<VectorXd>(gradient + getComponentRow(targets_, components_, c),
                             countNormalOutputs(targets_)) *= shares_[c];
      }
    }
    return -(largest + std::log(sum));
  }

  Index targets_, components_;
  Standardised sample_;
  VectorXd weights_, shares_;
};

/// `inverse`: a buffer, at least as wide as the covariance; becomes (1 + A)'^-1 D^-1 and ones beside it.
template <class Square>
void calcCovariance(const Ref<const VectorXd>& head, Square& inverse, Ref<MatrixXd> covariance) {
  const Index p = covariance.rows();
  inverse.setIdentity();
  for (Index j = 1; j < p; ++j) {
    for (Index i = 0; i < j; ++i) {
      inverse.col(j) -= head[getTriangleRow(p, j, i)] * inverse.col(i);
    }
  }
  for (Index i = 0; i < p; ++i) {
    inverse.row(i) *= std::exp(-head[p + i]);
  }
  covariance = inverse.lazyProduct(inverse.transpose()).topLeftCorner(p, p);
  // packets of columns and what is left beside them round differently
  covariance.triangularView<Eigen::StrictlyLower>() = covariance.transpose();
}

}  // namespace

double calcLoss(const Ref<const MatrixXd>& head, const Ref<const MatrixXd>& targets, Ref<MatrixXd> gradient) {
  SampleLoss sample(targets.rows(), head.rows());
  double loss = 0.0;
  for (Index column = 0; column < targets.cols(); ++column) {
    loss +=
        sample.calculate(head.col(column).data(), targets.col(column).data(), gradient.col(column).data());
  }
  return loss;
}

double calcLoss(const Ref<const MatrixXd>& head, const Ref<const MatrixXd>& targets) {
  SampleLoss sample(targets.rows(), head.rows());
  double loss = 0.0;
  for (Index column = 0; column < targets.cols(); ++column) {
    loss += sample.calculate(head.col(column).data(), targets.col(column).data(), nullptr);
  }
  return loss;
}

MatrixXd calcPrecision(const Ref<const VectorXd>& head, Index targets) {
  MatrixXd factor = MatrixXd::Identity(targets, targets);
  for (Index j = 0; j < targets; ++j) {
    for (Index i = 0; i < j; ++i) {
      factor(j, i) = head[getTriangleRow(targets, j, i)];
    }
    factor.row(j) *= std::exp(head[targets + j]);
  }
  return factor * factor.transpose();
}

void calcWeights(const Ref<const VectorXd>& logarithms, Ref<VectorXd> weights) {
  weights = (logarithms.array() - logarithms.maxCoeff()).exp();
  weights /= weights.sum();
}

MatrixXd sumMeanRows(const Ref<const MatrixXd>& gradient, Index targets) {
  const Index components = countComponents(targets, gradient.rows());
  MatrixXd sum = gradient.middleRows(getComponentRow(targets, components, 0), targets);
  for (Index c = 1; c < components; ++c) {
    sum += gradient.middleRows(getComponentRow(targets, components, c), targets);
  }
  return sum;
}

void calcMoments(const Ref<const VectorXd>& head, Ref<VectorXd> mean, Ref<MatrixXd> covariance,
                 Ref<MatrixXd> inverse) {
  const Index p = mean.size();
  mean = head.head(p);
  // columns whose length the compiler knows take a third of the time
  if (p <= 4) {
    Eigen::Matrix4d small;
    calcCovariance(head, small, covariance);
  } else if (p <= 8) {
    Eigen::Matrix<double, 8, 8> small;
    calcCovariance(head, small, covariance);
  } else {
    calcCovariance(head, inverse, covariance);
  }
}

}  // namespace twinmap::network
