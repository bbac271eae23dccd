#pragma once

#include <Eigen/Core>

#include "kernels/linalg/view.hpp"

namespace twinmap::linalg {

/// A lower triangular matrix laid out for one forward solve after another: square tiles of kTile, row of
/// tiles by row of tiles, each tile column-major, in the order in which the solve reads them; the tiles on
/// the diagonal hold their inverse. One solve then streams the factor once, with the sums in registers.
class PackedLower {
 public:
  static constexpr Index kTile = 32;

  PackedLower() = default;
  /// lower: n x n, nonzero diagonal; only its lower triangle is read. Cost: n^2 copies.
  explicit PackedLower(ConstView lower);

  /// All that the matrix consists of, for storage, and the matrix from it, bit for bit. Throws
  /// std::invalid_argument for a size that is none of whole tiles.
  const Eigen::VectorXd& getTiles() const { return tiles_; }
  static PackedLower fromTiles(Eigen::VectorXd tiles);

  /// n in whole tiles.
  static constexpr Index roundUp(Index n) { return (n + kTile - 1) / kTile * kTile; }

  /// How many numbers getTiles() has for n rows.
  static constexpr Index countTiles(Index n) {
    const Index blocks = roundUp(n) / kTile;
    return blocks * (blocks + 1) / 2 * kTile * kTile;
  }

  /// n rounded up to whole tiles.
  Index paddedSize() const { return blocks_ * kTile; }

  /// x = L^-1 x, where x has paddedSize() entries; those beyond n must be and remain zero.
  /// Cost: n^2 flops; reads 4 n^2 bytes.
  void solve(double* x) const;

  /// The same for each column of x (paddedSize() rows), with the same bits; the factor is read once for all.
  void solve(Eigen::MatrixXd& x) const;

 private:
  Index blocks_ = 0;
  Eigen::VectorXd tiles_;
};

/// Inputs laid out for distances to one point after another: samples in chunks of kChunk, feature by feature
/// within a chunk.
class PackedSamples {
 public:
  static constexpr Index kChunk = 32;

  PackedSamples() = default;
  /// samples: d x n. Samples beyond n, up to a whole chunk, are zero.
  explicit PackedSamples(const Eigen::MatrixXd& samples);

  Index paddedSize() const { return chunks_ * kChunk; }

  /// The samples as they are laid out: paddedSize() times features.
  const Eigen::VectorXd& getValues() const { return values_; }

  /// Distances under several weightings at once:
  ///   squares(i, t) = sum over features f of weights(t, f) (sample_fi - point_f)^2,   t < kWeightings,
  /// with weights column-major (kWeightings x d) and squares' columns paddedSize() apart.
  /// Cost: 2 n d (1 + kWeightings) flops; kWeightings is 1 or 4.
  template <int kWeightings>
  void weightedDistances(const double* point, const double* weights, double* squares) const;

  /// values(i) += sum over features of sample_fi weights_f. Cost: 2 n d.
  void addProduct(const double* weights, double* values) const;

  /// values_f += sum over samples of sample_fi weights(i), with paddedSize() weights. Cost: 2 n d.
  void addTransposedProduct(const double* weights, double* values) const;

 private:
  Index features_ = 0;
  Index chunks_ = 0;
  Eigen::VectorXd values_;
};

/// The lower triangle (n x n) alone, column by column: n (n + 1) / 2 numbers, as kernels/exact has it.
Eigen::VectorXd packColumns(const Eigen::MatrixXd& lower);

}  // namespace twinmap::linalg
