#include "framework/results/responses_csv.hpp"

#include <fmt/core.h>

#include <cmath>

#include "framework/base/text/escape.hpp"
#include "framework/base/text/number_text.hpp"

namespace twinmap {
namespace {

std::string makeCell(double value) {
  return "," + (std::isfinite(value) ? toText(value) : "");
}

}  // namespace

std::string makeResponsesCsv(const std::vector<ExampleResponse>& examples, const ResponseLayout& layout,
                             const Eigen::VectorXd& row_stddev) {
  std::string csv = "case,sample,output,unit,time,measured,nominal,updated,noise_stddev\n";
  for (const ExampleResponse& example : examples) {
    for (Eigen::Index output = 0; output < layout.getOutputCount(); ++output) {
      const auto o = static_cast<std::size_t>(output);
      const std::string start =
          fmt::format("{},{},{},{}", example.name, example.sample, escapeCsv(layout.output_names[o]),
                      escapeCsv(layout.output_units[o]));
      for (Eigen::Index time = 0; time < layout.times.size(); ++time) {
        const Eigen::Index row = layout.getRow(output, time);
        if (std::isnan(example.measured[row])) {
          continue;
        }
        csv += start + makeCell(layout.times[time]) + makeCell(example.measured[row]) +
               makeCell(example.nominal[row]) + makeCell(example.updated[row]) + makeCell(row_stddev[row]) +
               "\n";
      }
    }
  }
  return csv;
}

}  // namespace twinmap
