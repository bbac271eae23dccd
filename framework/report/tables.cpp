#include "framework/report/tables.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "framework/report/escape.hpp"
#include "framework/spec/number_text.hpp"

namespace twinmap {
namespace {

using Row = std::vector<std::string>;

std::string joinRow(const Row& cells, const std::string& separator,
                    std::string (*escape)(const std::string&)) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    line += (i == 0 ? "" : separator) + escape(cells[i]);
  }
  return line;
}

std::string makeCsv(const std::vector<Row>& rows) {
  std::string text;
  for (const Row& row : rows) {
    text += joinRow(row, ",", escapeCsv) + "\n";
  }
  return text;
}

std::string toFixedText(double value, int decimals) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

constexpr int kBoundDigits = 6;
constexpr int kPercentDecimals = 4;  // as in the paper
constexpr int kCoverageDecimals = 3;

Row makeHeader() {
  return {"parameter", "unit", "lower", "upper", "bias %", "sd %", "MARE %", "coverage 95 %"};
}

Row makeRow(const ParameterSpec& parameter, const ParameterMetrics& metrics) {
  return {parameter.name.text,
          parameter.unit,
          toShortText(parameter.bounds.lower, kBoundDigits),
          toShortText(parameter.bounds.upper, kBoundDigits),
          toFixedText(metrics.bias_pct, kPercentDecimals),
          toFixedText(metrics.sd_pct, kPercentDecimals),
          toFixedText(metrics.mare_pct, kPercentDecimals),
          toFixedText(metrics.coverage95, kCoverageDecimals)};
}

/// "| a | b |" with every cell padded to its column's width: names to the left, numbers to the right.
std::string padRow(const Row& cells, const std::vector<std::size_t>& widths) {
  constexpr std::size_t kTextColumns = 2;
  std::string line = "|";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string padding(widths[i] - cells[i].size(), ' ');
    line += " " + (i < kTextColumns ? cells[i] + padding : padding + cells[i]) + " |";
  }
  return line + "\n";
}

}  // namespace

std::string makeMetricsCsv(const RunSummary& run) {
  std::vector<Row> rows{{"parameter", "unit", "lower", "upper", "bias_pct", "sd_pct", "mare_pct",
                         "coverage95", "coverage90", "coverage50", "stddev_pct", "z_mean", "z_sd", "nlpd",
                         "nlml", "test_samples"}};
  for (std::size_t p = 0; p < run.parameters.size(); ++p) {
    const ParameterSpec& parameter = run.parameters[p];
    const ParameterMetrics& m = run.metrics[p];
    Row row{parameter.name.text, parameter.unit};
    for (const double value :
         {parameter.bounds.lower, parameter.bounds.upper, m.bias_pct, m.sd_pct, m.mare_pct, m.coverage95,
          m.coverage90, m.coverage50, m.stddev_pct, m.z_mean, m.z_sd, m.nlpd, run.nlml[p]}) {
      row.push_back(toText(value));
    }
    row.push_back(std::to_string(m.samples));
    rows.push_back(row);
  }
  return makeCsv(rows);
}

std::string makePredictionsCsv(const RunSummary& run) {
  std::vector<Row> rows{{"sample", "parameter", "true", "inferred", "stddev"}};
  for (std::size_t i = 0; i < run.test_indices.size(); ++i) {
    for (std::size_t p = 0; p < run.parameters.size(); ++p) {
      const auto row = static_cast<Eigen::Index>(p);
      const auto column = static_cast<Eigen::Index>(i);
      rows.push_back({std::to_string(run.test_indices[i]), run.parameters[p].name.text,
                      toText(run.truth(row, column)), toText(run.predictions.mean(row, column)),
                      toText(run.predictions.stddev(row, column))});
    }
  }
  return makeCsv(rows);
}

std::string makeFailuresCsv(const RunSummary& run) {
  Row header{"set", "sample"};
  for (const ParameterSpec& parameter : run.parameters) {
    header.push_back(parameter.name.text);
  }
  header.emplace_back("reason");
  std::vector<Row> rows{header};
  for (const FailedSample& failure : run.failures) {
    Row row{failure.set, std::to_string(failure.sample)};
    for (const double value : failure.parameters) {
      row.push_back(toText(value));
    }
    row.push_back(failure.reason);
    rows.push_back(row);
  }
  return makeCsv(rows);
}

std::string makeTrainingCsv(const RunSummary& run) {
  std::vector<Row> rows{{"parameter", "start", "best", "nlml", "evaluations", "noise_only", "stop_reason",
                         "at_bound", "condition", "jitter"}};
  for (const TrainingStart& start : run.training) {
    rows.push_back({start.parameter, std::to_string(start.start), start.best ? "1" : "0", toText(start.nlml),
                    std::to_string(start.evaluations), start.noise_only ? "1" : "0", start.stop_reason,
                    start.at_bound, start.best ? toText(start.condition) : "",
                    start.best ? toText(start.jitter) : ""});
  }
  return makeCsv(rows);
}

std::string makeMarkdownTable(const RunSummary& run) {
  std::vector<Row> rows{makeHeader()};
  for (std::size_t p = 0; p < run.parameters.size(); ++p) {
    rows.push_back(makeRow(run.parameters[p], run.metrics[p]));
    for (std::string& cell : rows.back()) {
      cell = escapeMarkdown(cell);
    }
  }
  std::vector<std::size_t> widths(rows[0].size(), 0);
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], row[i].size());
    }
  }
  std::string text = padRow(rows[0], widths) + "|";
  for (std::size_t i = 0; i < widths.size(); ++i) {
    text += i < 2 ? std::string(widths[i] + 2, '-') + "|" : std::string(widths[i] + 1, '-') + ":|";
  }
  text += "\n";
  for (std::size_t i = 1; i < rows.size(); ++i) {
    text += padRow(rows[i], widths);
  }
  return text;
}

std::string makeLatexTable(const RunSummary& run) {
  std::string text = "\\begin{tabular}{llrrrrrr}\n\\toprule\n";
  const auto add_row = [&text](const Row& row) { text += joinRow(row, " & ", escapeLatex) + " \\\\\n"; };
  add_row(makeHeader());
  text += "\\midrule\n";
  for (std::size_t p = 0; p < run.parameters.size(); ++p) {
    add_row(makeRow(run.parameters[p], run.metrics[p]));
  }
  return text + "\\bottomrule\n\\end{tabular}\n";
}

}  // namespace twinmap
