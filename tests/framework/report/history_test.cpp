#include "framework/report/history/history.hpp"

#include <gtest/gtest.h>

#include "framework/base/random/random.hpp"
#include "framework/report/history/history_page.hpp"

namespace twinmap {
namespace {

constexpr double kStddev = 0.1;

/// Twelve measurements of k, which falls by `step` at the seventh, the third with a status that warns of it.
History makeHistory(double step) {
  History history;
  history.parameters.resize(1);
  history.parameters[0].name.text = "k";
  history.parameters[0].unit = "N/m";
  const RandomStream random(3, RandomPurpose::kTestNoise);
  for (int i = 0; i < 12; ++i) {
    const double value =
        (i < 6 ? 10.0 : 10.0 - step) + kStddev * random.calcNormal(static_cast<std::uint64_t>(i), 0);
    const Eigen::VectorXd mean = Eigen::VectorXd::Constant(1, value),
                          sd = Eigen::VectorXd::Constant(1, kStddev);
    history.points.push_back({"m" + std::to_string(i + 1) + ".csv", 0.0, "ok", true, mean, sd,
                              mean - 1.96 * sd, mean + 1.96 * sd});
  }
  history.points[2].counts = false;
  history.points[2].status = "model_mismatch";
  history.points[2].mean[0] = 100.0;
  return history;
}

std::string makeHistoryPage(const std::string& title, const History& history,
                            const std::optional<std::vector<Course>>& courses) {
  Page page;
  page.title = title;
  addHistory(history, courses, page);
  addProfiles(history, page);
  return makePage(page);
}

TEST(History, NamesAChangeAndWhereItBegins) {
  const std::string text = describeCourses(makeHistory(2.0), fitCourses(makeHistory(2.0)));
  EXPECT_EQ(text.find("Over 11 of 12 measurements (a change is false in 1 of 100):\n  k fell by "), 0U)
      << text;
  EXPECT_NE(text.find(" at once, at measurement 7\n"), std::string::npos) << text;
}

TEST(History, WithoutAChangeIsConstant) {
  EXPECT_NE(describeCourses(makeHistory(0.0), fitCourses(makeHistory(0.0))).find("\n  k is constant, "),
            std::string::npos);
}

TEST(History, OfWindowsOfOneFileIsOverTime) {
  History history = makeHistory(2.0);
  for (std::size_t i = 0; i < history.points.size(); ++i) {
    history.points[i].source = "a.csv";
    history.points[i].start = 5.0 * static_cast<double>(i);
  }
  EXPECT_NE(describeCourses(history, fitCourses(history)).find(" at once, at 30 s\n"), std::string::npos);
  history.points[4].start = 100.0;  // not in the order of time
  EXPECT_EQ(describeCourses(history, fitCourses(history)), "");
}

TEST(History, OfFewMeasurementsHasNoCourse) {
  History history = makeHistory(2.0);
  history.points.resize(6);  // of which five count
  EXPECT_EQ(describeCourses(history, fitCourses(history)), "");
  EXPECT_NE(makeHistoryPage("cart", history, fitCourses(history)).find("these are 5."), std::string::npos);
}

TEST(History, PageSaysTheCourseFirst) {
  const std::string page = makeHistoryPage("cart", makeHistory(2.0), fitCourses(makeHistory(2.0)));
  EXPECT_NE(page.find("<p class=\"lead\">k fell by "), std::string::npos);
  EXPECT_NE(page.find("model_mismatch"), std::string::npos);
}

TEST(History, PageDrawsProfilesWhereTheyWereAskedFor) {
  History history = makeHistory(0.0);
  EXPECT_EQ(makeHistoryPage("cart", history, {}).find("Profile likelihoods"), std::string::npos);
  history.points[4].profiles = {{0, Eigen::VectorXd::Constant(3, 7.5), Eigen::VectorXd::Constant(3, -1.25)}};
  const std::string page = makeHistoryPage("cart", history, {});
  EXPECT_NE(page.find("Profile likelihoods"), std::string::npos);
  EXPECT_NE(page.find("-1.25"), std::string::npos);
}

}  // namespace
}  // namespace twinmap
