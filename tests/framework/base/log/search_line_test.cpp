#include "framework/base/log/search_line.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "framework/base/log/search_stage.hpp"

namespace twinmap {
namespace {

/// When lines are written in so many seconds of a clock that ticks ten times a second, and the lines.
struct Watched {
  std::vector<double> times;
  std::vector<std::string> lines;
};

Watched watch(std::size_t width, double seconds) {
  Watched watched;
  double now = 0.0;
  SearchLine line(width, [&](const std::string& text) {
    watched.times.push_back(now);
    watched.lines.push_back(text);
  });
  for (int tick = 1; tick <= static_cast<int>(10.0 * seconds); ++tick) {
    now = 0.1 * tick;
    line.tick(now);
  }
  return watched;
}

TEST(SearchLine, IsNeverSilentForMoreThanFiveSecondsOfTenMinutes) {
  constexpr double kSeconds = 600.0;
  const SearchStage stage("infer m.csv");
  const Watched watched = watch(0, kSeconds);
  EXPECT_NEAR(watched.times.front(), 2.0, 0.11);
  for (std::size_t i = 1; i < watched.times.size(); ++i) {
    EXPECT_NEAR(watched.times[i] - watched.times[i - 1], 5.0, 0.11);
  }
  EXPECT_GT(watched.times.back(), kSeconds - 5.11);
  EXPECT_EQ(watched.lines.front(), "twinmap: infer m.csv, 0:02\n");
}

TEST(SearchLine, IsRenewedInPlaceOnATerminalAndRemoved) {
  const SearchStage stage("infer a recording with a name that is longer than the terminal is wide");
  std::string screen;
  SearchLine line(40, [&screen](const std::string& text) { screen += text; });
  line.clear();
  EXPECT_EQ(screen, "");  // nothing to remove
  line.tick(2.0);
  line.tick(2.1);
  line.tick(2.6);
  EXPECT_EQ(screen.find('\n'), std::string::npos);
  const std::string shown = kClearLine + std::string("infer a recording with a name that is l");
  EXPECT_EQ(screen, shown + shown);
  line.clear();
  EXPECT_EQ(screen, shown + shown + kClearLine);
}

TEST(SearchLine, WaitsWhereAnotherLineWasWritten) {
  const SearchStage stage("train the surrogate");
  std::vector<std::string> lines;
  SearchLine line(0, [&lines](const std::string& text) { lines.push_back(text); });
  line.note(10.0);
  line.tick(14.9);
  EXPECT_TRUE(lines.empty());
  line.tick(15.1);
  EXPECT_EQ(lines, std::vector<std::string>{"twinmap: train the surrogate, 0:16\n"});
}

TEST(SearchLine, SaysNothingOfAQuickCommandOrOfNothing) {
  EXPECT_TRUE(watch(0, 60.0).lines.empty());
  const SearchStage stage("infer m.csv");
  EXPECT_TRUE(watch(0, 1.9).lines.empty());
}

}  // namespace
}  // namespace twinmap
