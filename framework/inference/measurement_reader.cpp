#include "framework/inference/measurement_reader.hpp"

#include "framework/data/features/experiment_features.hpp"
#include "framework/data/measurement/measurement.hpp"
#include "framework/data/measurement/trained_excitation.hpp"
#include "framework/inference/inferrer.hpp"

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

Eigen::VectorXd MeasurementReader::readFeatures(const Table& table, std::optional<double> start) const {
  requireTrainedExcitation(experiment_, table, getStart(start));
  MeasurementSpec spec = experiment_.measurement;
  spec.start = getStart(start);
  const Eigen::VectorXd response = resample(readMeasurement(table, spec, layout_), layout_, sample_interval_);
  return extractFeatures(extractor_, response, table.source);
}

}  // namespace twinmap
