// The product by packed panels and a register tile, after Goto and van de Geijn, "Anatomy of high-performance
// matrix multiplication", ACM TOMS 34 (2008). One panel of B stays in L3, one block of A in L2, one sliver of
// B in L1; the register tile is kTileRows x kTileCols.
#include "kernels/linalg/gemm.hpp"

#include <algorithm>
#include <cstring>

#include "kernels/linalg/packet.hpp"

namespace twinmap::linalg {
namespace {

#ifdef __AVX512F__
constexpr Index kTileVectors = 2;
#else
constexpr Index kTileVectors = 3;
#endif
constexpr Index kTileCols = kLanes;  // 16 (AVX-512) or 12 (AVX2) sums in registers; 32 rows are whole tiles
constexpr Index kTileRows = kLanes * kTileVectors;
constexpr Index kBlockDepth = 256;  // a sliver of B, kTileCols wide: 16 KiB (8 with AVX2), half of L1
constexpr Index kBlockRows = 12 * kTileRows;  // a block of A: 384 KiB (288 with AVX2), within L2
constexpr Index kBlockCols = 1024;            // a panel of B: 2 MiB of L3

Index roundUp(Index value, Index multiple) {
  return (value + multiple - 1) / multiple * multiple;
}

// Packs a into slivers of `width` rows, depth-major: sliver s holds a(s*width + r, p) at [p*width + r].
// Rows beyond a's are zero. alpha is folded in here.
void pack(ConstView a, Index width, double alpha, double* packed) {
  for (Index first = 0; first < a.rows; first += width) {
    const Index rows = std::min(width, a.rows - first);
    for (Index p = 0; p < a.cols; ++p, packed += width) {
      const double* source = a.data + first * a.row_stride + p * a.col_stride;
      for (Index r = 0; r < rows; ++r) {
        packed[r] = alpha * source[r * a.row_stride];
      }
      for (Index r = rows; r < width; ++r) {
        packed[r] = 0.0;
      }
    }
  }
}

// The same where a's rows are contiguous in memory: whole slivers are copied by vector.
void packUnitStride(ConstView a, Index width, double alpha, double* packed) {
  const Index whole = a.rows / width * width;
  for (Index first = 0; first < whole; first += width) {
    for (Index p = 0; p < a.cols; ++p, packed += width) {
      const double* source = a.data + first + p * a.col_stride;
      for (Index r = 0; r < width; ++r) {
        packed[r] = alpha * source[r];
      }
    }
  }
  if (whole < a.rows) {
    pack(a.block(whole, 0, a.rows - whole, a.cols), width, alpha, packed);
  }
}

// Where the depth runs along memory, square blocks are transposed in registers.
void packUnitDepth(ConstView a, Index width, double alpha, double* packed) {
  const Index whole = a.rows / width * width;
  const Index depth = a.cols / kLanes * kLanes;
  for (Index first = 0; first < whole; first += width, packed += width * a.cols) {
    const double* source = a.data + first * a.row_stride;
    for (Index p = 0; p < depth; p += kLanes) {
      for (Index r = 0; r < width; r += kLanes) {
        copyTransposed(source + r * a.row_stride + p, a.row_stride, packed + p * width + r, width);
      }
    }
    pack(a.block(first, depth, width, a.cols - depth), width, 1.0, packed + depth * width);
    if (alpha == 1.0) {
      continue;
    }
    for (Index i = 0; i < width * a.cols; ++i) {
      packed[i] *= alpha;
    }
  }
  if (whole < a.rows) {
    pack(a.block(whole, 0, a.rows - whole, a.cols), width, alpha, packed);
  }
}

template <Index kWidth>
void packSlivers(ConstView a, double alpha, double* packed) {
  if (a.row_stride == 1) {
    return packUnitStride(a, kWidth, alpha, packed);
  }
  if (a.col_stride == 1) {
    return packUnitDepth(a, kWidth, alpha, packed);
  }
  pack(a, kWidth, alpha, packed);
}

struct Tile {
  Packet column[kTileCols][kTileVectors];
};

// tile = sum over p of (left sliver at p) (right sliver at p)'
inline void multiplySlivers(Index depth, const double* left, const double* right, Tile& tile) {
  Packet sum[kTileCols][kTileVectors] = {};
  for (Index p = 0; p < depth; ++p, left += kTileRows, right += kTileCols) {
    Packet rows[kTileVectors];
    for (Index v = 0; v < kTileVectors; ++v) {
      rows[v] = *reinterpret_cast<const Packet*>(left + v * kLanes);
    }
#pragma GCC unroll 8
    for (Index j = 0; j < kTileCols; ++j) {
#pragma GCC unroll 3
      for (Index v = 0; v < kTileVectors; ++v) {
        sum[j][v] += rows[v] * right[j];
      }
    }
  }
  for (Index j = 0; j < kTileCols; ++j) {
    for (Index v = 0; v < kTileVectors; ++v) {
      tile.column[j][v] = sum[j][v];
    }
  }
}

void storeWhole(const Tile& tile, bool accumulate, View c) {
  for (Index j = 0; j < kTileCols; ++j) {
    for (Index v = 0; v < kTileVectors; ++v) {
      double* target = c.col(j) + v * kLanes;
      store(target, accumulate ? load(target) + tile.column[j][v] : tile.column[j][v]);
    }
  }
}

void storeEdge(const Tile& tile, bool accumulate, View c) {
  for (Index j = 0; j < c.cols; ++j) {
    double values[kTileRows];
    std::memcpy(values, tile.column[j], sizeof(values));
    for (Index i = 0; i < c.rows; ++i) {
      c(i, j) = accumulate ? c(i, j) + values[i] : values[i];
    }
  }
}

// One packed block of A times one packed panel of B. Element (0, 0) of c lies diagonal_offset rows below the
// diagonal of the whole result.
void multiplyBlock(Index depth, const double* left, const double* right, bool accumulate, View c,
                   Index diagonal_offset, Part part) {
  for (Index j = 0; j < c.cols; j += kTileCols) {
    const Index cols = std::min(kTileCols, c.cols - j);
    for (Index i = 0; i < c.rows; i += kTileRows) {
      const Index rows = std::min(kTileRows, c.rows - i);
      if (part == Part::kLower && i + rows - 1 + diagonal_offset < j) {
        continue;
      }
      Tile tile;
      multiplySlivers(depth, left + i * depth, right + j * depth, tile);
      const View target = c.block(i, j, rows, cols);
      if (rows == kTileRows && cols == kTileCols) {
        storeWhole(tile, accumulate, target);
      } else {
        storeEdge(tile, accumulate, target);
      }
    }
  }
}

void clear(View c) {
  for (Index j = 0; j < c.cols; ++j) {
    std::fill_n(c.col(j), c.rows, 0.0);
  }
}

}  // namespace

GemmScratch::GemmScratch()
    : left_(kBlockDepth * roundUp(kBlockRows, kTileRows)),
      right_(kBlockDepth * roundUp(kBlockCols, kTileCols)) {}

void gemm(double alpha, ConstView a, ConstView b, double beta, View c, GemmScratch& scratch, Part part) {
  if (a.cols == 0 && beta == 0.0) {
    clear(c);
  }
  for (Index j = 0; j < c.cols; j += kBlockCols) {
    const Index cols = std::min(kBlockCols, c.cols - j);
    for (Index p = 0; p < a.cols; p += kBlockDepth) {
      const Index depth = std::min(kBlockDepth, a.cols - p);
      const bool accumulate = beta != 0.0 || p > 0;
      packSlivers<kTileCols>(b.block(p, j, depth, cols).transposed(), 1.0, scratch.right());
      for (Index i = 0; i < c.rows; i += kBlockRows) {
        const Index rows = std::min(kBlockRows, c.rows - i);
        if (part == Part::kLower && i + rows - 1 < j) {
          continue;
        }
        packSlivers<kTileRows>(a.block(i, p, rows, depth), alpha, scratch.left());
        multiplyBlock(depth, scratch.left(), scratch.right(), accumulate, c.block(i, j, rows, cols), i - j,
                      part);
      }
    }
  }
}

}  // namespace twinmap::linalg
