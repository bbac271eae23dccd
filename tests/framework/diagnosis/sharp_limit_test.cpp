#include "framework/diagnosis/sharp_limit.hpp"

#include <gtest/gtest.h>

#include "framework/diagnosis/candidates/term_candidates.hpp"
#include "framework/diagnosis/diagnosis.hpp"
#include "tests/framework/diagnosis/measured_cart.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kCoefficient = 3, kScale = 4;

/// Dry friction of the cart, begun with its least scale.
TermCandidate findFriction(const ExperimentSpec& experiment) {
  for (const TermCandidate& one : listForceCandidates(calcModelSizes(experiment, kTrueCart))) {
    if (one.term == "coulomb.x") {
      return one;
    }
  }
  throw std::runtime_error("there is none");
}

/// A fit with dry friction, before it is followed, and after.
struct Followed {
  explicit Followed(const VectorXd& features)
      : recordings{makeLayout(plain), {features}, {}}, candidate(findFriction(plain)) {
    experiment = addTerm(plain, candidate, candidate.size).experiment;
    before = experiment.model.parameters[kScale].bounds;
    VectorXd start(5);
    start << kTrueCart, 0.03, candidate.own_scales.front().value;
    fit = first = RecordingsProblem(experiment, recordings).fit(start);
    followToLimit(recordings, kCoefficient, candidate, experiment, fit);
    after = experiment.model.parameters[kScale].bounds;
  }

  double calcChiSquareAt(double scale) const {
    VectorXd point = fit.point;
    point[kScale] = scale;
    return RecordingsProblem(experiment, recordings).fit(point, kScale).chi_square;
  }

  ExperimentSpec plain = loadExperiment(kCart), experiment;
  RecordedFeatures recordings;
  TermCandidate candidate;
  RecordingFit first, fit;
  Bounds before, after;
};

// Coulomb's law itself: whatever lies below the bound is as good as what lies at it.
TEST(SharpLimit, IsReachedWhereFrictionSetsInAtOnce) {
  const Followed cart(
      measureCart(kSound, 0, {"system.friction=[{coordinate: x, model: coulomb, coulomb: 0.03}]"}));
  EXPECT_LT(cart.after.lower, 0.21 * cart.before.lower);
  EXPECT_EQ(cart.after.upper, cart.before.upper);
  EXPECT_LE(cart.fit.chi_square, cart.first.chi_square);
  EXPECT_GE(cart.fit.point[kScale], cart.after.lower);
  const double at_bound = cart.calcChiSquareAt(cart.after.lower);
  EXPECT_NEAR(at_bound, cart.calcChiSquareAt(5.0 * cart.after.lower), 1.0);
  EXPECT_LT(at_bound, cart.fit.chi_square + 9.0);
}

TEST(SharpLimit, IsNotSoughtWhereTheRecordingExcludesIt) {
  const Followed cart(measureCart("F - k3*x^3 - 0.1*tanh(x_dot/0.02)"));
  EXPECT_EQ(cart.after.lower, cart.before.lower);
  EXPECT_EQ(cart.fit.point, cart.first.point);
  EXPECT_NEAR(cart.fit.point[kScale], 0.02, 0.006);
}

TEST(SharpLimit, HoldsOnlyTheScale) {
  const Followed cart(measureCart("F - k3*x^3 - 0.1*tanh(x_dot/0.02)"));
  VectorXd start = cart.fit.point;
  start.head(3) = Eigen::Vector3d(100.0, 1.0, 3000.0);
  start[kScale] = 0.01;
  const RecordingFit held = RecordingsProblem(cart.experiment, cart.recordings).fit(start, kScale);
  EXPECT_NEAR(held.point[kScale], 0.01, 1e-12);
  EXPECT_GT(held.chi_square, cart.fit.chi_square);
  EXPECT_NEAR(held.point[0], kTrueCart[0], 1.0);
}

// As the evidence of scales has it.
TEST(SharpLimit, HasAPriorUniformInTheLogarithm) {
  const ExperimentSpec plain = loadExperiment(kCart);
  const ParameterSpec scale = addTerm(plain, findFriction(plain), 1.0).experiment.model.parameters[kScale];
  ASSERT_TRUE(scale.prior.has_value());
  EXPECT_TRUE(std::holds_alternative<LogUniformPrior>(scale.prior->kind));
}

// In the corrected experiment, not only in a fit.
TEST(SharpLimit, IsWithinTheBoundsOfWhatIsFound) {
  const ExperimentSpec experiment = loadExperiment(kCart);
  const VectorXd features =
      measureCart(kSound, 0, {"system.friction=[{coordinate: x, model: coulomb, coulomb: 0.03}]"});
  const Diagnosis diagnosis =
      diagnose(experiment, RecordedFeatures{makeLayout(experiment), {features}, {}}, {});
  ASSERT_EQ(diagnosis.listTerms(), std::vector<std::string>{"coulomb.x"});
  const Bounds& bounds = diagnosis.corrected.model.parameters[kScale].bounds;
  EXPECT_LT(bounds.lower, 0.1 * findFriction(experiment).own_scales.front().value);
  EXPECT_TRUE(diagnosis.listTermsAtBounds().empty());
  for (Index i = 0; i < 3; ++i) {
    EXPECT_NEAR(diagnosis.averaged.mean[i], kTrueCart[i], 4.0 * diagnosis.averaged.stddev[i]);
  }
}

}  // namespace
}  // namespace twinmap
