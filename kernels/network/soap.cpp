#include "kernels/network/soap.hpp"

#include <algorithm>
#include <numeric>

#include "kernels/linalg/decompositions.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap::network {
namespace {

/// Sorts a basis by what the products are in it, the largest first, then turns it towards the eigenvectors by
/// a step of orthogonal iteration. Returns the order.
std::vector<Index> iterateBasis(const MatrixXd& products, MatrixXd& basis) {
  const VectorXd estimates = basis.cwiseProduct(products * basis).colwise().sum().transpose();
  std::vector<Index> order =
      sortIndices(basis.cols(), [&](Index a, Index b) { return estimates[a] > estimates[b]; });
  const MatrixXd sorted = basis(Eigen::all, order);
  basis = linalg::calcOrthonormalBasis(products * sorted);
  return order;
}

/// Adam's step, bias corrected and clamped: `gradient` enters the means.
template <typename Values>
Values calcAdamUpdate(const Values& gradient, const SoapOptions& options, Values& mean, Values& square,
                      double& mean_decay, double& square_decay) {
  mean_decay *= options.momentum;
  square_decay *= options.second_moment;
  mean += (1.0 - options.momentum) * (gradient - mean);
  square += (1.0 - options.second_moment) * (gradient.cwiseAbs2() - square);
  const double of_mean = 1.0 / (1.0 - mean_decay), of_square = 1.0 / (1.0 - square_decay);
  return (of_mean * mean.array() / ((of_square * square.array()).sqrt() + options.smallest))
      .cwiseMax(-options.largest_update)
      .cwiseMin(options.largest_update);
}

}  // namespace

SoapMatrix::SoapMatrix(Index rows, Index cols, const SoapOptions& options)
    : options_(options), mean_(MatrixXd::Zero(rows, cols)), square_(MatrixXd::Zero(rows, cols)) {
  left_.turned = rows <= options.largest_side;
  right_.turned = cols <= options.largest_side;
}

void SoapMatrix::begin(const MatrixXd& gradient) {
  const double share = 1.0 - options_.second_moment;
  const auto set = [share](const MatrixXd& products, Side& side) {
    side.products = share * products;
    side.basis = linalg::calcSymmetricEigen(side.products).vectors.rowwise().reverse();
  };
  if (left_.turned) {
    set(gradient * gradient.transpose(), left_);
  }
  if (right_.turned) {
    set(gradient.transpose() * gradient, right_);
  }
}

void SoapMatrix::accumulate(const MatrixXd& gradient) {
  const double kept = options_.second_moment;
  if (left_.turned) {
    left_.products *= kept;
    left_.products.noalias() += ((1.0 - kept) * gradient) * gradient.transpose();
  }
  if (right_.turned) {
    right_.products *= kept;
    right_.products.noalias() += ((1.0 - kept) * gradient).transpose() * gradient;
  }
}

MatrixXd SoapMatrix::turn(const MatrixXd& matrix) const {
  const MatrixXd half = left_.turned ? MatrixXd(left_.basis.transpose() * matrix) : matrix;
  return right_.turned ? MatrixXd(half * right_.basis) : half;
}

MatrixXd SoapMatrix::turnBack(const MatrixXd& matrix) const {
  const MatrixXd half = left_.turned ? MatrixXd(left_.basis * matrix) : matrix;
  return right_.turned ? MatrixXd(half * right_.basis.transpose()) : half;
}

void SoapMatrix::updateBases() {
  const MatrixXd mean = turnBack(mean_);
  if (left_.turned) {
    square_ = MatrixXd(square_(iterateBasis(left_.products, left_.basis), Eigen::all));
  }
  if (right_.turned) {
    square_ = MatrixXd(square_(Eigen::all, iterateBasis(right_.products, right_.basis)));
  }
  mean_ = turn(mean);
}

void SoapMatrix::step(const MatrixXd& gradient, double learning_rate, MatrixXd& weights) {
  if (steps_++ == 0) {
    begin(gradient);
    return;
  }
  const MatrixXd update =
      calcAdamUpdate<MatrixXd>(turn(gradient), options_, mean_, square_, mean_decay_, square_decay_);
  weights -= learning_rate * turnBack(update);
  accumulate(gradient);
  if ((steps_ - 1) % options_.basis_interval == 0) {
    updateBases();
  }
}

AdamVector::AdamVector(Index size, const SoapOptions& options)
    : options_(options), mean_(VectorXd::Zero(size)), square_(VectorXd::Zero(size)) {}

void AdamVector::step(const VectorXd& gradient, double learning_rate, VectorXd& values) {
  if (!begun_) {
    begun_ = true;
    return;
  }
  values -= learning_rate *
            calcAdamUpdate<VectorXd>(gradient, options_, mean_, square_, mean_decay_, square_decay_);
}

}  // namespace twinmap::network
