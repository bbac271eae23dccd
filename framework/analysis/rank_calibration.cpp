#include "framework/analysis/rank_calibration.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <cassert>

#include "framework/estimation/estimate.hpp"
#include "framework/estimation/trained/test_records.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr Index kRanks = kRankDraws + 1;

Index chooseBins(Index measurements) {
  constexpr Index kMany = 200, kBins = 20, kFewBins = 10;
  return measurements >= kMany ? kBins : kFewBins;
}

/// Of each point (p x n).
VectorXd calcSquaredDistances(const MatrixXd& points, const RankMetric& metric) {
  const VectorXd scale = metric.covariance.diagonal().cwiseSqrt();
  const MatrixXd lower = linalg::calcCholesky(calcCorrelation(metric.covariance)).lower;
  const MatrixXd apart = scale.cwiseInverse().asDiagonal() * (points.colwise() - metric.center);
  return linalg::solveLower(lower, apart).colwise().squaredNorm();
}

}  // namespace

Eigen::VectorXi calcRanks(const Eigen::Ref<const VectorXd>& truth, const MatrixXd& draws,
                          const RankMetric& metric) {
  assert(draws.cols() >= kRankDraws && draws.rows() == truth.size());
  const Index p = truth.size();
  Eigen::VectorXi ranks(p + 1);
  for (Index j = 0; j < p; ++j) {
    ranks[j] = static_cast<int>((draws.row(j).head(kRankDraws).array() < truth[j]).count());
  }
  MatrixXd points(p, kRankDraws + 1);
  points << truth, draws.leftCols(kRankDraws);
  const VectorXd squares = calcSquaredDistances(points, metric);
  ranks[p] = static_cast<int>((squares.tail(kRankDraws).array() < squares[0]).count());
  return ranks;
}

RankCalibration calcRankCalibration(const Eigen::MatrixXi& ranks) {
  assert(ranks.cols() >= kMinRanks);
  const Index bins = chooseBins(ranks.cols());
  const double expected = static_cast<double>(ranks.cols()) / static_cast<double>(bins);
  const boost::math::chi_squared distribution(static_cast<double>(bins - 1));
  RankCalibration found{Eigen::MatrixXi::Zero(bins, ranks.rows()), {}, VectorXd(ranks.rows())};
  for (Index q = 0; q < ranks.rows(); ++q) {
    for (Index i = 0; i < ranks.cols(); ++i) {
      ++found.counts(ranks(q, i) * bins / kRanks, q);
    }
  }
  found.chi_square =
      (found.counts.cast<double>().array() - expected).square().colwise().sum().transpose() / expected;
  for (Index q = 0; q < ranks.rows(); ++q) {
    found.p_value[q] = boost::math::cdf(boost::math::complement(distribution, found.chi_square[q]));
  }
  return found;
}

std::vector<Index> findMiscalibrated(const RankCalibration& calibration) {
  return findUneven(calibration.p_value);
}

}  // namespace twinmap
