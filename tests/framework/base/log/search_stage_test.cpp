#include "framework/base/log/search_stage.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace twinmap {
namespace {

TEST(SearchStage, TellsWhatIsDoneOfWhatAndTheBestFit) {
  const SearchStage file("diagnose m.csv from 5 s");
  SearchStage fits("fit the best candidates", 6);
  fits.advance();
  fits.advance();
  beginBest({"k", "m"});
  noteBest(512.25, 396.0, {14.25, 3.0});
  noteBest(900.0, 396.0, {1.0, 1.0});  // worse
  noteSimulations(40);
  const SearchState state = getSearchState();
  EXPECT_EQ(describeState(state),
            "diagnose m.csv from 5 s: fit the best candidates, 2 of 6, chi-square 512.2 of 396 at best, 40 "
            "simulations");
  EXPECT_EQ(describeBest(state), "k = 14.25, m = 3");
  noteStddevs({0.31});
  noteBest(512.0, 396.0, {14.5, 3.0});
  EXPECT_EQ(describeBest(getSearchState()), "k = 14.5 (sd 0.31), m = 3");
}

TEST(SearchStage, EndsWithItsScope) {
  {
    const SearchStage outer("outer");
    {
      const SearchStage inner("inner", 3);
      EXPECT_EQ(describeState(getSearchState()), "outer: inner, 0 of 3");
    }
    EXPECT_EQ(describeState(getSearchState()), "outer");
  }
  EXPECT_TRUE(getSearchState().stages.empty());
}

TEST(SearchStage, KeepsTheBestFitWhileAnotherNoiseOrClockIsSupposed) {
  const SearchStage stage("infer");
  beginBest({"k"});
  noteBest(1e8, 790.0, {2.0});
  {
    const SearchStage other = SearchStage::supposing("does another noise explain it");
    beginBest({"k", "scale"});
    noteBest(800.0, 789.0, {3.0, 1e5});
    EXPECT_EQ(describeBest(getSearchState()), "k = 2");
  }
  noteBest(1e7, 790.0, {2.5});
  EXPECT_EQ(describeBest(getSearchState()), "k = 2.5");
}

TEST(SearchStage, ForgetsTheBestFitOfAnEarlierSearch) {
  const SearchStage stage("search");
  beginBest({"k"});
  noteBest(1.0, 10.0, {2.0});
  beginBest({"d"});
  EXPECT_EQ(describeBest(getSearchState()), "");
  noteBest(5.0, 10.0, {1.0, 2.0});  // of another search's parameters
  EXPECT_EQ(describeBest(getSearchState()), "");
  noteBest(5.0, 10.0, {1.0});
  EXPECT_EQ(describeBest(getSearchState()), "d = 1");
}

TEST(SearchStage, TellsOfOneThreadAndCountsSimulationsOfAll) {
  SearchStage stage("each recording alone", 4);
  beginBest({"k"});
  std::thread other([&stage] {
    const SearchStage own("search for the best fit");
    beginBest({"d"});
    noteBest(1.0, 10.0, {3.0});
    noteSimulations(7);
    stage.show(1, 4);
    EXPECT_EQ(getSearchState().stages.size(), 1u);
  });
  other.join();
  const SearchState state = getSearchState();
  EXPECT_EQ(describeState(state), "each recording alone, 1 of 4, 7 simulations");
  EXPECT_FALSE(state.best.has_value());
}

TEST(Duration, IsInMinutesAndHours) {
  EXPECT_EQ(describeDuration(0.2), "0:01");
  EXPECT_EQ(describeDuration(61.0), "1:01");
  EXPECT_EQ(describeDuration(3723.0), "1:02:03");
}

}  // namespace
}  // namespace twinmap
