#include "framework/estimation/surrogate/forward_samples.hpp"

#include <algorithm>

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

/// The first `most` simulations that have slopes, then the others.
std::vector<Index> orderBySlopes(const ForwardSamples& samples, Index& with_slopes) {
  std::vector<Index> order, others;
  Index unknown = 0;
  for (const MatrixXd& slopes : samples.slopes) {
    unknown = std::max(unknown, slopes.cols());
  }
  const Index n = samples.points.cols(), most = unknown > 0 ? countSlopePoints(n, unknown) : 0;
  for (Index i = 0; i < n; ++i) {
    const bool has =
        static_cast<Index>(order.size()) < most && samples.slopes[static_cast<std::size_t>(i)].size() > 0;
    (has ? order : others).push_back(i);
  }
  with_slopes = static_cast<Index>(order.size());
  order.insert(order.end(), others.begin(), others.end());
  return order;
}

}  // namespace

Index countSlopePoints(Index simulations, Index unknown) {
  // Of 1200 for all windows, sds of eight mechanisms were 1 to 20 % larger.
  constexpr Index kMaxRows = 2000;
  return std::clamp<Index>((kMaxRows - simulations) / std::max<Index>(unknown, 1), 0, simulations);
}

std::vector<Index> listFewSlopePoints(Index simulations, Index unknown, Index with_slopes) {
  constexpr Index kFewRows = 700, kLeastShare = 4;
  const Index by_rows = std::max<Index>(0, kFewRows - simulations) / std::max<Index>(unknown, 1);
  std::vector<Index> few;
  for (const Index count : {std::max(by_rows, with_slopes / kLeastShare), with_slopes / 2}) {
    if (count >= with_slopes) {
      break;  // all of them make few rows
    }
    if (few.empty() || count > few.back()) {
      few.push_back(count);
    }
  }
  return few;
}

WhitenedSamples whiten(const ForwardSamples& samples, const Eigen::VectorXd& center,
                       const NoiseWhitener& noise) {
  Index with_slopes = 0;
  const std::vector<Index> order = orderBySlopes(samples, with_slopes);
  WhitenedSamples whitened{samples.points(Eigen::all, order),
                           noise.apply(samples.clean_features(Eigen::all, order).colwise() - center),
                           {}};
  if (with_slopes == 0) {
    return whitened;
  }
  const Index unknown = samples.slopes[static_cast<std::size_t>(order[0])].cols();
  whitened.slopes.variables = unknown;
  whitened.slopes.values.resize(unknown * with_slopes, whitened.features.rows());
  for (Index i = 0; i < with_slopes; ++i) {
    const MatrixXd slopes = noise.apply(samples.slopes[static_cast<std::size_t>(order[i])]);
    for (Index v = 0; v < unknown; ++v) {
      whitened.slopes.values.row(v * with_slopes + i) = slopes.col(v).transpose();
    }
  }
  return whitened;
}

std::vector<Index> orderSimulations(const ForwardSamples& samples) {
  Index with_slopes = 0;
  return orderBySlopes(samples, with_slopes);
}

WhitenedSamples selectWhitened(const WhitenedSamples& whitened, const std::vector<Index>& kept) {
  const Index m = whitened.slopes.countPoints(), u = whitened.slopes.variables;
  WhitenedSamples selected{whitened.points(Eigen::all, kept), whitened.features(Eigen::all, kept), {}};
  selected.features.colwise() -= selected.features.rowwise().mean().eval();
  const std::vector<Index> with_slopes(kept.begin(), std::lower_bound(kept.begin(), kept.end(), m));
  if (with_slopes.empty()) {
    return selected;
  }
  const auto count = static_cast<Index>(with_slopes.size());
  selected.slopes.variables = u;
  selected.slopes.values.resize(u * count, whitened.features.rows());
  for (Index v = 0; v < u; ++v) {
    selected.slopes.values.middleRows(v * count, count) =
        whitened.slopes.values.middleRows(v * m, m)(with_slopes, Eigen::all);
  }
  return selected;
}

}  // namespace twinmap
