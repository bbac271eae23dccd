#include "kernels/linalg/packed_lower.hpp"

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <utility>

#include "kernels/linalg/packet.hpp"
#include "kernels/linalg/triangular.hpp"

namespace twinmap::linalg {
namespace {

constexpr Index kTile = PackedLower::kTile;
constexpr Index kTileElements = kTile * kTile;
constexpr Index kVectors = kTile / kLanes;

struct Rows {
  Packet part[kVectors];
};

inline Rows loadRows(const double* source) {
  Rows rows;
  for (Index v = 0; v < kVectors; ++v) {
    rows.part[v] = load(source + v * kLanes);
  }
  return rows;
}

inline void storeRows(double* target, const Rows& rows) {
  for (Index v = 0; v < kVectors; ++v) {
    store(target + v * kLanes, rows.part[v]);
  }
}

// sum -= tile x
inline void subtractProduct(const double* tile, const double* x, Rows& sum) {
  for (Index j = 0; j < kTile; ++j, tile += kTile) {
    for (Index v = 0; v < kVectors; ++v) {
      sum.part[v] -= load(tile + v * kLanes) * x[j];
    }
  }
}

// x = (inverse tile) right
inline void solveTile(const double* inverse, const Rows& right, double* x) {
  double held[kTile];
  storeRows(held, right);
  Rows negative = {};
  subtractProduct(inverse, held, negative);
  for (Index v = 0; v < kVectors; ++v) {
    negative.part[v] = -negative.part[v];
  }
  storeRows(x, negative);
}

// The tile's inverse, padded with zeros.
void storeInverse(ConstView block, double* tile, TriangularScratch& scratch) {
  for (Index j = 0; j < block.cols; ++j) {
    for (Index i = j; i < block.rows; ++i) {
      tile[i + j * kTile] = block(i, j);
    }
  }
  invertLower({tile, block.rows, block.cols, kTile}, scratch);
}

}  // namespace

PackedLower::PackedLower(ConstView lower)
    : blocks_((lower.rows + kTile - 1) / kTile),
      tiles_(Eigen::VectorXd::Zero(blocks_ * (blocks_ + 1) / 2 * kTileElements)) {
  TriangularScratch scratch(kTile);
  double* tile = tiles_.data();
  for (Index r = 0; r < lower.rows; r += kTile) {
    const Index rows = std::min(kTile, lower.rows - r);
    for (Index c = 0; c < r; c += kTile, tile += kTileElements) {
      for (Index j = 0; j < kTile; ++j) {
        for (Index i = 0; i < rows; ++i) {
          tile[i + j * kTile] = lower(r + i, c + j);
        }
      }
    }
    storeInverse(lower.block(r, r, rows, rows), tile, scratch);
    tile += kTileElements;
  }
}

PackedLower PackedLower::fromTiles(Eigen::VectorXd tiles) {
  PackedLower packed;
  while (packed.blocks_ * (packed.blocks_ + 1) / 2 * kTileElements < tiles.size()) {
    ++packed.blocks_;
  }
  if (packed.blocks_ * (packed.blocks_ + 1) / 2 * kTileElements != tiles.size()) {
    throw std::invalid_argument("PackedLower: tiles of another size");
  }
  packed.tiles_ = std::move(tiles);
  return packed;
}

void PackedLower::solve(double* x) const {
  const double* tile = tiles_.data();
  for (Index r = 0; r < blocks_; ++r) {
    Rows sum = loadRows(x + r * kTile);
    for (Index c = 0; c < r; ++c, tile += kTileElements) {
      subtractProduct(tile, x + c * kTile, sum);
    }
    solveTile(tile, sum, x + r * kTile);
    tile += kTileElements;
  }
}

void PackedLower::solve(Eigen::MatrixXd& x) const {
  assert(x.rows() == paddedSize());
  const double* tile = tiles_.data();
  for (Index r = 0; r < blocks_; ++r) {
    for (Index c = 0; c < r; ++c, tile += kTileElements) {
      for (Index k = 0; k < x.cols(); ++k) {
        Rows sum = loadRows(&x(r * kTile, k));
        subtractProduct(tile, &x(c * kTile, k), sum);
        storeRows(&x(r * kTile, k), sum);
      }
    }
    for (Index k = 0; k < x.cols(); ++k) {
      solveTile(tile, loadRows(&x(r * kTile, k)), &x(r * kTile, k));
    }
    tile += kTileElements;
  }
}

PackedSamples::PackedSamples(const Eigen::MatrixXd& samples)
    : features_(samples.rows()),
      chunks_((samples.cols() + kChunk - 1) / kChunk),
      values_(Eigen::VectorXd::Zero(features_ * chunks_ * kChunk)) {
  for (Index i = 0; i < samples.cols(); ++i) {
    for (Index f = 0; f < features_; ++f) {
      values_((i / kChunk * features_ + f) * kChunk + i % kChunk) = samples(f, i);
    }
  }
}

template <int kWeightings>
void PackedSamples::weightedDistances(const double* point, const double* weights, double* squares) const {
  const double* source = values_.data();
  for (Index first = 0; first < paddedSize(); first += kChunk) {
    for (Index v = 0; v < kVectors; ++v) {
      const double* sample = source + v * kLanes;
      const double* weight = weights;
      Packet sum[kWeightings] = {};
      for (Index f = 0; f < features_; ++f, sample += kChunk, weight += kWeightings) {
        const Packet difference = load(sample) - point[f];
        const Packet square = difference * difference;
        for (int t = 0; t < kWeightings; ++t) {
          sum[t] += square * weight[t];
        }
      }
      for (int t = 0; t < kWeightings; ++t) {
        store(squares + t * paddedSize() + first + v * kLanes, sum[t]);
      }
    }
    source += features_ * kChunk;
  }
}

template void PackedSamples::weightedDistances<1>(const double*, const double*, double*) const;
template void PackedSamples::weightedDistances<4>(const double*, const double*, double*) const;

void PackedSamples::addProduct(const double* weights, double* values) const {
  const double* source = values_.data();
  for (Index chunk = 0; chunk < chunks_; ++chunk) {
    Rows sum = loadRows(values + chunk * kChunk);
    for (Index f = 0; f < features_; ++f, source += kChunk) {
      for (Index v = 0; v < kVectors; ++v) {
        sum.part[v] += load(source + v * kLanes) * weights[f];
      }
    }
    storeRows(values + chunk * kChunk, sum);
  }
}

void PackedSamples::addTransposedProduct(const double* weights, double* values) const {
  Eigen::Map<Eigen::VectorXd> sums(values, features_);
  for (Index chunk = 0; chunk < chunks_; ++chunk) {
    const Eigen::Map<const Eigen::MatrixXd> samples(values_.data() + chunk * kChunk * features_, kChunk,
                                                    features_);
    sums.noalias() +=
        samples.transpose() * Eigen::Map<const Eigen::VectorXd>(weights + chunk * kChunk, kChunk);
  }
}

Eigen::VectorXd packColumns(const Eigen::MatrixXd& lower) {
  const Index n = lower.rows();
  Eigen::VectorXd packed(n * (n + 1) / 2);
  for (Index j = 0, at = 0; j < n; at += n - j, ++j) {
    packed.segment(at, n - j) = lower.col(j).tail(n - j);
  }
  return packed;
}

}  // namespace twinmap::linalg
