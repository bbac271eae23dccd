#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/report/estimate_panel.hpp"
#include "framework/report/history/history.hpp"
#include "framework/report/recording_figures.hpp"

namespace twinmap {

/// What was inferred of one measurement.
struct ShownInference {
  std::string source;                     ///< its file, and its start where there are several
  std::vector<std::string> verdict;       ///< its status and what is said of it, line by line
  std::vector<ParameterSpec> parameters;  ///< unknown ones, the nuisance parameters last
  std::vector<ShownEstimate> estimates;   ///< of each; empty where nothing is believed
  std::optional<ShownRecording> recording;
};

/// A page of inferred measurements: of several, each parameter over the measurements, estimates with their 95
/// % intervals, the course that fits them (fitCourses) and a table of all; then of each its verdict, the
/// estimates within their bounds, and measured over fitted with the residual and its spectrum. Of more than
/// twelve measurements the first ten and the last two are drawn. `title`: the experiment's.
std::string makeHistoryPage(const std::string& title, const History& history,
                            const std::optional<std::vector<Course>>& courses,
                            const std::vector<ShownInference>& shown);

}  // namespace twinmap
