// Recursive blocked algorithms on the lower triangle: each halves the matrix, so that almost all flops are
// matrix products of the largest possible size.
#include "kernels/linalg/triangular.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/linalg/packet.hpp"
#include "kernels/linalg/parallel.hpp"

namespace twinmap::linalg {
namespace {

constexpr Index kBase = 32;            // below this order, plain loops over columns
constexpr Index kPanel = 64;           // triangular operands up to this order are multiplied with their zeros
constexpr Index kChunkVectors = 4;     // independent sums: they hide the latency of multiplying and adding
constexpr double kTeamFlops = 2e7;     // half a millisecond: a hundred times what waking a team costs
constexpr Index kStripsPerThread = 4;  // strips of unequal work: dealt one by one, they even out

Index halfOf(Index n) {
  return (n / 2 + kBase - 1) / kBase * kBase;
}

// target -= sum over i < count of columns(:, i) weights(i), on kVectors packets of rows.
template <Index kVectors>
void subtractColumnsChunk(const double* columns, Index stride, const double* weights, Index weight_stride,
                          Index count, double* target) {
  Packet sum[kVectors];
  for (Index v = 0; v < kVectors; ++v) {
    sum[v] = load(target + v * kLanes);
  }
  for (Index i = 0; i < count; ++i, columns += stride, weights += weight_stride) {
    for (Index v = 0; v < kVectors; ++v) {
      sum[v] -= load(columns + v * kLanes) * *weights;
    }
  }
  for (Index v = 0; v < kVectors; ++v) {
    store(target + v * kLanes, sum[v]);
  }
}

void subtractColumns(ConstView columns, const double* weights, Index weight_stride, double* target) {
  constexpr Index kChunk = kChunkVectors * kLanes;
  const double* source = columns.data;
  const Index stride = columns.col_stride;
  Index row = 0;
  for (; row + kChunk <= columns.rows; row += kChunk) {
    subtractColumnsChunk<kChunkVectors>(source + row, stride, weights, weight_stride, columns.cols,
                                        target + row);
  }
  for (; row + kLanes <= columns.rows; row += kLanes) {
    subtractColumnsChunk<1>(source + row, stride, weights, weight_stride, columns.cols, target + row);
  }
  for (; row < columns.rows; ++row) {
    double sum = target[row];
    for (Index i = 0; i < columns.cols; ++i) {
      sum -= source[row + i * stride] * weights[i * weight_stride];
    }
    target[row] = sum;
  }
}

void scale(double factor, double* values, Index count) {
  for (Index i = 0; i < count; ++i) {
    values[i] *= factor;
  }
}

bool factorizeSmall(View a) {
  for (Index j = 0; j < a.rows; ++j) {
    const Index rows = a.rows - j;
    subtractColumns(a.block(j, 0, rows, j), &a(j, 0), a.stride, &a(j, j));
    const double pivot = a(j, j);
    if (!(pivot > 0.0) || !std::isfinite(pivot)) {
      return false;
    }
    scale(1.0 / std::sqrt(pivot), &a(j, j), rows);
  }
  return true;
}

void solveSmall(ConstView lower, View b) {
  for (Index j = 0; j < b.cols; ++j) {
    subtractColumns(b.block(0, 0, b.rows, j), &lower.data[j], lower.col_stride, b.col(j));
    scale(1.0 / lower(j, j), b.col(j), b.rows);
  }
}

// b = b L^-T by one thread; the rows of b are independent of each other.
void solveRows(ConstView lower, View b, GemmScratch& scratch) {
  if (b.cols <= kBase) {
    return solveSmall(lower, b);
  }
  const Index left = halfOf(b.cols);
  const Index right = b.cols - left;
  const View b1 = b.block(0, 0, b.rows, left);
  const View b2 = b.block(0, left, b.rows, right);
  solveRows(lower.block(0, 0, left, left), b1, scratch);
  gemm(-1.0, b1, lower.block(left, 0, right, left).transposed(), 1.0, b2, scratch);
  solveRows(lower.block(left, left, right, right), b2, scratch);
}

// The sum over i of a(i) b(i), in an order that depends on the count only.
double dot(const double* a, const double* b, Index count) {
  Packet sums[kChunkVectors] = {};
  Index i = 0;
  for (; i + kChunkVectors * kLanes <= count; i += kChunkVectors * kLanes) {
    for (Index v = 0; v < kChunkVectors; ++v) {
      sums[v] += load(a + i + v * kLanes) * load(b + i + v * kLanes);
    }
  }
  const Packet packet = (sums[0] + sums[1]) + (sums[2] + sums[3]);
  double sum = 0.0;
  for (Index lane = 0; lane < kLanes; ++lane) {
    sum += packet[lane];
  }
  for (; i < count; ++i) {
    sum += a[i] * b[i];
  }
  return sum;
}

// Column j of the inverse from the trailing columns: X(j+1:, j) = -X(j+1:, j+1:) L(j+1:, j) / L(j, j), from
// the last column to the first.
void invertSmall(View lower) {
  double column[kBase];
  for (Index j = lower.rows - 1; j >= 0; --j) {
    const Index rows = lower.rows - j - 1;
    const double inverse_pivot = 1.0 / lower(j, j);
    std::copy_n(lower.col(j) + j + 1, rows, column);
    std::fill_n(lower.col(j) + j + 1, rows, 0.0);
    subtractColumns(lower.block(j + 1, j + 1, rows, rows), column, 1, lower.col(j) + j + 1);
    scale(inverse_pivot, lower.col(j) + j + 1, rows);
    lower(j, j) = inverse_pivot;
    std::fill_n(lower.col(j), j, 0.0);
  }
}

void copy(ConstView from, View to) {
  for (Index j = 0; j < to.cols; ++j) {
    std::copy_n(from.data + j * from.col_stride, to.rows, to.col(j));
  }
}

// b = b L, in place: the left columns need the right ones before these are overwritten.
void multiplyLowerFromRight(ConstView lower, View b, TriangularScratch& scratch) {
  if (lower.rows <= kPanel) {
    const View product = scratch.block(b.rows, b.cols);
    scratch.multiply(1.0, b, lower, 0.0, product);
    return copy(product, b);
  }
  const Index left = halfOf(lower.rows);
  const Index right = lower.rows - left;
  const View b1 = b.block(0, 0, b.rows, left);
  const View b2 = b.block(0, left, b.rows, right);
  multiplyLowerFromRight(lower.block(0, 0, left, left), b1, scratch);
  scratch.multiply(1.0, b2, lower.block(left, 0, right, left), 1.0, b1);
  multiplyLowerFromRight(lower.block(left, left, right, right), b2, scratch);
}

// b = sign L b, in place, the bottom rows first.
void multiplyLowerFromLeft(double sign, ConstView lower, View b, TriangularScratch& scratch) {
  if (lower.rows <= kPanel) {
    const View product = scratch.block(b.rows, b.cols);
    scratch.multiply(sign, lower, b, 0.0, product);
    return copy(product, b);
  }
  const Index top = halfOf(lower.rows);
  const Index bottom = lower.rows - top;
  const View b1 = b.block(0, 0, top, b.cols);
  const View b2 = b.block(top, 0, bottom, b.cols);
  multiplyLowerFromLeft(sign, lower.block(top, top, bottom, bottom), b2, scratch);
  scratch.multiply(sign, lower.block(top, 0, bottom, top), b1, 1.0, b2);
  multiplyLowerFromLeft(sign, lower.block(0, 0, top, top), b1, scratch);
}

// b = L' b, in place, the top rows first.
void multiplyTransposedLowerFromLeft(ConstView lower, View b, TriangularScratch& scratch) {
  if (lower.rows <= kPanel) {
    const View product = scratch.block(b.rows, b.cols);
    scratch.multiply(1.0, lower.transposed(), b, 0.0, product);
    return copy(product, b);
  }
  const Index top = halfOf(lower.rows);
  const Index bottom = lower.rows - top;
  const View b1 = b.block(0, 0, top, b.cols);
  const View b2 = b.block(top, 0, bottom, b.cols);
  multiplyTransposedLowerFromLeft(lower.block(0, 0, top, top), b1, scratch);
  scratch.multiply(1.0, lower.block(top, 0, bottom, top).transposed(), b2, 1.0, b1);
  multiplyTransposedLowerFromLeft(lower.block(top, top, bottom, bottom), b2, scratch);
}

}  // namespace

TriangularScratch::TriangularScratch(Index size, int threads)
    : gemm_(threads), block_(padded(std::max(size, kPanel)) * kPanel) {}

// Strips of columns; more strips than threads, because with kLower they differ in work.
void TriangularScratch::multiply(double alpha, ConstView a, ConstView b, double beta, View c, Part part) {
  const double flops =
      2.0 * static_cast<double>(c.rows) * static_cast<double>(c.cols) * static_cast<double>(a.cols);
  if (threads() == 1 || flops < kTeamFlops) {
    return linalg::gemm(alpha, a, b, beta, c, gemm(), part);
  }
  const Index width =
      std::max(kPanel, (c.cols / (kStripsPerThread * threads()) + kPanel - 1) / kPanel * kPanel);
  parallelFor(threads(), (c.cols + width - 1) / width, 1, [&](Index strip, int thread) {
    const Index col = strip * width;
    const Index cols = std::min(width, c.cols - col);
    const Index row = part == Part::kLower ? col : 0;
    linalg::gemm(alpha, a.block(row, 0, a.rows - row, a.cols), b.block(0, col, b.rows, cols), beta,
                 c.block(row, col, c.rows - row, cols), gemm_[thread], part);
  });
}

View TriangularScratch::block(Index rows, Index cols) {
  return {block_.data(), rows, cols, padded(rows)};
}

bool factorizeCholesky(View a, TriangularScratch& scratch) {
  if (a.rows <= kBase) {
    return factorizeSmall(a);
  }
  const Index top = halfOf(a.rows);
  const Index bottom = a.rows - top;
  const View a11 = a.block(0, 0, top, top);
  const View a21 = a.block(top, 0, bottom, top);
  const View a22 = a.block(top, top, bottom, bottom);
  if (!factorizeCholesky(a11, scratch)) {
    return false;
  }
  solveTransposedFromRight(a11, a21, scratch);
  scratch.multiply(-1.0, a21, a21.transposed(), 1.0, a22, Part::kLower);
  return factorizeCholesky(a22, scratch);
}

void solveTransposedFromRight(ConstView lower, View b, TriangularScratch& scratch) {
  const double flops =
      static_cast<double>(b.rows) * static_cast<double>(b.cols) * static_cast<double>(b.cols);
  if (scratch.threads() == 1 || flops < kTeamFlops) {
    return solveRows(lower, b, scratch.gemm());
  }
  const Index strips = kStripsPerThread * scratch.threads();
  const Index height = std::max(kPanel, (b.rows / strips + kPanel - 1) / kPanel * kPanel);
  parallelFor(scratch.threads(), (b.rows + height - 1) / height, 1, [&](Index strip, int thread) {
    const Index row = strip * height;
    const View rows = b.block(row, 0, std::min(height, b.rows - row), b.cols);
    solveRows(lower, rows, scratch.gemm(thread));
  });
}

void solveLower(ConstView lower, double* x) {
  const Index n = lower.rows;
  for (Index first = 0; first < n; first += kBase) {
    const Index end = std::min(first + kBase, n);
    for (Index j = first; j < end; ++j) {
      x[j] /= lower(j, j);
      for (Index i = j + 1; i < end; ++i) {
        x[i] -= lower(i, j) * x[j];
      }
    }
    subtractColumns(lower.block(end, first, n - end, end - first), x + first, 1, x + end);
  }
}

void solveLowerTransposed(ConstView lower, double* x) {
  for (Index j = lower.rows - 1; j >= 0; --j) {
    const Index rest = lower.rows - j - 1;
    x[j] = (x[j] - dot(lower.data + (j + 1) + j * lower.col_stride, x + j + 1, rest)) / lower(j, j);
  }
}

void invertLower(View lower, TriangularScratch& scratch) {
  if (lower.rows <= kBase) {
    return invertSmall(lower);
  }
  const Index top = halfOf(lower.rows);
  const Index bottom = lower.rows - top;
  const View l11 = lower.block(0, 0, top, top);
  const View l21 = lower.block(top, 0, bottom, top);
  const View l22 = lower.block(top, top, bottom, bottom);
  invertLower(l11, scratch);
  invertLower(l22, scratch);
  multiplyLowerFromRight(l11, l21, scratch);
  multiplyLowerFromLeft(-1.0, l22, l21, scratch);
  for (Index j = top; j < lower.cols; ++j) {
    std::fill_n(lower.col(j), top, 0.0);
  }
}

void multiplyTransposedBySelf(View lower, TriangularScratch& scratch) {
  if (lower.rows <= kBase) {
    const View product = scratch.block(lower.rows, lower.rows);
    scratch.multiply(1.0, lower.transposed(), lower, 0.0, product);
    return copy(product, lower);
  }
  const Index top = halfOf(lower.rows);
  const Index bottom = lower.rows - top;
  const View m21 = lower.block(top, 0, bottom, top);
  const View m22 = lower.block(top, top, bottom, bottom);
  multiplyTransposedBySelf(lower.block(0, 0, top, top), scratch);
  scratch.multiply(1.0, m21.transposed(), m21, 1.0, lower.block(0, 0, top, top), Part::kLower);
  multiplyTransposedLowerFromLeft(m22, m21, scratch);
  multiplyTransposedBySelf(m22, scratch);
}

}  // namespace twinmap::linalg
