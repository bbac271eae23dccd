#include "framework/diagnosis/scored_candidates.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/framework/diagnosis/measured_cart.hpp"

namespace twinmap {
namespace {

// Of all candidates, those with states come in parts, of which only the first has the derivatives by the
// parameters; a few alone are all in the first.
TEST(ScoredCandidates, ScoreATermAlikeAloneAndAmongAll) {
  const ExperimentSpec experiment = loadExperiment(kCart);
  const RecordedFeatures recordings{makeLayout(experiment), {measureCart("F - k3*x^3")}, {}};
  const ScoredCandidates all = scoreCandidates(experiment, recordings, kTrueCart);
  const auto last = std::find_if(all.candidates.rbegin(), all.candidates.rend(),
                                 [](const TermCandidate& one) { return one.has_states; });
  ASSERT_NE(last, all.candidates.rend());
  const ScoredCandidates alone =
      scoreCandidates(experiment, recordings, kTrueCart, {CandidateKinds::kAll, {last->term}});
  ASSERT_FALSE(alone.candidates.empty());
  const auto first = std::find_if(all.candidates.begin(), all.candidates.end(),
                                  [&](const TermCandidate& one) { return one.term == last->term; });
  const TermScore& expected = alone.scores.front();
  const TermScore& score = all.scores[static_cast<std::size_t>(first - all.candidates.begin())];
  ASSERT_TRUE(expected.visible);
  EXPECT_NEAR(score.stddev, expected.stddev, 1e-4 * expected.stddev);
  EXPECT_NEAR(score.estimate, expected.estimate, 1e-3 * expected.stddev);
}

}  // namespace
}  // namespace twinmap
