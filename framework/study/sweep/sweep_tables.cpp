#include "framework/study/sweep/sweep_tables.hpp"

#include <algorithm>
#include <cmath>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/csv.hpp"
#include "framework/base/text/escape.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/base/text/number_with_error.hpp"
#include "framework/base/text/text_tables.hpp"
#include "framework/experiment/parameter_figures.hpp"
#include "framework/study/sweep/sweep_folder.hpp"

namespace twinmap {
namespace {

namespace fs = std::filesystem;
using Row = std::vector<std::string>;

constexpr const char* kSeed = "seed";

/// The metrics of one parameter in one case.
struct CaseRow {
  const SweepCase* of;
  const CsvTable* metrics;
  std::size_t row;  ///< in metrics
};

/// The rows that differ in their seed alone.
struct SeedGroup {
  Row values;  ///< of the other swept keys
  std::string parameter, unit;
  std::vector<CaseRow> rows;
};

struct MeanOverSeeds {
  double mean = NAN, standard_error = NAN;
};

std::vector<CsvTable> readMetrics(const fs::path& folder, const std::vector<SweepCase>& cases,
                                  const std::vector<bool>& complete) {
  std::vector<CsvTable> tables(cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (complete[i]) {
      tables[i] = readCsvFile(getCaseFolder(folder, cases[i]) / "metrics.csv");
    }
  }
  return tables;
}

std::vector<CaseRow> listRows(const std::vector<SweepCase>& cases, const std::vector<CsvTable>& metrics) {
  std::vector<CaseRow> rows;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (std::size_t row = 0; row < metrics[i].rows.size(); ++row) {
      rows.push_back({&cases[i], &metrics[i], row});
    }
  }
  return rows;
}

/// The columns of all tables: those of the first, then what others have beyond.
Row uniteColumns(const std::vector<CsvTable>& tables) {
  Row columns;
  for (const CsvTable& table : tables) {
    for (const std::string& column : table.columns) {
      if (std::find(columns.begin(), columns.end(), column) == columns.end()) {
        columns.push_back(column);
      }
    }
  }
  return columns;
}

std::string makeSweepCsv(const std::vector<std::string>& keys, const std::vector<CaseRow>& rows,
                         const Row& columns) {
  std::vector<Row> table{{"case"}};
  table[0].insert(table[0].end(), keys.begin(), keys.end());
  table[0].insert(table[0].end(), columns.begin(), columns.end());
  for (const CaseRow& row : rows) {
    table.push_back({row.of->name});
    table.back().insert(table.back().end(), row.of->values.begin(), row.of->values.end());
    for (const std::string& column : columns) {
      table.back().push_back(row.metrics->getText(row.row, column));
    }
  }
  return makeCsv(table);
}

Row withoutSeed(const Row& values, const std::vector<std::string>& keys) {
  Row others;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (keys[k] != kSeed) {
      others.push_back(values[k]);
    }
  }
  return others;
}

/// In the order of their first rows.
std::vector<SeedGroup> groupSeeds(const std::vector<std::string>& keys, const std::vector<CaseRow>& rows) {
  std::vector<SeedGroup> groups;
  for (const CaseRow& row : rows) {
    const Row values = withoutSeed(row.of->values, keys);
    const std::string& parameter = row.metrics->getText(row.row, "parameter");
    auto found = std::find_if(groups.begin(), groups.end(), [&](const SeedGroup& group) {
      return group.parameter == parameter && group.values == values;
    });
    if (found == groups.end()) {
      groups.push_back({values, parameter, row.metrics->getText(row.row, "unit"), {}});
      found = groups.end() - 1;
    }
    found->rows.push_back(row);
  }
  return groups;
}

