#include "framework/diagnosis/second_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "framework/diagnosis/scored_candidates.hpp"
#include "tests/framework/diagnosis/measured_cart.hpp"

namespace twinmap {
namespace {

/// The advice for the terms that may stand for what the model of a cart lacks.
std::string adviseFor(const Eigen::VectorXd& measured, const std::vector<std::string>& terms) {
  const ExperimentSpec experiment = loadExperiment(kCart);
  const RecordedFeatures recordings{makeLayout(experiment), {measured}, {}};
  const ScoredCandidates scored = scoreCandidates(experiment, recordings, kTrueCart);
  std::vector<FittedTerm> fitted;
  for (const std::string& term : terms) {
    const auto found = std::find_if(scored.candidates.begin(), scored.candidates.end(),
                                    [&](const TermCandidate& one) { return one.term == term; });
    const TermScore& score = scored.scores[static_cast<std::size_t>(found - scored.candidates.begin())];
    fitted.push_back(fitTerm(experiment, recordings, *found, score, kTrueCart));
  }
  std::vector<const FittedTerm*> tied;
  for (const FittedTerm& one : fitted) {
    tied.push_back(&one);
  }
  return adviseSecondTest(experiment, recordings, tied);
}

// m x'' + d x' + k x + k3 x^3 = F: another mass is another force, and other d, k and k3, at any amplitude.
TEST(SecondTest, IsNoneWhereTermsAreTheSameAtAnyAmplitude) {
  EXPECT_EQ(adviseFor(measureCart("1.02*F - k3*x^3"), {"gain.F", "mass.cart"}),
            "no second test at half to four times the amplitude would");
}

TEST(SecondTest, TellsPowersOfTheSpeedApart) {
  EXPECT_EQ(adviseFor(measureCart("F - k3*x^3 - 0.05*x_dot*abs(x_dot)"), {"drag.x", "cubic_damping.x"}),
            "a second test at 2 times the amplitude would");
}

// A filter's time constant is free: a short one is a delay whatever the amplitude.
TEST(SecondTest, FollowsOwnScales) {
  const Eigen::VectorXd late = measureCart(kSound, 0, {"excitation.F.chirps[0].start=0.001"});
  EXPECT_EQ(adviseFor(late, {"delay.F", "lag.F"}),
            "no second test at half to four times the amplitude would");
}

}  // namespace
}  // namespace twinmap
