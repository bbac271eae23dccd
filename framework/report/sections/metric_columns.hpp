#pragma once

#include <string>
#include <vector>

#include "framework/base/text/csv_file.hpp"
#include "framework/report/html.hpp"

namespace twinmap {

/// Significant digits of metrics in tables.
inline constexpr int kMetricDigits = 4;

/// A column of metrics.csv and how people call it.
struct MetricColumn {
  std::string name;
  std::string heading;
};
const std::vector<MetricColumn>& getMetricColumns();

/// Headings and cells of those that the file has, in their order.
std::vector<std::string> makeMetricHeadings(const CsvTable& metrics);
std::vector<HtmlCell> makeMetricCells(const CsvTable& metrics, std::size_t row);

}  // namespace twinmap
