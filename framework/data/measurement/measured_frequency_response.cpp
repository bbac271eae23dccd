#include "framework/data/measurement/measured_frequency_response.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "framework/base/text/number_text.hpp"
#include "framework/data/measurement/measurement.hpp"
#include "framework/data/measurement/time_series.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kLineFrequency = "frequency";
constexpr const char *kReal = "real", *kImaginary = "imaginary", *kMagnitude = "magnitude", *kPhase = "phase",
                     *kLineStddev = "sd";

/// One frequency response, by the features that are its lines: Re and Im, one after the other.
struct ResponseOfLines {
  std::string name;  ///< "x/F"
  int output = -1;
  std::string excitation, unit;
  std::vector<Index> real;  ///< features; the next one is the imaginary part
};

std::vector<ResponseOfLines> collectResponses(const ResponseLayout& layout,
                                              const std::vector<FeatureInfo>& infos) {
  std::vector<ResponseOfLines> responses;
  for (std::size_t i = 0; i + 1 < infos.size(); ++i) {
    const FeatureInfo& info = infos[i];
    if (info.excitation.empty()) {
      continue;
    }
    auto found = std::find_if(responses.begin(), responses.end(), [&](const ResponseOfLines& response) {
      return response.output == info.output && response.excitation == info.excitation;
    });
    if (found == responses.end()) {
      const std::string& output = layout.output_names[static_cast<std::size_t>(info.output)];
      responses.push_back({output + "/" + info.excitation, info.output, info.excitation, info.unit, {}});
      found = responses.end() - 1;
    }
    found->real.push_back(static_cast<Index>(i));
    ++i;  // the imaginary part
  }
  return responses;
}

/// What the columns of a response may begin with.
std::vector<std::string> listPrefixes(const MeasurementSpec& spec, const ResponseLayout& layout,
                                      const std::vector<ResponseOfLines>& all,
                                      const ResponseOfLines& response) {
  std::vector<std::string> prefixes{response.name + "_"};
  const auto alike = std::count_if(
      all.begin(), all.end(), [&](const ResponseOfLines& other) { return other.output == response.output; });
  if (alike == 1) {
    const std::string& output = layout.output_names[static_cast<std::size_t>(response.output)];
    prefixes.push_back(findColumnSpec(spec, output).name + "_");
  }
  if (all.size() == 1) {
    prefixes.emplace_back();
  }
  return prefixes;
}

/// The rows of a table by their frequencies (Hz), ascending.
class LineRows {
 public:
  explicit LineRows(const Table& table) {
    const Index count = getColumn(table, kLineFrequency).values.size();
    const VectorXd frequencies = readValues(table, {kLineFrequency, {}, {}}, "Hz", 0, count);
    for (Index row = 0; row < count; ++row) {
      if (std::isfinite(frequencies[row])) {
        rows_.emplace_back(frequencies[row], row);
      }
    }
    std::sort(rows_.begin(), rows_.end());
    for (std::size_t i = 1; i < rows_.size(); ++i) {
      if (rows_[i].first == rows_[i - 1].first) {
        throw MeasurementError(
            fmt::format("{}: column 'frequency' has {} Hz in rows {} and {}; each has one row", table.source,
                        toText(rows_[i].first), rows_[i - 1].second + 1, rows_[i].second + 1));
      }
    }
  }

  /// -1 where there is none.
  Index find(double frequency) const {
    constexpr double kSame = 1e-6;
    const auto found =
        std::lower_bound(rows_.begin(), rows_.end(), std::make_pair(frequency * (1.0 - kSame), Index{-1}));
    return found != rows_.end() && found->first <= frequency * (1.0 + kSame) ? found->second : -1;
  }

 private:
  std::vector<std::pair<double, Index>> rows_;
};

/// The columns of one response.
class LineColumns {
 public:
  LineColumns(const Table& table, std::string prefix, std::string unit)
      : table_(table), prefix_(std::move(prefix)), unit_(std::move(unit)) {}

  bool hasPart(const char* part) const { return findColumn(table_, prefix_ + part) != nullptr; }
  bool hasBothParts() const {
    return (hasPart(kReal) && hasPart(kImaginary)) || (hasPart(kMagnitude) && hasPart(kPhase));
  }

  std::vector<std::complex<double>> read() const {
    const bool is_polar = !hasPart(kReal);
    const VectorXd first = readPart(is_polar ? kMagnitude : kReal, unit_);
    const VectorXd second = readPart(is_polar ? kPhase : kImaginary, is_polar ? "rad" : unit_);
    std::vector<std::complex<double>> values;
    for (Index row = 0; row < first.size(); ++row) {
      values.push_back(is_polar ? std::complex<double>(first[row] * std::cos(second[row]),
                                                       first[row] * std::sin(second[row]))
                                : std::complex<double>(first[row], second[row]));
    }
    return values;
  }

