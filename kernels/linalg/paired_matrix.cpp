#include "kernels/linalg/paired_matrix.hpp"

#include <algorithm>
#include <cstring>

#include "kernels/linalg/packet.hpp"

namespace twinmap::linalg {
namespace {

using Bits = std::uint64_t __attribute__((vector_size(sizeof(Packet))));

constexpr int kHalf = 32;            // bits
constexpr Index kRows = 2 * kLanes;  // whose numbers of a column are read at once
constexpr Index kMaxPackets = 4;     // of a block: their sums fill half of the registers, or a quarter
constexpr std::uint64_t kUpper = ~0ull << kHalf;

std::uint64_t roundToHalf(double number) {
  std::uint64_t bits;
  std::memcpy(&bits, &number, sizeof(bits));
  return (bits + (1ull << (kHalf - 1))) & kUpper;
}

double toDouble(std::uint64_t bits) {
  double number;
  std::memcpy(&number, &bits, sizeof(number));
  return number;
}

Index countPackets(Index rows) {
  return (rows + kRows - 1) / kRows;
}

/// The rows from `first` on, of which there are so many; those beyond them are not written.
template <int kSums>
void storeRows(const Packet* sums, Index rows, double* product) {
  if (rows >= kSums * kLanes) {
    std::memcpy(product, sums, kSums * sizeof(Packet));
  } else {
    double padded[kSums * kLanes];
    std::memcpy(padded, sums, sizeof(padded));
    std::copy_n(padded, rows, product);
  }
}

/// sums += column x: the upper halves are the first rows of a packet, the lower ones those that follow.
template <int kPackets>
inline void addColumn(const std::uint64_t* column, double x, Packet* sums) {
  for (int packet = 0; packet < kPackets; ++packet) {
    Bits pairs;
    std::memcpy(&pairs, column + packet * kLanes, sizeof(pairs));
    sums[2 * packet] += reinterpret_cast<Packet>(pairs & kUpper) * x;
    sums[2 * packet + 1] += reinterpret_cast<Packet>(pairs << kHalf) * x;
  }
}

}  // namespace

Eigen::MatrixXd roundToHalves(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  return matrix.unaryExpr([](double number) { return toDouble(roundToHalf(number)); });
}

PairedMatrix::PairedMatrix(const Eigen::Ref<const Eigen::MatrixXd>& matrix)
    : rows_(matrix.rows()), cols_(matrix.cols()) {
  const auto getBits = [&](Index row, Index col) { return row < rows_ ? roundToHalf(matrix(row, col)) : 0; };
  pairs_.reserve(static_cast<std::size_t>(countPackets(rows_) * kLanes * cols_));
  for (Index first = 0; first < rows_; first += kMaxPackets * kRows) {
    const Index end = first + std::min(kMaxPackets, countPackets(rows_ - first)) * kRows;
    for (Index col = 0; col < cols_; ++col) {
      for (Index row = first; row < end; row += kRows) {
        for (Index lane = row; lane < row + kLanes; ++lane) {
          pairs_.push_back(getBits(lane, col) | getBits(lane + kLanes, col) >> kHalf);
        }
      }
    }
  }
}

/// Of kPackets packets of rows. Several columns are under way at once where their sums would be few, as each
/// sum waits for the one before it.
template <int kPackets>
void PairedMatrix::multiplyBlock(Index first, const double* vector, double* product) const {
  constexpr int kColumns = kMaxPackets / kPackets, kSums = 2 * kPackets;
  Packet sums[kColumns][kSums] = {};
  const std::uint64_t* column = pairs_.data() + first / 2 * cols_;
  Index col = 0;
  for (; col + kColumns <= cols_; col += kColumns) {
    for (int next = 0; next < kColumns; ++next, column += kPackets * kLanes) {
      addColumn<kPackets>(column, vector[col + next], sums[next]);
    }
  }
  for (; col < cols_; ++col, column += kPackets * kLanes) {
    addColumn<kPackets>(column, vector[col], sums[0]);
  }
  for (int next = 1; next < kColumns; ++next) {
    for (int sum = 0; sum < kSums; ++sum) {
      sums[0][sum] += sums[next][sum];
    }
  }
  storeRows<kSums>(sums[0], rows_ - first, product + first);
}

void PairedMatrix::multiply(const double* vector, double* product) const {
  for (Index first = 0; first < rows_; first += kMaxPackets * kRows) {
    switch (countPackets(rows_ - first)) {
      case 1:
        multiplyBlock<1>(first, vector, product);
        break;
      case 2:
        multiplyBlock<2>(first, vector, product);
        break;
      case 3:
        multiplyBlock<3>(first, vector, product);
        break;
      default:
        multiplyBlock<kMaxPackets>(first, vector, product);
    }
  }
}

}  // namespace twinmap::linalg
