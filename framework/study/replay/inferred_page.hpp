#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/report/history/history.hpp"
#include "framework/study/replay/replay.hpp"

namespace twinmap {

/// A measurement as the page of what was inferred shows it.
struct DrawnMeasurement {
  std::string name;                ///< its file, and where it starts if several do
  std::optional<Replay> replay{};  ///< none where it cannot be drawn
  std::string text{};              ///< what the table says of it, where there is no replay
};

/// So many are drawn; of others the estimates are.
constexpr std::size_t kMostDrawn = 12;

/// One self-contained page: of each measurement the chapters of a replay's page, measured over fitted with
/// residuals and their spectrum; of several the parameters over them too, and profiles where there are some.
std::string makeInferredPage(const std::string& title, const MeasurementReader& reader,
                             const std::vector<DrawnMeasurement>& drawn, const History& history,
                             const std::optional<std::vector<Course>>& courses);

}  // namespace twinmap
