#include "framework/optimal_design/candidate_information.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "framework/base/random/random.hpp"
#include "tests/lu.hpp"

namespace twinmap::experiment_design {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const Criterion kDOptimal{Criterion::Kind::d_optimal, {}};

MatrixXd drawMatrix(Index rows, Index columns, std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::kVerification);
  return MatrixXd::NullaryExpr(rows, columns, [&](Index i, Index j) {
    return random.calcNormal(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j));
  });
}

std::vector<std::vector<Index>> makeGroups(Index candidates, Index each) {
  std::vector<std::vector<Index>> groups;
  for (Index c = 0; c < candidates; ++c) {
    groups.emplace_back();
    for (Index k = 0; k < each; ++k) {
      groups.back().push_back(c * each + k);
    }
  }
  return groups;
}

/// Some candidates of two features each, three points, four unknowns.
CandidateFeatures makeFeatures(Index candidates) {
  CandidateFeatures features;
  for (std::uint64_t point = 1; point <= 3; ++point) {
    features.sensitivities.push_back(3.0 * drawMatrix(2 * candidates, 4, point));
  }
  features.noise_covariance = VectorXd::LinSpaced(2 * candidates, 0.5, 2.0).asDiagonal();
  return features;
}

// J' C^-1 J of what is chosen, the last unknown marginalised as a nuisance parameter of variance 1 / 12.
MatrixXd calcExpected(const CandidateFeatures& features, const std::vector<Index>& rows, std::size_t point) {
  const MatrixXd j = features.sensitivities[point](rows, Eigen::all);
  const MatrixXd c = features.noise_covariance.take(rows).toMatrix();
  MatrixXd whole = j.transpose() * test::calcInverse(c) * j;
  return whole.topLeftCorner(3, 3) -
         whole.topRightCorner(3, 1) * whole.bottomLeftCorner(1, 3) / (whole(3, 3) + 12.0);
}

TEST(CandidateInformation, IsThatOfTheChosenFeaturesWhetherNoiseIsCorrelatedOrNot) {
  for (const double correlation : {0.0, 0.4}) {
    CandidateFeatures features = makeFeatures(5);
    MatrixXd covariance = features.noise_covariance.toMatrix();
    for (Index i = 0; i + 1 < covariance.rows(); ++i) {
      covariance(i, i + 1) = covariance(i + 1, i) = correlation * 0.5;
    }
    features.noise_covariance = covariance;
    const CandidateInformation candidates(features, makeGroups(5, 2), 3);
    for (std::size_t point = 0; point < 3; ++point) {
      const MatrixXd expected = calcExpected(features, {2, 3, 8, 9}, point);
      EXPECT_LT((candidates.calcInformation({1, 4}, point) - expected).norm(), 1e-10 * expected.norm());
    }
  }
}

// The information is per width, the criterion per half-width, where the box is 3.
TEST(CandidateInformation, CostIsTheMeanOverThePoints) {
  const CandidateFeatures features = makeFeatures(5);
  const CandidateInformation candidates(features, makeGroups(5, 2), 3);
  double mean = 0.0;
  for (std::size_t point = 0; point < 3; ++point) {
    const MatrixXd information =
        calcExpected(features, {0, 1, 6, 7}, point) / 4.0 + 3.0 * MatrixXd::Identity(3, 3);
    mean -= std::log(test::calcDeterminant(information)) / 3.0 / 3.0;
  }
  EXPECT_NEAR(candidates.calcMeanCost({0, 3}, kDOptimal), mean, 1e-12);
}

TEST(ExtendSubset, IsNoWorseThanGreedyAndNearlyTheBestOfAllPairsAndTriples) {
  const CandidateInformation candidates(makeFeatures(9), makeGroups(9, 2), 3);
  double best = INFINITY;
  for (Index a = 0; a < 9; ++a) {
    for (Index b = a + 1; b < 9; ++b) {
      for (Index c = b + 1; c < 9; ++c) {
        best = std::min(best, candidates.calcMeanCost({a, b, c}, kDOptimal));
      }
    }
  }
  const Subset chosen = extendSubset(candidates, kDOptimal, {}, 3);
  EXPECT_EQ(chosen.size(), 3U);
  EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
  EXPECT_LE(candidates.calcMeanCost(chosen, kDOptimal), best + 2.0 * std::log(1.05));
}

TEST(ExtendSubset, ExchangesWhatWasBegunWithBadly) {
  const CandidateInformation candidates(makeFeatures(9), makeGroups(9, 2), 3);
  const Subset good = extendSubset(candidates, kDOptimal, {}, 3);
  for (const Subset& begun : {Subset{0, 1, 2}, Subset{6, 7, 8}}) {
    const Subset chosen = extendSubset(candidates, kDOptimal, begun, 3);
    EXPECT_NEAR(candidates.calcMeanCost(chosen, kDOptimal), candidates.calcMeanCost(good, kDOptimal), 0.1);
  }
}

}  // namespace
}  // namespace twinmap::experiment_design
