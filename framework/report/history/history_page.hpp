#pragma once

#include <string>

#include "framework/report/history/history.hpp"

namespace twinmap {

/// A page with each parameter over the measurements: estimates with their 95 % intervals, the course that
/// fits them (fitCourses), and a table of all. `title`: the experiment's.
std::string makeHistoryPage(const std::string& title, const History& history,
                            const std::optional<std::vector<Course>>& courses);

}  // namespace twinmap
