#include "framework/data/reduction/selections.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "framework/data/reduction/feature_transform.hpp"
#include "framework/data/reduction/mutual_information.hpp"
#include "tests/framework/data/features/normal_numbers.hpp"
#include "tests/lu.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The objective by plain inverses and determinants.
double calcInformation(const std::vector<Index>& selected, const MatrixXd& covariance,
                       const std::vector<MatrixXd>& sensitivities) {
  double sum = 0.0;
  const MatrixXd inverse = test::calcInverse(covariance(selected, selected));
  for (const MatrixXd& all : sensitivities) {
    const MatrixXd j = all(selected, Eigen::all);
    const MatrixXd box = 12.0 * MatrixXd::Identity(j.cols(), j.cols());
    sum += std::log(test::calcDeterminant(j.transpose() * inverse * j + box));
  }
  return sum;
}

std::vector<Index> selectByBruteForce(int count, const MatrixXd& covariance,
                                      const std::vector<MatrixXd>& sensitivities) {
  std::vector<Index> selected;
  for (int k = 0; k < count; ++k) {
    Index best = -1;
    double largest = -1.0;
    for (Index i = 0; i < covariance.rows(); ++i) {
      std::vector<Index> candidate = selected;
      candidate.push_back(i);
      const bool taken = std::count(selected.begin(), selected.end(), i) > 0;
      const double value = taken ? -1.0 : calcInformation(candidate, covariance, sensitivities);
      if (value > largest) {
        largest = value;
        best = i;
      }
    }
    selected.push_back(best);
  }
  return selected;
}

TEST(FisherSelection, IsTheGreedyChoiceOfNaiveDeterminants) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const MatrixXd mixing = makeNormal(9, 9, seed);
    const MatrixXd covariance = mixing * mixing.transpose();
    const std::vector<MatrixXd> sensitivities{5.0 * makeNormal(9, 3, 100 + seed),
                                              makeNormal(9, 3, 200 + seed)};
    EXPECT_EQ(selectByFisherInformation({6}, covariance, sensitivities),
              selectByBruteForce(6, covariance, sensitivities))
        << seed;
  }
}

TEST(FisherSelection, ByHandTakesTheOtherParameterSecond) {
  MatrixXd sensitivity(3, 2);
  sensitivity << 10, 0, 9, 0, 0, 2;
  EXPECT_EQ(selectByFisherInformation({3}, MatrixXd::Identity(3, 3), {sensitivity}),
            (std::vector<Index>{0, 1, 2}));  // 12 + 100, then 193/112 > 16/12
  sensitivity(2, 1) = 4;
  EXPECT_EQ(selectByFisherInformation({2}, MatrixXd::Identity(3, 3), {sensitivity}),
            (std::vector<Index>{0, 2}));  // 28/12 > 193/112
}

TEST(FisherSelection, PrefersWhatThePriorDoesNotKnow) {
  MatrixXd sensitivity(2, 2), prior = 12.0 * MatrixXd::Identity(2, 2);
  sensitivity << 10, 0, 0, 9;
  EXPECT_EQ(selectByFisherInformation({1}, MatrixXd::Identity(2, 2), {sensitivity}), std::vector<Index>{0});
  prior(0, 0) = 1000.0;
  EXPECT_EQ(selectByFisherInformation({1}, MatrixXd::Identity(2, 2), {sensitivity}, prior),
            std::vector<Index>{1});
}

TEST(FisherSelection, PassesOverRepeatedFeatures) {
  MatrixXd covariance = MatrixXd::Identity(3, 3), sensitivity(3, 1);
  covariance(0, 1) = covariance(1, 0) = 1.0;
  sensitivity << 10, 10, 1;
  EXPECT_EQ(selectByFisherInformation({2}, covariance, {sensitivity}), (std::vector<Index>{0, 2}));
  EXPECT_THROW(selectByFisherInformation({3}, covariance, {sensitivity}), std::invalid_argument);
  EXPECT_THROW(selectByFisherInformation({1}, covariance, {}), std::invalid_argument);
  covariance(2, 2) = 0.0;
  EXPECT_THROW(selectByFisherInformation({1}, covariance, {sensitivity}), std::invalid_argument);
}

