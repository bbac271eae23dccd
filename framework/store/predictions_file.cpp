#include "framework/store/predictions_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "framework/base/text/csv.hpp"

namespace twinmap {
namespace {

/// Rows of the table, with errors that name the line of the file.
class Rows {
 public:
  Rows(const std::filesystem::path& path, const CsvTable& table) : path_(path), table_(table) {}

  [[noreturn]] void fail(std::size_t row, const std::string& problem) const {
    throw std::runtime_error(fmt::format("{}:{}: {}", path_.string(), row + 2, problem));
  }

  double getNumber(std::size_t row, const std::string& column) const {
    const double value = table_.getNumber(row, column);
    if (!std::isfinite(value)) {
      fail(row, column + " '" + table_.getText(row, column) + "' must be a number");
    }
    return value;
  }

  const std::string& getText(std::size_t row, const std::string& column) const {
    return table_.getText(row, column);
  }
  double getNumberOrNan(std::size_t row, const std::string& column) const {
    return table_.getNumber(row, column);
  }

  void requireText(std::size_t row, const std::string& column, const std::string& expected) const {
    if (table_.getText(row, column) != expected) {
      fail(row, column + " '" + table_.getText(row, column) + "' must be '" + expected + "'");
    }
  }

 private:
  const std::filesystem::path& path_;
  const CsvTable& table_;
};

/// Without those that are there again behind all, as Estimates::repeated.
Eigen::Index countSamples(const CsvTable& table, std::size_t parameters) {
  std::set<std::string> samples;
  for (std::size_t row = 0; row < table.rows.size(); row += parameters) {
    samples.insert(table.getText(row, "sample"));
  }
  return static_cast<Eigen::Index>(samples.size());
}

/// The numbers of a column of the predictions, and of its sample where it is the first of that.
void readColumn(const Rows& rows, const std::vector<std::string>& parameters, Eigen::Index column,
                StoredPredictions& stored) {
  const auto count = static_cast<Eigen::Index>(parameters.size());
  const std::string& sample = rows.getText(static_cast<std::size_t>(column * count), "sample");
  for (Eigen::Index p = 0; p < count; ++p) {
    const auto row = static_cast<std::size_t>(column * count + p);
    rows.requireText(row, "sample", sample);
    rows.requireText(row, "parameter", parameters[static_cast<std::size_t>(p)]);
    stored.predictions.mean(p, column) = rows.getNumber(row, "inferred");
    stored.predictions.stddev(p, column) = rows.getNumber(row, "stddev");
    if (stored.predictions.interval_factors.isGiven()) {
      stored.predictions.interval_factors.set(
          p, column, {rows.getNumber(row, "interval_factor50"), rows.getNumber(row, "interval_factor95")});
    }
    if (column < stored.truth.cols()) {
      stored.truth(p, column) = rows.getNumber(row, "true");
    }
    if (column < stored.limit_stddev.cols() && stored.limit_stddev.rows() > 0) {
      stored.limit_stddev(p, column) = rows.getNumberOrNan(row, "limit_stddev");
    }
  }
}

}  // namespace

StoredPredictions readPredictionsFile(const std::filesystem::path& path,
                                      const std::vector<std::string>& parameters) {
  const CsvTable table = readCsvFile(path);
  const Rows rows(path, table);
  if (table.empty() || table.rows.size() % parameters.size() != 0) {
    throw std::runtime_error(path.string() + ": must have a row for each test sample and parameter");
  }
  const auto count = static_cast<Eigen::Index>(parameters.size());
  const auto columns = static_cast<Eigen::Index>(table.rows.size()) / count;
  const Eigen::Index samples = countSamples(table, parameters.size());
  StoredPredictions stored;
  stored.truth.resize(count, samples);
  stored.predictions = {Eigen::MatrixXd(count, columns), Eigen::MatrixXd(count, columns)};
  if (table.hasColumn("interval_factor95")) {
    stored.predictions.interval_factors = {stored.predictions.mean, stored.predictions.mean};
  }
  if (table.hasColumn("stands_for")) {
    stored.predictions.weights.resize(columns);
  }
  stored.limit_stddev.resize(table.hasColumn("limit_stddev") ? count : 0, samples);
  for (Eigen::Index i = 0; i < columns; ++i) {
    const auto first = static_cast<std::size_t>(i * count);
    const auto sample = static_cast<int>(rows.getNumber(first, "sample"));
    if (i < samples) {
      stored.samples.push_back(sample);
    } else {
      const auto of = std::find(stored.samples.begin(), stored.samples.end(), sample);
      stored.predictions.repeated.push_back(of - stored.samples.begin());
    }
    if (stored.predictions.weights.size() > 0) {
      stored.predictions.weights[i] = rows.getNumber(first, "stands_for");
    }
    readColumn(rows, parameters, i, stored);
  }
  return stored;
}

std::vector<Mixture> readComponentsFile(const std::filesystem::path& path,
                                        const std::vector<std::string>& parameters,
                                        const std::vector<int>& samples) {
  const CsvTable table = readCsvFile(path);
  const Rows rows(path, table);
  std::vector<Mixture> mixtures;
  const auto p = static_cast<Eigen::Index>(parameters.size());
  std::size_t row = 0;
  while (!table.empty() && mixtures.size() < samples.size()) {
    const std::string sample = std::to_string(samples[mixtures.size()]);
    Mixture mixture;
    while (row < table.rows.size() && table.getText(row, "sample") == sample) {
      const Eigen::Index c = mixture.countComponents();
      mixture.weights.conservativeResize(c + 1);
      mixture.means.conservativeResize(p, c + 1);
      mixture.stddevs.conservativeResize(p, c + 1);
      mixture.weights[c] = rows.getNumber(row, "weight");
      for (Eigen::Index k = 0; k < p; ++k, ++row) {
        rows.requireText(row, "parameter", parameters[static_cast<std::size_t>(k)]);
        mixture.means(k, c) = rows.getNumber(row, "mean");
        mixture.stddevs(k, c) = rows.getNumber(row, "stddev");
      }
    }
    if (!mixture.isGiven()) {
      throw std::runtime_error(path.string() + ": must have the components of sample " + sample);
    }
    mixtures.push_back(std::move(mixture));
  }
  return mixtures;
}

}  // namespace twinmap
