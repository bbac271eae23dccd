#pragma once

#include "kernels/network/network.hpp"

namespace twinmap::network {

struct SoapOptions {
  double momentum = 0.95;       ///< of the gradient's mean
  double second_moment = 0.95;  ///< of its squares, and of both sides' products; the published pair
  double smallest = 1e-8;       ///< added to the root of the squares
  double largest_update = 2.0;  ///< a preconditioned update is clamped to: where a square is still unknown
  int basis_interval = 10;      ///< steps between two updates of the eigenbases
  Index largest_side = 512;     ///< a longer side is not turned: its basis would cost more than it brings
};

/// Adam in the eigenbasis of Shampoo's preconditioner (SOAP; Vyas et al. 2024) for one matrix of weights W
/// with gradients G: of running means L of G G' and R of G'G the eigenvectors Q_L and Q_R turn the gradient
/// to Q_L' G Q_R, of which Adam takes a step that is turned back. Bases begin with the eigenvectors of the
/// first gradient's products, which is used for nothing else, and follow by one step of QR iteration now and
/// then, sorted by what the products are in them. The mean of the gradient is kept turned.
class SoapMatrix {
 public:
  SoapMatrix(Index rows, Index cols, const SoapOptions& options);

  /// One step. Cost: 8 flops an entry and side for each row or column, and every basis_interval steps some 10
  /// n^3 for a side of n.
  void step(const MatrixXd& gradient, double learning_rate, MatrixXd& weights);

 private:
  struct Side {
    bool turned = true;
    MatrixXd products, basis;
  };
  void accumulate(const MatrixXd& gradient);
  void begin(const MatrixXd& gradient);
  void updateBases();
  MatrixXd turn(const MatrixXd& matrix) const;
  MatrixXd turnBack(const MatrixXd& matrix) const;

  SoapOptions options_;
  Side left_, right_;
  MatrixXd mean_, square_;
  int steps_ = 0;
  double mean_decay_ = 1.0, square_decay_ = 1.0;
};

/// Adam (Kingma and Ba 2015) for a vector, with the same options; it too skips the first gradient.
class AdamVector {
 public:
  AdamVector(Index size, const SoapOptions& options);
  void step(const VectorXd& gradient, double learning_rate, VectorXd& values);

 private:
  SoapOptions options_;
  VectorXd mean_, square_;
  bool begun_ = false;
  double mean_decay_ = 1.0, square_decay_ = 1.0;
};

}  // namespace twinmap::network
