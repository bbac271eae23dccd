#include "framework/estimation/network/canonical_inputs.hpp"

#include <gtest/gtest.h>

#include "framework/base/random/random.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kSamples = 3000;

MatrixXd drawNormal(Index rows, std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::kNetworkPool);
  return MatrixXd::NullaryExpr(rows, kSamples, [&](Index i, Index j) {
    return random.calcNormal(static_cast<std::uint64_t>(j), static_cast<std::uint64_t>(i));
  });
}

MatrixXd center(const MatrixXd& values) {
  return values.colwise() - VectorXd(values.rowwise().mean());
}

/// Two parameters, and what follows them smoothly, half, and not at all: the latter varies most.
struct Example {
  MatrixXd points = drawNormal(2, 1);
  MatrixXd sources{3, kSamples};

  Example() {
    const MatrixXd noise = drawNormal(2, 2);
    const auto a = points.row(0).array(), b = points.row(1).array();
    sources.row(0) = 0.1 * (a + 0.3 * a * b - 0.1 * b * b * b).matrix();
    sources.row(1) = points.row(1) + noise.row(0);
    sources.row(2) = 50.0 * noise.row(1);
    sources = center(sources);
  }

  MatrixXd mix() const {
    MatrixXd mixing(3, 3);
    mixing << 1.0, 0.3, -0.2, 0.5, 1.0, 0.1, -0.4, 0.2, 1.0;
    return mixing * sources;
  }
};

TEST(CanonicalInputs, ComeInTheOrderInWhichParametersExplainThem) {
  const Example example;
  const MatrixXd inputs = example.mix();
  const CanonicalInputs canonical = calcCanonicalInputs(inputs, example.points);
  EXPECT_NEAR(canonical.correlations[0], 1.0, 1e-6);
  EXPECT_NEAR(canonical.correlations[1], std::sqrt(0.5), 0.03);
  EXPECT_LT(canonical.correlations[2], 0.1);
  const MatrixXd found = canonical.projection * inputs;
  EXPECT_LT((found * found.transpose() / double(kSamples) - MatrixXd::Identity(3, 3)).norm(), 1e-9);
  const auto correlate = [](const auto& x, const auto& y) {
    return std::abs(x.dot(y)) / (x.norm() * y.norm());
  };
  EXPECT_GT(correlate(found.row(0), example.sources.row(0)), 0.999);
}

TEST(CanonicalInputs, DoNotDependOnTheirMixture) {
  const Example example;
  const MatrixXd plain = calcCanonicalInputs(example.sources, example.points).projection * example.sources;
  const MatrixXd mixed = calcCanonicalInputs(example.mix(), example.points).projection * example.mix();
  for (Index i = 0; i < 3; ++i) {
    EXPECT_NEAR(std::abs(plain.row(i).dot(mixed.row(i))) / double(kSamples), 1.0, 1e-6);
  }
}

TEST(CanonicalInputs, AreZeroWhereNothingVaries) {
  const Example example;
  MatrixXd inputs(4, kSamples);
  inputs << example.sources, example.sources.row(0) - example.sources.row(1);
  const CanonicalInputs canonical = calcCanonicalInputs(inputs, example.points);
  const MatrixXd found = canonical.projection * inputs;
  EXPECT_TRUE(found.allFinite());
  EXPECT_LT(found.row(3).norm(), 1e-6);
  EXPECT_NEAR(canonical.correlations[3], 0.0, 1e-6);
}

TEST(CanonicalInputs, TakeLowerDegreesOfFewSamples) {
  const Example example;
  // of 25 samples 9 terms are too many, and so are 5 of 12: the first degree does not explain a b
  for (const Index count : {Index{25}, Index{12}}) {
    const MatrixXd points = example.points.leftCols(count);
    const MatrixXd product = center(points.row(0).cwiseProduct(points.row(1)));
    const double found = calcCanonicalInputs(product, points).correlations[0];
    EXPECT_EQ(found > 0.999, count == 25) << found;
  }
}

}  // namespace
}  // namespace twinmap
