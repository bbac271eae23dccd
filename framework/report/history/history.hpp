#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "framework/analysis/course.hpp"
#include "framework/experiment/model/parameter_spec.hpp"

namespace twinmap {

/// The profile likelihood of a parameter at its values: the log of the posterior density over the largest.
struct HistoryProfile {
  std::size_t parameter = 0;
  Eigen::VectorXd values, log_ratios;
};

/// What one measurement says of the parameters.
struct HistoryPoint {
  std::string source;  ///< its file
  double start = 0.0;  ///< s; time in the file
  std::string status;  ///< "ok", "model_mismatch", ...
  bool counts = true;  ///< in the courses: false where a status says that the estimate misleads
  Eigen::VectorXd mean, stddev, lower95, upper95;
  std::vector<HistoryProfile> profiles = {};  ///< where they were asked for
};

/// Estimates of one machine in the order of their measurements.
struct History {
  std::vector<ParameterSpec> parameters;
  std::vector<HistoryPoint> points;
};

/// Whether all points are windows of one file: their places are its times then, else their numbers from 1 on.
bool isOneFile(const History& history);

/// The place of each point: its start (s) in a file, or its number.
std::vector<double> listPlaces(const History& history);

/// The points that count.
std::vector<std::size_t> listCounted(const History& history);

/// How each parameter went over the points that count, false alarms 1 % over all parameters together; none
/// where fewer than kFewestOfCourse count, or their places do not increase.
std::optional<std::vector<Course>> fitCourses(const History& history);

/// "k fell by 0.21 N/m (2.1 %, sd 0.02 N/m) from measurement 23 on", "d is constant, 1.2001 N s/m (sd
/// 0.0003)", with the scatter where that is larger than stated.
std::string describeCourse(const History& history, std::size_t parameter, const Course& course);

/// A line for each parameter, below one that says how many measurements it rests on; "" without courses.
std::string describeCourses(const History& history, const std::optional<std::vector<Course>>& courses);

}  // namespace twinmap
