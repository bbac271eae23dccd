#include "kernels/surrogate/slope_sums.hpp"

#include <algorithm>

namespace twinmap::gp {

using Eigen::ArrayXd;
using Eigen::Index;

namespace {

constexpr Index kWidth = 8;  // of AVX-512; two packets of AVX2
constexpr int kMostTogether = 4;
using Packet = Eigen::Array<double, kWidth, 1>;
using ConstMap = Eigen::Map<const Packet>;

/// Of the variables first ... first + count.
template <int count>
void addVariables(const PointCovariance& at, const Eigen::Ref<const Eigen::MatrixXd>& weights, Index first,
                  SlopeSums& sums) {
  const Index m = weights.rows(), whole = m - m % kWidth;
  Packet together[count];
  std::fill_n(together, count, Packet::Zero());
  for (Index i = 0; i < whole; i += kWidth) {
    Packet projected = sums.projected.segment<kWidth>(i);
    const Packet slopes = at.slopes.segment<kWidth>(i);
    for (int v = 0; v < count; ++v) {
      const Packet weight = ConstMap(weights.col(first + v).data() + i);
      projected += ConstMap(&at.differences(i, first + v)) * weight;
      together[v] += slopes * weight;
    }
    sums.projected.segment<kWidth>(i) = projected;
  }
  const Index rest = m - whole;
  for (int v = 0; v < count; ++v) {
    const auto weight = weights.col(first + v).tail(rest).array();
    sums.projected.tail(rest) += at.differences.col(first + v).segment(whole, rest) * weight;
    sums.weighted(first + v) = together[v].sum() + (at.slopes.segment(whole, rest) * weight).sum();
  }
}

template <int count>
void sumVariables(const PointCovariance& at, const ArrayXd& f, Index first,
                  Eigen::Ref<Eigen::VectorXd> sums) {
  const Index n = f.size(), whole = n - n % kWidth;
  Packet together[count];
  std::fill_n(together, count, Packet::Zero());
  for (Index i = 0; i < whole; i += kWidth) {
    const Packet factor = f.segment<kWidth>(i);
    for (int v = 0; v < count; ++v) {
      together[v] += ConstMap(&at.differences(i, first + v)) * factor;
    }
  }
  const Index rest = n - whole;
  for (int v = 0; v < count; ++v) {
    sums(first + v) = together[v].sum() + (at.differences.col(first + v).tail(rest) * f.tail(rest)).sum();
  }
}

/// Calls work.operator()<count>(first) for tiles of all variables.
template <class Work>
void tileVariables(Index variables, const Work& work) {
  for (Index first = 0; first < variables; first += kMostTogether) {
    switch (std::min<Index>(kMostTogether, variables - first)) {
      case 1:
        work(std::integral_constant<int, 1>(), first);
        break;
      case 2:
        work(std::integral_constant<int, 2>(), first);
        break;
      case 3:
        work(std::integral_constant<int, 3>(), first);
        break;
      default:
        work(std::integral_constant<int, kMostTogether>(), first);
    }
  }
}

}  // namespace

void SlopeSums::calc(const PointCovariance& at, const Eigen::Ref<const Eigen::MatrixXd>& weights) {
  projected.setZero(weights.rows());
  weighted.resize(weights.cols());
  tileVariables(weights.cols(), [&](auto count, Index first) {
    addVariables<decltype(count)::value>(at, weights, first, *this);
  });
}

void sumDifferences(const PointCovariance& at, const ArrayXd& f, Eigen::Ref<Eigen::VectorXd> sums) {
  tileVariables(sums.size(),
                [&](auto count, Index first) { sumVariables<decltype(count)::value>(at, f, first, sums); });
}

}  // namespace twinmap::gp
