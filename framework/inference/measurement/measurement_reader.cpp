#include "framework/inference/measurement/measurement_reader.hpp"

#include <fmt/core.h>

#include <cmath>

#include "framework/base/text/number_text.hpp"
#include "framework/data/features/experiment_features.hpp"
#include "framework/data/measurement/measurement.hpp"
#include "framework/data/measurement/time_series.hpp"
#include "framework/data/measurement/trained_excitation.hpp"

namespace twinmap {

MeasurementReader::MeasurementReader(ExperimentSpec experiment)
    : experiment_(std::move(experiment)),
      layout_(makeLayout(experiment_)),
      sample_interval_(findSampleInterval(experiment_.features)),
      extractor_(makeExtractor(experiment_, layout_)) {}

std::vector<std::string> MeasurementReader::listColumns() const {
  std::vector<std::string> names = twinmap::listColumns(experiment_.measurement, layout_.output_names);
  const std::vector<std::string> excitation = listExcitationColumns(experiment_);
  names.insert(names.end(), excitation.begin(), excitation.end());
  return names;
}

double MeasurementReader::getStart(std::optional<double> start) const {
  return start.value_or(experiment_.measurement.start);
}

std::vector<double> MeasurementReader::listWindows(const Table& table, std::optional<double> start,
                                                   double length) const {
  const MeasurementSpec& spec = experiment_.measurement;
  const Eigen::Index rows = table.columns.empty() ? 0 : table.columns.front().values.size();
  double last = getStart(start);
  for (const double time : readUnorderedTimes(table, {spec.time, spec.sample_rate, 0.0}, rows)) {
    last = std::isfinite(time) ? std::max(last, time) : last;
  }
  const double first = getStart(start);
  const double duration = layout_.times.size() > 0 ? layout_.times[layout_.times.size() - 1] : 0.0;
  const double slack = 1e-6 * length;  // as times are compared when they are read
  std::vector<double> starts;
  for (double i = 0.0; first + i * length + duration <= last + slack; i += 1.0) {
    starts.push_back(first + i * length);
  }
  if (starts.empty()) {
    throw MeasurementError(fmt::format("{}: ends at {} s, but a window from {} s on takes {} s", table.source,
                                       toShortText(last, 6), toShortText(first, 6),
                                       toShortText(duration, 6)));
  }
  return starts;
}

void MeasurementReader::requireExcitation(const Table& table, std::optional<double> start) const {
  requireTrainedExcitation(experiment_, table, getStart(start));
}

Eigen::VectorXd MeasurementReader::readResponse(const Table& table, std::optional<double> start) const {
  MeasurementSpec spec = experiment_.measurement;
  spec.start = getStart(start);
  return resample(readMeasurement(table, spec, layout_), layout_, sample_interval_);
}

AvailableFeatures MeasurementReader::readAvailableFeatures(const Table& table,
                                                           std::optional<double> start) const {
  requireExcitation(table, start);
  MeasurementSpec spec = experiment_.measurement;
  spec.start = getStart(start);
  AvailableResponse response = readAvailable(table, spec, layout_, sample_interval_);
  AvailableFeatures found{
      extractor_.extract(response.response), {}, std::move(response.remarks), response.response};
  const Eigen::Index missing_samples = response.missing;
  for (Eigen::Index i = 0; i < found.features.size(); ++i) {
    if (std::isfinite(found.features[i])) {
      found.available.push_back(i);
    } else if (missing_samples == 0) {
      throw MeasurementError(table.source + ": the response has no feature '" +
                             extractor_.getInfos()[static_cast<std::size_t>(i)].name + "'");
    }
  }
  if (found.available.empty()) {
    throw MeasurementError(table.source + ": no feature can be computed from the samples that are there");
  }
  return found;
}

Eigen::VectorXd MeasurementReader::readFeatures(const Table& table, std::optional<double> start) const {
  requireExcitation(table, start);
  return extractFeatures(extractor_, readResponse(table, start), table.source);
}

Eigen::VectorXd extractFeatures(const FeatureExtractor& extractor, const Eigen::VectorXd& response,
                                const std::string& source) {
  Eigen::VectorXd features = extractor.extract(response);
  for (Eigen::Index i = 0; i < features.size(); ++i) {
    if (!std::isfinite(features[i])) {
      throw MeasurementError(source + ": the response has no feature '" + extractor.getInfos()[i].name + "'");
    }
  }
  return features;
}

}  // namespace twinmap
