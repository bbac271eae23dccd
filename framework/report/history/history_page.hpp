#pragma once

#include "framework/report/figure.hpp"
#include "framework/report/history/history.hpp"

namespace twinmap {

/// The chapters of each parameter over the measurements: estimates with their 95 % intervals, the course that
/// fits them (fitCourses), and a table of all.
void addHistory(const History& history, const std::optional<std::vector<Course>>& courses, Page& page);

/// A chapter with the profile likelihoods of each measurement; none where none were asked for.
void addProfiles(const History& history, Page& page);

}  // namespace twinmap
