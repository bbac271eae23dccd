#include "framework/study/replay/replay_files.hpp"

#include <cmath>
#include <sstream>

#include "framework/base/text/csv.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/text_tables.hpp"

namespace twinmap {
namespace {

using Eigen::Index;

std::string makeCsvCell(double value) {
  return std::isfinite(value) ? toText(value) : "";
}

}  // namespace

std::string makeReplayCsv(const Replay& replay) {
  std::vector<CsvRow> rows{
      {"output", "time", "measured", "nominal", "updated", "lower", "upper", "noise_stddev"}};
  for (Index output = 0; output < replay.layout.getOutputCount(); ++output) {
    for (Index time = 0; time < replay.layout.times.size(); ++time) {
      const Index row = replay.layout.getRow(output, time);
      rows.push_back({replay.layout.output_names[static_cast<std::size_t>(output)]});
      for (const double value :
           {replay.layout.times[time], replay.measured[row], replay.nominal.response[row],
            replay.updated.response[row], replay.lower[row], replay.upper[row], replay.noise_stddev[row]}) {
        rows.back().push_back(makeCsvCell(value));
      }
    }
  }
  return makeCsv(rows);
}

std::string makeResidualsCsv(const Replay& replay) {
  const ResponseLayout& layout = replay.layout;
  const Eigen::VectorXd residuals = replay.measured - replay.updated.response;
  std::vector<Column> columns{{"t", "s", layout.times}};
  for (std::size_t o = 0; o < layout.output_names.size(); ++o) {
    const std::string& unit = layout.output_units[o];
    columns.push_back({layout.output_names[o], unit.empty() ? std::nullopt : std::make_optional(unit),
                       residuals.segment(layout.getRow(static_cast<Index>(o), 0), layout.times.size())});
  }
  std::ostringstream text;
  writeTable(text, columns);
  return text.str();
}

std::vector<std::vector<std::string>> listFits(const Replay& replay) {
  std::vector<CsvRow> rows{{"output", "nrmse_pct", "rms_residual_sd", "largest_residual_sd",
                            "nominal_nrmse_pct", "nominal_rms_residual_sd", "nominal_largest_residual_sd"}};
  for (std::size_t o = 0; o < replay.layout.output_names.size(); ++o) {
    rows.push_back({replay.layout.output_names[o]});
    for (const ReplayedModel* model : {&replay.updated, &replay.nominal}) {
      const OutputFit& fit = model->fits[o];
      for (const double value : {fit.nrmse_pct, fit.rms_sd, fit.largest_sd}) {
        rows.back().push_back(makeCsvCell(value));
      }
    }
  }
  return rows;
}

std::string makeFitTable(const Replay& replay) {
  constexpr int kDigits = 4;
  std::vector<CsvRow> rows = listFits(replay);
  rows[0] = {"output",          "NRMSE %",        "rms / noise sd",    "largest / noise sd",
             "nominal NRMSE %", "rms / noise sd", "largest / noise sd"};
  for (std::size_t row = 1; row < rows.size(); ++row) {
    for (std::size_t column = 1; column < rows[row].size(); ++column) {
      double value = 0.0;
      std::string& cell = rows[row][column];
      cell = parseLiteral(cell, value) ? toShortText(value, kDigits) : "-";
    }
  }
  return makeMarkdownRows(rows, 1);
}

}  // namespace twinmap