  VectorXd readStddevs(Index count) const {
    if (!hasPart(kLineStddev)) {
      return VectorXd::Constant(count, kAbsent);
    }
    VectorXd stddevs = readPart(kLineStddev, unit_);
    for (Index row = 0; row < stddevs.size(); ++row) {
      if (stddevs[row] <= 0.0) {
        throw MeasurementError(fmt::format("{}: column '{}{}' has {} in row {}; must be above 0",
                                           table_.source, prefix_, kLineStddev, toText(stddevs[row]),
                                           row + 1));
      }
    }
    return stddevs;
  }

 private:
  VectorXd readPart(const char* part, const std::string& unit) const {
    const Column& column = getColumn(table_, prefix_ + part);
    requireLength(table_, column, getColumn(table_, kLineFrequency).values.size());
    return readValues(table_, {column.name, {}, {}}, unit, 0, column.values.size());
  }

  const Table& table_;
  const std::string prefix_, unit_;
};

LineColumns findLineColumns(const Table& table, const std::vector<std::string>& prefixes,
                            const ResponseOfLines& response) {
  for (const std::string& prefix : prefixes) {
    LineColumns columns(table, prefix, response.unit);
    if (columns.hasBothParts()) {
      return columns;
    }
  }
  const std::string& shown = prefixes.back();
  throw MeasurementError(
      fmt::format("{}: has no columns '{}real' and '{}imaginary', nor '{}magnitude' and "
                  "'{}phase', of the frequency response {}",
                  table.source, shown, shown, shown, shown, response.name));
}

void readResponseOfLines(const LineColumns& columns, const LineRows& rows,
                         const std::vector<FeatureInfo>& infos, const ResponseOfLines& response,
                         MeasuredLines& lines) {
  const std::vector<std::complex<double>> values = columns.read();
  const VectorXd stddevs = columns.readStddevs(static_cast<Index>(values.size()));
  Index missing = 0;
  for (const Index real : response.real) {
    const Index row = rows.find(infos[static_cast<std::size_t>(real)].frequency);
    const std::complex<double> value =
        row < 0 ? std::complex<double>(kAbsent, kAbsent) : values[static_cast<std::size_t>(row)];
    if (!std::isfinite(value.real()) || !std::isfinite(value.imag())) {
      ++missing;
      continue;
    }
    lines.features[real] = value.real();
    lines.features[real + 1] = value.imag();
    lines.stddevs[real] = lines.stddevs[real + 1] = stddevs[row];
  }
  if (missing > 0) {
    lines.remarks.push_back(
        fmt::format("{} of {} lines of {}", missing, response.real.size(), response.name));
  }
}

}  // namespace

bool isFrequencyResponse(const Table& table, const std::vector<FeatureInfo>& infos) {
  const bool has_lines = std::any_of(infos.begin(), infos.end(),
                                     [](const FeatureInfo& info) { return !info.excitation.empty(); });
  return has_lines && findColumn(table, kLineFrequency) != nullptr;
}

std::vector<std::string> listLineColumns(const MeasurementSpec& spec, const ResponseLayout& layout,
                                         const std::vector<FeatureInfo>& infos) {
  std::vector<std::string> names;
  const std::vector<ResponseOfLines> responses = collectResponses(layout, infos);
  for (const ResponseOfLines& response : responses) {
    for (const std::string& prefix : listPrefixes(spec, layout, responses, response)) {
      for (const char* part : {kReal, kImaginary, kMagnitude, kPhase, kLineStddev}) {
        names.push_back(prefix + part);
      }
    }
  }
  if (!responses.empty()) {
    names.emplace_back(kLineFrequency);
  }
  return names;
}

MeasuredLines readFrequencyResponse(const Table& table, const MeasurementSpec& spec,
                                    const ResponseLayout& layout, const std::vector<FeatureInfo>& infos) {
  const LineRows rows(table);
  const auto count = static_cast<Index>(infos.size());
  MeasuredLines lines{VectorXd::Constant(count, kAbsent), VectorXd::Constant(count, kAbsent), {}};
  const std::vector<ResponseOfLines> responses = collectResponses(layout, infos);
  for (const ResponseOfLines& response : responses) {
    const LineColumns columns =
        findLineColumns(table, listPrefixes(spec, layout, responses, response), response);
    readResponseOfLines(columns, rows, infos, response, lines);
  }
  return lines;
}

}  // namespace twinmap
