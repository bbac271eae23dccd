#include "kernels/linalg/openblas.hpp"

#include <cblas.h>

#include <algorithm>

namespace twinmap::linalg {
namespace {

// Columns at a time of a product whose upper triangle is not wanted: few enough to waste little.
constexpr Index kLowerCols = 256;

// The threads are the callers' own.
const bool kSingleThreaded = [] {
  openblas_set_num_threads(1);
  return true;
}();

struct Operand {
  CBLAS_TRANSPOSE transpose;
  blasint stride;
};

Operand describe(ConstView view) {
  const bool plain = view.row_stride == 1;
  const Index stride = plain ? view.col_stride : view.row_stride;
  const Index least = std::max<Index>(1, plain ? view.rows : view.cols);
  return {plain ? CblasNoTrans : CblasTrans, static_cast<blasint>(std::max(stride, least))};
}

void multiplyColumns(double alpha, ConstView a, ConstView b, double beta, View c) {
  const Operand left = describe(a);
  const Operand right = describe(b);
  cblas_dgemm(CblasColMajor, left.transpose, right.transpose, static_cast<blasint>(c.rows),
              static_cast<blasint>(c.cols), static_cast<blasint>(a.cols), alpha, a.data, left.stride, b.data,
              right.stride, beta, c.data, static_cast<blasint>(c.stride));
}

}  // namespace

void multiplyByOpenblas(double alpha, ConstView a, ConstView b, double beta, View c, Part part) {
  if (part == Part::kAll) {
    return multiplyColumns(alpha, a, b, beta, c);
  }
  for (Index j = 0; j < std::min(c.cols, c.rows); j += kLowerCols) {
    const Index cols = std::min(kLowerCols, c.cols - j);
    const Index rows = c.rows - j;
    multiplyColumns(alpha, a.block(j, 0, rows, a.cols), b.block(0, j, b.rows, cols), beta,
                    c.block(j, j, rows, cols));
  }
}

}  // namespace twinmap::linalg
