#include "framework/inference/measurement_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "framework/base/log/log.hpp"
#include "framework/base/text/number_text.hpp"
#include "framework/data/features/experiment_features.hpp"
#include "framework/data/measurement/measured_frequency_response.hpp"
#include "framework/data/measurement/measured_modes.hpp"
#include "framework/data/measurement/measured_signals.hpp"
#include "framework/data/measurement/measurement.hpp"
#include "framework/data/measurement/measurement_start.hpp"
#include "framework/data/measurement/recording.hpp"
#include "framework/data/measurement/recording/interpolation_error.hpp"
#include "framework/data/measurement/recording/recorded_times.hpp"
#include "framework/data/measurement/time_series.hpp"
#include "framework/data/measurement/trained_excitation.hpp"
#include "framework/data/reduction/reduced_simulator.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "framework/models/make_simulator.hpp"

namespace twinmap {

namespace {

/// The features that are this row of a response and are fitted as they are.
std::vector<Eigen::Index> findFeaturesOf(const FeatureExtractor& extractor, Eigen::Index row) {
  std::vector<Eigen::Index> found;
  if (extractor.hasLinearForm()) {
    return found;
  }
  Eigen::Index feature = 0;
  for (const auto& block : extractor.getBlocks()) {
    const FeatureMatrix* matrix = block->findMatrix();
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(block->getInfos().size()); ++i, ++feature) {
      if (matrix != nullptr && matrix->row(i).nonZeros() == 1 && matrix->coeff(i, row) == 1.0) {
        found.push_back(feature);
      }
    }
  }
  return found;
}

/// Throws for a feature that a whole response does not have.
void requireAll(const Eigen::VectorXd& features, const FeatureExtractor& extractor,
                const std::string& source) {
  for (Eigen::Index i = 0; i < features.size(); ++i) {
    if (!std::isfinite(features[i])) {
      throw MeasurementError(source + ": the response has no feature '" +
                             extractor.getInfos()[static_cast<std::size_t>(i)].name + "'");
    }
  }
}

}  // namespace

void requireNoneStated(const StatedNoise& stated, const std::string& source) {
  if (stated.isGiven()) {
    throw MeasurementError(
        source +
        ": states standard deviations of its own, which only inference from the experiment file "
        "can use, not in segments; leave these columns out for those of the experiment's noise");
  }
}

MeasurementReader::MeasurementReader(ExperimentSpec experiment)
    : experiment_(std::move(experiment)),
      layout_(makeLayout(experiment_)),
      sample_interval_(findSampleInterval(experiment_.features)),
      extractor_(makeExtractor(experiment_, layout_)),
      linear_(extractor_.makeLinearForm()) {}

MeasurementReader::MeasurementReader(ExperimentSpec whole, std::shared_ptr<const ResponseReduction> reduction)
    : experiment_(reduceExperiment(whole, *reduction)),
      reduction_(std::move(reduction)),
      whole_layout_(makeLayout(whole)),
      layout_(reduction_->layout),
      sample_interval_(findSampleInterval(whole.features)),
      extractor_(experiment_.features, layout_),
      linear_(extractor_.makeLinearForm()) {
  whole_ = std::move(whole);
}

std::unique_ptr<Simulator> MeasurementReader::makeReducedSimulator() const {
  return std::make_unique<ReducedSimulator>(makeTrustedSimulator(whole_.model, whole_layout_.times),
                                            reduction_);
}

std::vector<std::string> MeasurementReader::listColumns() const {
  requireOneTrial(experiment_, "a table is a recording of one: give each to infer as --trial NAME=FILE");
  std::vector<std::string> names = twinmap::listColumns(experiment_.measurement, getRecorded().output_names);
  const std::vector<std::string> excitation = listExcitationColumns(experiment_);
  names.insert(names.end(), excitation.begin(), excitation.end());
  const std::vector<std::string> signals = listSignalColumns(experiment_);
  names.insert(names.end(), signals.begin(), signals.end());
  const std::vector<std::string> lines =
      listLineColumns(experiment_.measurement, layout_, linear_.getInfos());
  names.insert(names.end(), lines.begin(), lines.end());
  if (layout_.modes > 0 && layout_.times.size() == 0) {
    const std::vector<std::string> modes = listModeColumns();
    names.insert(names.end(), modes.begin(), modes.end());
  }
  return names;
}

double MeasurementReader::getStart(const Table& table, std::optional<double> start) const {
  requireOneTrial(experiment_, "a table is a recording of one");
  return start ? *start : findStart(table, experiment_.measurement);
}

double MeasurementReader::getStatedStart(std::optional<double> start) const {
  return start.value_or(experiment_.measurement.start.time);
}