/// Mean, and standard deviation over the root of the number; NaN where there are too few figures.
MeanOverSeeds calcEstimate(const SeedGroup& group, const std::string& column) {
  std::vector<double> values;
  for (const CaseRow& row : group.rows) {
    values.push_back(row.metrics->getNumber(row.row, column));
  }
  const auto count = static_cast<double>(values.size());
  double mean = 0.0, squares = 0.0;
  for (const double value : values) {
    mean += value / count;
  }
  for (const double value : values) {
    squares += (value - mean) * (value - mean);
  }
  return {mean, count > 1 ? std::sqrt(squares / (count - 1.0) / count) : NAN};
}

std::string toCell(double value) {
  return std::isfinite(value) ? toText(value) : "";
}

/// The columns of metrics.csv that hold figures.
Row selectFigures(const Row& columns) {
  const Row others{"parameter", "unit", "lower", "upper", "test_samples"};
  Row figures;
  for (const std::string& column : columns) {
    const bool is_error = column.size() > 3 && column.compare(column.size() - 3, 3, "_se") == 0;
    if (!is_error && std::find(others.begin(), others.end(), column) == others.end()) {
      figures.push_back(column);
    }
  }
  return figures;
}

std::string makeSummaryCsv(const std::vector<std::string>& keys, const std::vector<SeedGroup>& groups,
                           const Row& figures) {
  std::vector<Row> table{withoutSeed(keys, keys)};
  table[0].insert(table[0].end(), {"parameter", "unit", "cases"});
  for (const std::string& figure : figures) {
    table[0].insert(table[0].end(), {figure, figure + "_se"});
  }
  for (const SeedGroup& group : groups) {
    Row row = group.values;
    row.insert(row.end(), {group.parameter, group.unit, std::to_string(group.rows.size())});
    for (const std::string& figure : figures) {
      const MeanOverSeeds estimate = calcEstimate(group, figure);
      row.insert(row.end(), {toCell(estimate.mean), toCell(estimate.standard_error)});
    }
    table.push_back(row);
  }
  return makeCsv(table);
}

std::string makeSweepTable(const std::vector<std::string>& keys, const std::vector<SeedGroup>& groups,
                           const Row& figures) {
  std::vector<Row> table{withoutSeed(keys, keys)};
  const std::size_t text_columns = table[0].size() + 2;
  table[0].insert(table[0].end(), {"parameter", "unit", "cases"});
  for (const SeedGroup& group : groups) {
    table.push_back(group.values);
    table.back().insert(table.back().end(), {group.parameter, group.unit, std::to_string(group.rows.size())});
  }
  for (const FigureColumn& column : kFigureColumns) {
    if (column.in_print == InPrint::kOmitted ||
        std::find(figures.begin(), figures.end(), column.name) == figures.end()) {
      continue;
    }
    table[0].emplace_back(column.heading);
    for (std::size_t i = 0; i < groups.size(); ++i) {
      const MeanOverSeeds estimate = calcEstimate(groups[i], column.name);
      table[i + 1].push_back(toTextWithError(estimate.mean, estimate.standard_error, column.decimals));
    }
  }
  for (Row& row : table) {
    std::transform(row.begin(), row.end(), row.begin(), escapeMarkdown);
  }
  return makeMarkdownRows(table, text_columns) +
         "\nMeans over the cases that differ in their seed alone; in parentheses: the standard error of the "
         "last digits.\n";
}

}  // namespace

std::string writeSweepTables(const fs::path& folder, const std::vector<std::string>& keys,
                             const std::vector<SweepCase>& cases, const std::vector<bool>& complete) {
  const std::vector<CsvTable> metrics = readMetrics(folder, cases, complete);
  const std::vector<CaseRow> rows = listRows(cases, metrics);
  const Row columns = uniteColumns(metrics);
  const std::vector<SeedGroup> groups = groupSeeds(keys, rows);
  const std::string table = makeSweepTable(keys, groups, selectFigures(columns));
  writeTextFile(folder / "sweep.csv", makeSweepCsv(keys, rows, columns));
  writeTextFile(folder / "summary.csv", makeSummaryCsv(keys, groups, selectFigures(columns)));
  writeTextFile(folder / "table.md", table);
  return table;
}

}  // namespace twinmap
