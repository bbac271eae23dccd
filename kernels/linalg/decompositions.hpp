#pragma once

#include <Eigen/Core>

/// Dense decompositions of matrices of any size, by Eigen's algorithms. Each is compiled here once: in every
/// translation unit that uses one, Eigen's templates would take 3 s (Cholesky) to 15 s (eigenvalues). So
/// nothing but kernels/linalg includes Eigen's headers of decompositions.
namespace twinmap::linalg {

/// A = V diag(values) V'.
struct SymmetricEigen {
  Eigen::VectorXd values;   ///< n, increasing
  Eigen::MatrixXd vectors;  ///< V, n x n, orthonormal columns
};

/// Eigenvalues and eigenvectors of a symmetric matrix (n x n, n > 0, finite), of which the lower triangle is
/// read, by tridiagonalisation and QR iterations. Cost: about 9 n^3 flops.
SymmetricEigen calcSymmetricEigen(const Eigen::MatrixXd& a);

/// The eigenvalues alone, increasing. Cost: about 4 n^3 / 3 flops.
Eigen::VectorXd calcSymmetricEigenvalues(const Eigen::MatrixXd& a);

/// Eigenvalues of a real square matrix (n x n, finite) in no order, by its real Schur form; complex ones in
/// conjugate pairs. Cost: about 10 n^3 flops.
Eigen::VectorXcd calcEigenvalues(const Eigen::MatrixXd& a);

/// A = L L' for a symmetric positive definite A.
struct Cholesky {
  Eigen::MatrixXd lower;            ///< L, n x n, zeros above the diagonal; incomplete if A is not
  bool positive_definite = false;   ///< up to rounding
  double reciprocal_condition = 0;  ///< estimate of 1 / (|A|_1 |A^-1|_1); 0 if A is not positive definite
};

/// Factorises a symmetric matrix (n x n), of which the lower triangle is read. Cost: n^3 / 3 flops, and some
/// 10 n^2 for the condition.
Cholesky calcCholesky(const Eigen::MatrixXd& a);

/// L^-1 B for a lower triangular L (n x n) and B (n x m). Cost: n^2 m flops.
Eigen::MatrixXd solveLower(const Eigen::MatrixXd& lower, const Eigen::MatrixXd& b);

/// (L L')^-1 B for a lower triangular L (n x n) and B (n x m). Cost: 2 n^2 m flops.
Eigen::MatrixXd solveCholesky(const Eigen::MatrixXd& lower, const Eigen::MatrixXd& b);

/// A^-1 for a symmetric positive definite A (n x n), of which the lower triangle is read; anything if it is
/// not positive definite. Cost: 7 n^3 / 3 flops.
Eigen::MatrixXd invertPositiveDefinite(const Eigen::MatrixXd& a);

/// A^-1 b for the same. Cost: n^3 / 3 flops.
Eigen::VectorXd solvePositiveDefinite(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// A solution of A X = B for a symmetric positive semi-definite A (n x n), of which the lower triangle is
/// read, and B (n x m) in its range, by A = P'L D L'P. Cost: n^3 / 3 + 2 n^2 m flops.
Eigen::MatrixXd solveSemidefinite(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// A^-1 b for a regular A (n x n), by LU factors with partial pivoting; not finite if A is singular.
/// Cost: 2 n^3 / 3 flops.
Eigen::VectorXd solveLinear(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// The determinant of a square matrix: sign exp(log_size).
struct LogDeterminant {
  double log_size = 0.0;
  double sign = 1.0;  ///< 0 if A is singular, of which log_size is -infinity
};

/// By LU factors with partial pivoting. Cost: 2 n^3 / 3 flops.
LogDeterminant calcLogDeterminant(const Eigen::MatrixXd& a);

/// The X (n x p) that minimises |A X - B|.
struct LinearFit {
  Eigen::MatrixXd coefficients;  ///< X; where A has not full rank, the one of least norm
  Eigen::Index rank = 0;         ///< of A, up to rounding
};

/// Linear least squares for A (m x n) and B (m x p) of any shape, by a complete orthogonal decomposition (QR
/// with pivoted columns). Cost: about 2 m n^2 flops for m >= n.
LinearFit fitLinear(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// fitLinear for one right side, without the rank.
Eigen::VectorXd solveMinimumNorm(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// Orthonormal columns (n x n) that span those of a square matrix one after another: Q of A = Q R, by
/// Householder's reflections. Cost: about 8 n^3 / 3 flops.
Eigen::MatrixXd calcOrthonormalBasis(const Eigen::MatrixXd& a);

}  // namespace twinmap::linalg
