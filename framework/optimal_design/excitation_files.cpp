#include "framework/optimal_design/excitation_files.hpp"

#include <fmt/core.h>

#include <cmath>

#include "framework/base/files/atomic_file.hpp"
#include "framework/base/text/csv.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/simulation/excitation/calc_input_signals.hpp"

namespace twinmap::experiment_design {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd listMost(const std::vector<Limit>& limits) {
  return VectorXd::NullaryExpr(static_cast<Index>(limits.size()),
                               [&](Index i) { return limits[static_cast<std::size_t>(i)].most; });
}

std::string writeNumber(double value) {
  return std::isfinite(value) ? toText(value) : "";
}

/// At most every millisecond, at most 100000 times.
std::string makeSignalCsv(const ModelSpec& model) {
  constexpr double kInterval = 1e-3, kMax = 1e5;
  const double duration = model.simulation.duration;
  const auto steps = static_cast<Index>(std::min(kMax, std::ceil(duration / kInterval)));
  const InputSignals inputs = calcInputSignals(model, VectorXd::LinSpaced(steps + 1, 0.0, duration));
  std::vector<CsvRow> rows{{"t [s]"}};
  for (std::size_t s = 0; s < inputs.names.size(); ++s) {
    rows[0].push_back(inputs.names[s] + (inputs.units[s].empty() ? "" : " [" + inputs.units[s] + "]"));
  }
  for (Index i = 0; i <= steps; ++i) {
    rows.push_back({toText(duration * static_cast<double>(i) / static_cast<double>(steps))});
    for (Index s = 0; s < inputs.values.cols(); ++s) {
      rows.back().push_back(toText(inputs.values(i, s)));
    }
  }
  return makeCsv(rows);
}

struct Column {
  const char* name;
  const JudgedExcitation& judged;
};

std::vector<Column> listColumns(const ExcitationDesign& design) {
  std::vector<Column> columns{{"before", design.before}, {"after", design.after}};
  if (design.nominal.values.size() > 0) {
    columns.push_back({"nominal", design.nominal});
  }
  return columns;
}

std::string makeLimitsCsv(const ExcitationDesign& design) {
  std::vector<CsvRow> rows{{"parameter", "unit"}};
  for (const Column& column : listColumns(design)) {
    rows[0].insert(rows[0].end(),
                   {fmt::format("mean_{}", column.name), fmt::format("worst_{}", column.name)});
  }
  for (std::size_t p = 0; p < design.parameters.size(); ++p) {
    rows.push_back({design.parameters[p].name.text, design.parameters[p].unit});
    for (const Column& column : listColumns(design)) {
      const auto row = column.judged.limit.stddev.row(static_cast<Index>(p));
      rows.back().insert(rows.back().end(), {writeNumber(row.mean()), writeNumber(row.maxCoeff())});
    }
  }
  return makeCsv(rows);
}

}  // namespace

TrialFile::TrialFile(std::filesystem::path path, const std::vector<FreeNumber>& numbers,
                     const std::vector<Limit>& limits)
    : path_(std::move(path)), numbers_(numbers), limits_(limits) {
  const CsvTable table = readCsvFile(path_);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    VectorXd values(static_cast<Index>(numbers.size()));
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      values[static_cast<Index>(i)] = table.getNumber(row, numbers[i].key);
    }
    DesignScore score{table.getNumber(row, "criterion"), VectorXd(static_cast<Index>(limits.size())),
                      table.getText(row, "failure")};
    for (std::size_t i = 0; i < limits.size(); ++i) {
      score.measures[static_cast<Index>(i)] = table.getNumber(row, describe(limits[i]));
    }
    known_[makeKey(table.getText(row, "points"), values)] = score;
  }
}

std::string TrialFile::makeKey(const std::string& points, const VectorXd& values) const {
  std::string key = points;
  for (const double value : values) {
    key += " " + toText(value);
  }
  return key;
}

const DesignScore* TrialFile::find(const std::string& points, const VectorXd& values) const {
  const auto found = known_.find(makeKey(points, values));
  return found == known_.end() ? nullptr : &found->second;
}

void TrialFile::add(const std::string& points, const VectorXd& values, const DesignScore& score) {
  constexpr std::size_t kOften = 50;
  CsvRow row{std::to_string(rows_.size() + 1), points, writeNumber(score.cost),
             writeNumber(calcViolation(score, listMost(limits_))), score.failure};
  for (const double value : values) {
    row.push_back(toText(value));
  }
  for (Index i = 0; i < static_cast<Index>(limits_.size()); ++i) {
    row.push_back(score.measures.size() > i ? writeNumber(score.measures[i]) : "");
  }
  rows_.push_back(std::move(row));
  known_[makeKey(points, values)] = score;
  if (rows_.size() % kOften == 0) {
    write();
  }
}

void TrialFile::write() const {
  if (rows_.size() < known_.size()) {
    return;  // what an interrupted design tried is not all tried again yet
  }
  CsvRow header{"evaluation", "points", "criterion", "violation", "failure"};
  for (const FreeNumber& number : numbers_) {
    header.push_back(number.key);
  }
  for (const Limit& limit : limits_) {
    header.push_back(describe(limit));
  }
  std::vector<CsvRow> rows{header};
  rows.insert(rows.end(), rows_.begin(), rows_.end());
  writeTextFile(path_, makeCsv(rows));
}

void writeDesign(const std::filesystem::path& folder, const ExcitationEvaluator& evaluator,
                 const ExcitationDesign& design) {
  YamlNode tree = evaluator.makeTree(design.after.values);
  if (YamlNode* name = tree.find("name")) {
    name->scalar += "_designed";
  }
  writeTextFile(folder / "designed.yaml", writeYaml(tree));
  writeTextFile(folder / "signal.csv", makeSignalCsv(evaluator.makeExperiment(design.after.values).model));
  writeTextFile(folder / "limits.csv", makeLimitsCsv(design));
}

std::string describeDesign(const ExcitationDesign& design) {
  std::string text = fmt::format("{:<16} {:>12} {:>12} {:>8} {:>12} {:>12} {:>8}\n", "limit sd",
                                 "mean before", "after", "ratio", "worst before", "after", "ratio");
  for (std::size_t p = 0; p < design.parameters.size(); ++p) {
    const auto before = design.before.limit.stddev.row(static_cast<Index>(p));
    const auto after = design.after.limit.stddev.row(static_cast<Index>(p));
    text +=
        fmt::format("{:<16} {:>12.4g} {:>12.4g} {:>8.3f} {:>12.4g} {:>12.4g} {:>8.3f}\n",
                    design.parameters[p].name.text, before.mean(), after.mean(), after.mean() / before.mean(),
                    before.maxCoeff(), after.maxCoeff(), after.maxCoeff() / before.maxCoeff());
  }
  for (std::size_t i = 0; i < design.limits.size(); ++i) {
    const auto k = static_cast<Index>(i);
    const double reached = design.after.largest.size() > k ? design.after.largest[k] : std::nan("");
    text += fmt::format("{}: {:.4g} of {:.4g} {} (margin {:.2f} %)\n", describe(design.limits[i]), reached,
                        design.limits[i].most, design.limits[i].unit,
                        100.0 * (1.0 - reached / design.limits[i].most));
  }
  return text;
}

}  // namespace twinmap::experiment_design