std::vector<double> MeasurementReader::listWindows(const Table& table, std::optional<double> start,
                                                   double length) const {
  const Eigen::Index rows = table.columns.empty() ? 0 : table.columns.front().values.size();
  const double first = getStart(table, start);
  double last = first;
  for (const double time : readUnorderedTimes(table, makeTimeBase(experiment_.measurement, 0.0), rows)) {
    last = std::isfinite(time) ? std::max(last, time) : last;
  }
  const Eigen::VectorXd& times = getRecorded().times;
  const double duration = times.size() > 0 ? times[times.size() - 1] : 0.0;
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
  requireTrainedExcitation(experiment_, table, getStart(table, start));
}

void MeasurementReader::warnOfColumns(const Table& table) const {
  for (const std::string& jumps : describeJumps(table, experiment_.measurement, getRecorded())) {
    logWarning(jumps);
  }
  for (const std::string& unread : describeUnreadUnits(table, experiment_.measurement, getRecorded())) {
    logWarning(unread);
  }
}

Eigen::VectorXd MeasurementReader::readResponse(const Table& table, std::optional<double> start) const {
  warnOfColumns(table);
  const MeasurementSpec& spec = experiment_.measurement;
  const double zero = getStart(table, start);
  const ResponseLayout& recorded = getRecorded();
  if (hasOwnClocks(spec) || recorded.modes > 0) {
    return reduction_ ? reduction_->reduceMeasured(readWhole(table, zero)) : readWhole(table, zero);
  }
  const Measurement measurement = readMeasurement(table, spec, recorded, zero, getFeatures());
  requireUnclipped(measurement, spec, recorded);
  const Eigen::VectorXd response = resample(measurement, recorded, sample_interval_);
  return reduction_ ? reduction_->reduceMeasured(response) : response;
}

Eigen::VectorXd MeasurementReader::readWhole(const Table& table, double start) const {
  const AvailableResponse available =
      readAvailable(table, experiment_.measurement, getRecorded(), start, sample_interval_, getFeatures());
  if (available.missing > 0 || !available.clipped.empty()) {
    throw MeasurementError(
        fmt::format("{}: a trained map needs every sample; missing or clipped: {}; inference from the "
                    "experiment file can do "
                    "without (twinmap infer FILE.yaml MEASUREMENT)",
                    table.source, fmt::join(available.remarks, "; ")));
  }
  requireNoneStated({available.stddev, {}}, table.source);
  return available.response;
}

AvailableFeatures MeasurementReader::readAvailableFeatures(const Table& table,
                                                           std::optional<double> start) const {
  AvailableFeatures found =
      isFrequencyResponse(table, linear_.getInfos()) ? readLines(table) : readSamples(table, start);
  for (Eigen::Index i = 0; i < found.features.size(); ++i) {
    if (std::isfinite(found.features[i])) {
      found.available.push_back(i);
    }
  }
  if (found.available.empty()) {
    throw MeasurementError(table.source + ": no feature can be computed from the samples that are there");
  }
  return found;
}

AvailableFeatures MeasurementReader::readLines(const Table& table) const {
  AvailableResponse modes = readModesBeside(table, experiment_.measurement, layout_);
  MeasuredLines lines = readFrequencyResponse(table, experiment_.measurement, layout_, linear_.getInfos());
  Eigen::VectorXd features = linear_.extract(modes.response);
  features = lines.features.array().isNaN().select(features, lines.features);
  AvailableFeatures found{extractor_.convertFromLinearForm(features),
                          {},
                          {},
                          std::move(modes.remarks),
                          modes.response,
                          {modes.stddev, {}}};
  found.remarks.insert(found.remarks.end(), lines.remarks.begin(), lines.remarks.end());
  if (!lines.stddevs.array().isNaN().all()) {
    found.stated.features = lines.stddevs;
  }
  return found;
}

AvailableFeatures MeasurementReader::readSamples(const Table& table, std::optional<double> start) const {
  requireExcitation(table, start);
  warnOfColumns(table);
  AvailableResponse response = readAvailable(table, experiment_.measurement, getRecorded(),
                                             getStart(table, start), sample_interval_, getFeatures());
  if (reduction_) {
    return reduce(std::move(response), table.source);
  }
  AvailableFeatures found{extractor_.extract(response.response),
                          {},
                          {},
                          std::move(response.remarks),
                          response.response,
                          {response.stddev, {}}};
  for (const ClippedSample& sample : response.clipped) {
    for (const Eigen::Index feature : findFeaturesOf(extractor_, sample.row)) {
      found.features[feature] = sample.limit;
      found.clipped.push_back({feature, sample.limit, sample.side});
    }
  }
  if (response.missing == 0 && response.clipped.empty()) {
    requireAll(found.features, extractor_, table.source);
  }
  return found;
}

