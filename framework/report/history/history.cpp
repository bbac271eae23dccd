#include "framework/report/history/history.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "framework/base/text/number_text.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd collectFigures(const History& history, std::size_t parameter, VectorXd HistoryPoint::*figure) {
  const std::vector<std::size_t> counted = listCounted(history);
  VectorXd values(static_cast<Index>(counted.size()));
  for (std::size_t i = 0; i < counted.size(); ++i) {
    values[static_cast<Index>(i)] = (history.points[counted[i]].*figure)[static_cast<Index>(parameter)];
  }
  return values;
}

VectorXd collectPlaces(const History& history) {
  const std::vector<double> all = listPlaces(history);
  const std::vector<std::size_t> counted = listCounted(history);
  VectorXd places(static_cast<Index>(counted.size()));
  for (std::size_t i = 0; i < counted.size(); ++i) {
    places[static_cast<Index>(i)] = all[counted[i]];
  }
  return places;
}

std::string withUnit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + " " + unit;
}

/// "measurement 23", "30 s".
std::string describePlace(const History& history, Index counted) {
  const std::size_t point = listCounted(history)[static_cast<std::size_t>(counted)];
  constexpr int kDigits = 6;
  return isOneFile(history) ? toShortText(history.points[point].start, kDigits) + " s"
                            : fmt::format("measurement {}", point + 1);
}

/// The scatter, where it is no longer that of the stated standard deviations.
std::string describeScatter(const Course& course, Index count) {
  constexpr double kSds = 2.5;  // of the scatter of `count` normal numbers, 1 in 100 is above
  const double expected = 1.0 + kSds / std::sqrt(2.0 * static_cast<double>(count));
  return course.scatter > expected
             ? fmt::format("; the estimates scatter by {:.2g} of their stated sd", course.scatter)
             : "";
}

}  // namespace

bool isOneFile(const History& history) {
  const std::vector<HistoryPoint>& points = history.points;
  return points.size() > 1 && std::all_of(points.begin(), points.end(), [&](const HistoryPoint& point) {
           return point.source == points.front().source;
         });
}

std::vector<double> listPlaces(const History& history) {
  std::vector<double> places;
  const bool times = isOneFile(history);
  for (const HistoryPoint& point : history.points) {
    places.push_back(times ? point.start : static_cast<double>(places.size() + 1));
  }
  return places;
}

std::vector<std::size_t> listCounted(const History& history) {
  std::vector<std::size_t> counted;
  for (std::size_t i = 0; i < history.points.size(); ++i) {
    if (history.points[i].counts) {
      counted.push_back(i);
    }
  }
  return counted;
}

std::optional<std::vector<Course>> fitCourses(const History& history) {
  constexpr double kLevel = 0.01;
  const VectorXd places = collectPlaces(history);
  const bool increase =
      std::adjacent_find(places.begin(), places.end(), std::greater_equal<>()) == places.end();
  if (places.size() < kFewestOfCourse || !increase) {
    return std::nullopt;
  }
  std::vector<Course> courses;
  for (std::size_t p = 0; p < history.parameters.size(); ++p) {
    courses.push_back(fitCourse(collectFigures(history, p, &HistoryPoint::mean),
                                collectFigures(history, p, &HistoryPoint::stddev), places,
                                kLevel / static_cast<double>(history.parameters.size())));
  }
  return courses;
}

std::string describeCourse(const History& history, std::size_t parameter, const Course& course) {
  constexpr double kPercent = 100.0;
  const ParameterSpec& of = history.parameters[parameter];
  const std::string scatter = describeScatter(course, course.fitted.size());
  if (course.shape == CourseShape::kConstant) {
    const VectorXd weights =
        collectFigures(history, parameter, &HistoryPoint::stddev).cwiseAbs2().cwiseInverse();
    const double stddev = std::max(1.0, course.scatter) / std::sqrt(weights.sum());
    return fmt::format("{} is constant, {} (sd {}){}", of.name.text,
                       withUnit(toShortText(course.fitted[0], kEstimateDigits), of.unit),
                       toShortText(stddev, kRoughDigits), scatter);
  }
  const double before = course.fitted[0];
  const std::string relative =
      before == 0.0 ? "" : toShortText(kPercent * std::abs(course.change / before), kRoughDigits) + " %, ";
  const bool is_step = course.shape == CourseShape::kStep;
  return fmt::format("{} {} by {} ({}sd {}) {} {}{}{}", of.name.text, course.change > 0.0 ? "rose" : "fell",
                     withUnit(toShortText(std::abs(course.change), kRoughDigits + 1), of.unit), relative,
                     toShortText(course.change_stddev, kRoughDigits),
                     is_step ? "at once, at" : "steadily, from", describePlace(history, course.begins),
                     is_step ? "" : " on", scatter);
}

std::string describeCourses(const History& history, const std::optional<std::vector<Course>>& courses) {
  if (!courses) {
    return "";
  }
  std::string text = fmt::format("Over {} of {} measurements (a change is false in 1 of 100):\n",
                                 listCounted(history).size(), history.points.size());
  for (std::size_t p = 0; p < courses->size(); ++p) {
    text += "  " + describeCourse(history, p, (*courses)[p]) + "\n";
  }
  return text;
}

}  // namespace twinmap