/// Normal variables of correlation r: -log(1 - r^2) / 2. Over ten samples the estimator's mean is within
/// three of its standard errors.
TEST(MutualInformation, OfNormalVariablesIsTheClosedForm) {
  for (const double r : {0.0, 0.6, 0.95}) {
    VectorXd estimates(10);
    for (int i = 0; i < 10; ++i) {
      const MatrixXd z = makeNormal(2, 1000, 10 + i);
      const VectorXd a = z.row(0), b = 1e-3 * (r * z.row(0) + std::sqrt(1 - r * r) * z.row(1));
      estimates[i] = calcMutualInformation(rankValues(a), rankValues(b), 3);
    }
    EXPECT_NEAR(estimates.mean(), -0.5 * std::log(1 - r * r), 0.04) << r;
  }
}

TEST(MutualInformation, OfAConstantIsZeroAndTiesAreNoHarm) {
  const VectorXd constant = VectorXd::Constant(20, 0.1), other = makeNormal(20, 1, 3);
  EXPECT_EQ(calcMutualInformation(rankValues(constant), rankValues(other), 3), 0.0);
  const VectorXd tied = (other.array() > 0.0).cast<double>();
  EXPECT_GE(calcMutualInformation(rankValues(tied), rankValues(tied), 3), 0.0);
}

LabelledFeatures makeSelectable() {
  LabelledFeatures samples;
  samples.parameters = makeNormal(1, 300, 1);
  samples.features.resize(4, 300);
  samples.features.topRows(2) = samples.parameters.replicate(2, 1) + 0.1 * makeNormal(2, 300, 2);
  samples.features.row(1) = samples.features.row(0) + 0.01 * samples.features.row(1);
  samples.features.row(2) = makeNormal(1, 300, 3);
  samples.features.row(3) = samples.parameters + 0.3 * makeNormal(1, 300, 4);
  samples.noise_covariance = MatrixXd::Identity(4, 4);
  samples.infos = {
      {"a(0 s)", "", 0, 0.0}, {"a(1 s)", "", 0, 1.0}, {"b(0 s)", "", 1, 0.0}, {"b(1 s)", "", 1, 1.0}};
  return samples;
}

TEST(MutualInformationSelection, PrefersNewInformationToRepetition) {
  const std::vector<Index> selected = selectByMutualInformation({2, 3}, makeSelectable());
  EXPECT_LT(selected[0], 2);
  EXPECT_GE(selected[1], 2);
  EXPECT_THROW(selectByMutualInformation({5, 3}, makeSelectable()), std::invalid_argument);
}

TransformStepSpec makeSelect(const std::vector<std::string>& names) {
  FeatureNames features;
  for (const std::string& name : names) {
    features.push_back({name, {"some.yaml", 3, 4, "transform[0].select.features"}});
  }
  return {SelectSpec{features}, {}};
}

TEST(Selection, ByNameKeepsTheFeaturesInThatOrderAlsoTwice) {
  const LabelledFeatures samples = makeSelectable();
  const MatrixXd inputs =
      fitTransform({makeSelect({"b(1 s)", "a(0 s)", "b(0 s)"}), makeSelect({"a(0 s)"})}, samples)
          .apply(samples.features);
  EXPECT_EQ(inputs, samples.features.row(0));
}

TEST(Selection, WrongNamesAndCountsAreLocatedErrors) {
  const std::vector<FeatureInfo> infos = makeSelectable().infos;
  const auto expectError = [&](const TransformStepSpec& step, const std::string& text) {
    try {
      checkTransformOf(infos, {step});
      ADD_FAILURE() << text;
    } catch (const ExperimentError& error) {
      EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
    }
  };
  expectError(makeSelect({"a(0 s)", "b(2 s)"}),
              "some.yaml:3:4: transform[0].select.features: 'b(2 s)' is not a feature");
  expectError(makeSelect({"a(0 s)", "a(0 s)"}), "'a(0 s)' is listed twice");
  TransformStepSpec step;
  step.where = {"some.yaml", 3, 4, "transform[0]"};
  step.kind = SelectSpec{FisherInformationSpec{5}};
  expectError(step, "transform[0]: '5' asks for more than the 4 inputs");
  step.kind = PartialLeastSquaresSpec{5};
  expectError(step, "'5' asks for more");
  EXPECT_NO_THROW(checkTransformOf(infos, {makeSelect({"b(1 s)"})}));
}

}  // namespace
}  // namespace twinmap