AvailableFeatures MeasurementReader::reduce(AvailableResponse response, const std::string& source) const {
  if (response.missing > 0 || !response.clipped.empty()) {
    throw MeasurementError(
        fmt::format("{}: a run of reduced samples needs every sample; missing or clipped: {}; inference from "
                    "the experiment file can do without (twinmap infer FILE.yaml MEASUREMENT)",
                    source, fmt::join(response.remarks, "; ")));
  }
  requireNoneStated({response.stddev, {}}, source);
  const Eigen::VectorXd reduced = reduction_->reduceMeasured(response.response);
  return {extractor_.extract(reduced), {}, {}, std::move(response.remarks), reduced, {}};
}

void MeasurementReader::warnOfInterpolation(const Table& table, std::optional<double> start) const {
  const ExperimentSpec& experiment = reduction_ ? whole_ : experiment_;
  const ResponseLayout& layout = getRecorded();
  if (layout.times.size() == 0 || isFrequencyResponse(table, linear_.getInfos())) {
    return;
  }
  RecordedColumns recording(table, experiment.measurement, getStart(table, start));
  for (std::size_t o = 0; o < layout.output_names.size(); ++o) {
    const std::string& name = layout.output_names[o];
    const auto& noise = experiment.noise.stddev;
    const auto stated = std::find_if(noise.begin(), noise.end(),
                                     [&](const OutputNoiseSpec& spec) { return spec.name.text == name; });
    const std::vector<double> needed = collectTimesOf(name, experiment.features);
    if (stated == noise.end() || stated->stddev.unknown || needed.empty()) {
      continue;
    }
    const double stddev = experiment.noise.scale * stated->stddev;
    const Samples samples = twinmap::readSamples(recording.getRows(name), experiment.measurement, layout, o);
    const double error = calcInterpolationError(samples.times, samples.values, needed, stddev);
    if (stddev > 0.0 && error > kImmaterial * stddev) {
      logWarning(
          fmt::format("{}: features of {} lie between its samples, where the cubic errs by {} of its noise; "
                      "estimates may "
                      "be off by more than they say. Record it faster, or at the times of the features",
                      table.source, name, toShortText(error / stddev, 2)));
    }
  }
}

std::optional<ExperimentSpec> MeasurementReader::followTimes(const Table& table,
                                                             std::optional<double> start) const {
  return reduction_ ? std::nullopt : followRecordedTimes(experiment_, layout_, table, getStart(table, start));
}

std::optional<ExperimentSpec> MeasurementReader::followExcitation(const Table& table,
                                                                  std::optional<double> start,
                                                                  double beside) const {
  const double zero = getStart(table, start);
  const MeasurementStartSpec& stated = experiment_.measurement.start;
  ExperimentSpec followed = experiment_;
  try {
    return followMeasuredSignals(followed, table, zero, beside) ? std::make_optional(std::move(followed))
                                                                : std::nullopt;
  } catch (const MeasurementError&) {
    if (stated.when || zero != stated.time) {
      throw;
    }
    return std::nullopt;  // the experiment's own is complete
  }
}

std::optional<ExperimentSpec> MeasurementReader::followModes(const Table& table,
                                                             std::optional<ExperimentSpec> followed) const {
  const bool may_have = layout_.modes > 0 && layout_.times.size() > 0 && !experiment_.measurement.modes;
  const std::filesystem::path modes = findModesFile(table.source, experiment_.measurement);
  if (may_have && std::filesystem::exists(modes)) {
    followed = followed ? std::move(followed) : std::make_optional(experiment_);
    followed->measurement.modes = Name{modes.filename().string(), {}};
  }
  return followed;
}

std::optional<ExperimentSpec> MeasurementReader::follow(const Table& table, std::optional<double> start,
                                                        double beside) const {
  if (reduction_) {
    return std::nullopt;
  }
  std::optional<ExperimentSpec> followed = followModes(table, followExcitation(table, start, beside));
  std::optional<ExperimentSpec> timed =
      followRecordedTimes(followed ? *followed : experiment_, layout_, table, getStart(table, start));
  return timed ? timed : followed;
}

Eigen::VectorXd MeasurementReader::readFeatures(const Table& table, std::optional<double> start) const {
  requireExcitation(table, start);
  return extractFeatures(extractor_, readResponse(table, start), table.source);
}

Eigen::VectorXd extractFeatures(const FeatureExtractor& extractor, const Eigen::VectorXd& response,
                                const std::string& source) {
  Eigen::VectorXd features = extractor.extract(response);
  requireAll(features, extractor, source);
  return features;
}

}  // namespace twinmap
