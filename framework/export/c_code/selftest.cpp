#include "framework/export/c_code/selftest.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/data/features/experiment_features.hpp"
#include "framework/data/measurement/measurement.hpp"
#include "framework/data/noise/noise.hpp"
#include "framework/export/c_code/runtime_sources.hpp"
#include "framework/inference/select_estimate.hpp"
#include "framework/store/samples_file.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr const char* kSource = "self-test";

/// Clean responses of test samples that did not fail, with their known inputs.
struct Samples {
  MatrixXd responses, known;
};

Samples readSamples(const std::filesystem::path& run, Index inputs, Index rows) {
  const std::filesystem::path file = run / "samples.h5";
  if (!std::filesystem::exists(file)) {
    throw ExperimentError(file.string() +
                          ": does not exist; give the folder of a finished run, whose test "
                          "samples the self-test is made of");
  }
  const Trajectories test = readSamplesFile(file).test;
  std::vector<Index> good;
  for (Index i = 0; i < test.responses.cols(); ++i) {
    if (test.responses.col(i).allFinite()) {
      good.push_back(i);
    }
  }
  if (good.size() < 2 || test.responses.rows() != rows) {
    throw ExperimentError(file.string() + ": has fewer than 2 test samples, or others than the map's");
  }
  return {test.responses(Eigen::all, good), MatrixXd(test.parameters.bottomRows(inputs))(Eigen::all, good)};
}

VectorXd roundTo(CNumber number, const VectorXd& values) {
  return number == CNumber::kSingle ? VectorXd(values.cast<float>().cast<double>()) : values;
}

/// A response as its signals (times x signals), or features as they are.
MatrixXd shape(const ResponseLayout& layout, const VectorXd& values) {
  if (layout.modes > 0) {
    return values;
  }
  return Eigen::Map<const MatrixXd>(values.data(), layout.times.size(), layout.getOutputCount());
}

/// What a machine does that the model does not; most measurements stay as they are.
class DisturbanceGenerator {
 public:
  DisturbanceGenerator(const MatrixXd& responses, const VectorXd& noise_stddev)
      : mean_(responses.rowwise().mean()), noise_stddev_(noise_stddev) {}

  VectorXd disturb(int index, VectorXd response) const {
    constexpr double kDisturbance = 8.0, kBeyond = 2.5, kSlightlyBeyond = 1.3;
    switch (index % 10) {
      case 6: {
        const Index first = response.size() / 3, count = std::max<Index>(1, response.size() / 20);
        response.segment(first, count) += kDisturbance * noise_stddev_.segment(first, count);
        return response;
      }
      case 7:
        return mean_ + kBeyond * (response - mean_);
      case 8:
        return mean_ + kSlightlyBeyond * (response - mean_);
      default:
        return response;
    }
  }

 private:
  VectorXd mean_, noise_stddev_;
};

/// The grid, or for some measurements times beside it, between which the signals are interpolated.
VectorXd makeTimes(const VectorXd& grid, int index) {
  constexpr double kStretched = 1.004;  // its step is within what resampling allows
  if (index % 10 != 9 || grid.size() < 4) {
    return grid;
  }
  const double middle = 0.5 * (grid[0] + grid[grid.size() - 1]);
  return (middle + kStretched * (grid.array() - middle)).matrix();
}

/// Estimates as Inferrer gives them, by a model that may be compressed.
class EstimatorUnderTest {
 public:
  explicit EstimatorUnderTest(const ExportedModel& model)
      : model_(model),
        extractor_(makeExtractor(model.experiment, model.layout)),
        map_(*model.online.map),
        workspace_(map_.makeWorkspace()) {
    if (model.online.trust) {
      trust_.emplace(*model.online.trust);
    }
  }

  VectorXd extract(const VectorXd& response) const { return extractFeatures(extractor_, response, kSource); }

  /// Of signals, or of features as they are.
  VectorXd makeFeatures(const TestedMeasurement& tested) const {
    if (!model_.takesSignals()) {
      return tested.values;
    }
    const Measurement measurement{kSource, tested.times, model_.layout.output_names, tested.values};
    return extract(resample(measurement, model_.layout, model_.sample_interval));
  }

  InferredMeasurement infer(const VectorXd& features, const VectorXd& known) {
    InferredMeasurement inferred;
    inferred.by_estimator = map_.infer(features, known, *workspace_);
    inferred.estimator_is_calibrated = isCalibrated(map_, trust_ ? &*model_.online.trust : nullptr);
    if (trust_) {
      inferred.trust = judge(*model_.online.trust, features, known, inferred.by_estimator,
                             workspace_->findExplanation(), *trust_);
    }
    return inferred;
  }

  /// Whether changes of the last digits leave the estimate as it is. A surrogate's search may take a last
  /// step or not for a rounding error, and then another machine's estimate is as good.
  bool isSteady(const TestedMeasurement& tested) {
    // What the cancellation of a surrogate's weights leaves of rounding; half of what the self-test allows,
    // in standard deviations.
    constexpr double kDigits = 1e-9, kMax = 5e-5;
    const Estimate& estimate = tested.inferred.by_estimator;
    for (const int period : {2, 3, 5, 7, 11, 13}) {
      const VectorXd features = VectorXd::NullaryExpr(tested.features.size(), [&](Index i) {
        return tested.features[i] * (1.0 + (i % period == 0 ? kDigits : -kDigits));
      });
      const Estimate other = infer(features, tested.known).by_estimator;
      if (((other.mean - estimate.mean).array().abs() > kMax * estimate.stddev.array()).any() ||
          ((other.stddev - estimate.stddev).array().abs() > kMax * estimate.stddev.array()).any()) {
        return false;
      }
    }
    return true;
  }

 private:
  const ExportedModel& model_;
  FeatureExtractor extractor_;
  const Estimator& map_;
  std::unique_ptr<Estimator::Workspace> workspace_;
  std::optional<TrustWorkspace> trust_;
};

int toBits(const InferredMeasurement& inferred) {
  constexpr int kEstimatorLimited = 16;
  int bits = isEstimatorLimited(inferred) ? kEstimatorLimited : 0;
  for (const TrustStatus status : inferred.trust ? inferred.trust->statuses : std::vector<TrustStatus>{}) {
    if (status != TrustStatus::kOk) {
      bits |= 1 << static_cast<int>(status);
    }
  }
  return bits;
}

}  // namespace

std::vector<TestedMeasurement> makeTestedMeasurements(const std::filesystem::path& run,
                                                      const ExportedModel& model, const TestPlan& plan) {
  constexpr int kMaxTries = 20;
  const ResponseLayout& layout = model.layout;
  const Samples samples = readSamples(run, model.countKnown(), layout.getRowCount());
  const ResponseNoise noise(model.experiment.noise, layout);
  const DisturbanceGenerator generator(samples.responses, noise.getStddev());
  const RandomStream random(model.experiment.seed, RandomPurpose::kSelftest);
  const auto n = static_cast<int>(samples.responses.cols());
  EstimatorUnderTest estimator(model);
  std::vector<TestedMeasurement> tested;
  MatrixXd noisy;
  for (int i = 0; static_cast<int>(tested.size()) < plan.count && i < kMaxTries * plan.count; ++i) {
    if (i % n == 0) {
      noisy = addNoise(samples.responses, noise, random, i / n);
    }
    const VectorXd response =
        plan.disturbed ? generator.disturb(i, noisy.col(i % n)) : VectorXd(noisy.col(i % n));
    TestedMeasurement one;
    one.known = samples.known.col(i % n);
    one.times = plan.disturbed ? makeTimes(layout.times, i) : layout.times;
    try {
      one.values =
          shape(layout, roundTo(plan.number, layout.modes > 0 ? estimator.extract(response) : response));
      one.features = estimator.makeFeatures(one);
      one.inferred = estimator.infer(one.features, one.known);
      if (!plan.disturbed || estimator.isSteady(one)) {
        tested.push_back(std::move(one));
      }
    } catch (const MeasurementError&) {
      continue;  // such as a disturbed response that lacks a peak
    }
  }
  if (tested.empty()) {
    throw ExperimentError(run.string() + ": none of the run's test samples has all features");
  }
  return tested;
}

std::string makeSelftest(const ExportedModel& model, const COptions& options,
                         const std::vector<TestedMeasurement>& measurements) {
  const auto count = static_cast<Index>(measurements.size());
  const Index p = model.countParameters(), size = measurements.front().values.size();
  MatrixXd values(size, count), mean(p, count), stddev(p, count),
      known(std::max<Index>(1, model.countKnown()), count);
  std::vector<int> statuses, axis;
  VectorXd stretched = measurements.front().times;
  known.setZero();
  for (Index i = 0; i < count; ++i) {
    const TestedMeasurement& one = measurements[static_cast<std::size_t>(i)];
    values.col(i) = flattenColumns(one.values);
    mean.col(i) = one.inferred.by_estimator.mean;
    stddev.col(i) = one.inferred.by_estimator.stddev;
    known.col(i).head(one.known.size()) = one.known;
    statuses.push_back(toBits(one.inferred));
    axis.push_back(one.times == measurements.front().times ? 0 : 1);
    stretched = axis.back() == 1 ? one.times : stretched;
  }
  const bool single = options.number == CNumber::kSingle;
  CTables tables(options.number);
  // Bits agree where the machine multiplies and adds at once; else processes keep what the cancellation of
  // their weights leaves, and the search that inverts a surrogate may end a step earlier.
  tables.addNumber("tolerance_stddevs", single || model.findSurrogate() != nullptr ? 1e-4 : 1e-6,
                   "Of means and standard deviations, in the latter.");
  tables.addNumber("tolerance_relative", single ? 0.0 : 1e-12, "And in relation to the mean.");
  if (model.takesSignals()) {
    tables.addWide("measured_times",
                   (VectorXd(2 * stretched.size()) << measurements.front().times, stretched).finished(),
                   "Times of the samples, s: on the grid, and beside it.");
    tables.addInts("time_axis", axis, "Which of them, of each measurement.");
  }
  tables.addReal("measured", flattenColumns(values),
                 "Samples: measurement by measurement, signal by signal.");
  tables.addWide("known_inputs", flattenColumns(known), "Known inputs of each measurement.");
  tables.addWide("expected_mean", flattenColumns(mean),
                 "twinmap's estimates: parameters of each measurement.");
  tables.addWide("expected_sd", flattenColumns(stddev), "Their standard deviations.");
  tables.addInts("expected_statuses", statuses, "The statuses, as bits.");
  const std::string text = fmt::format("enum {{ MEASUREMENTS = {} }};\ntypedef {} real_t;\n\n", count,
                                       single ? "float" : "double") +
                           tables.getText();
  return fillSlot(renameC(std::string(getRuntimeSource("selftest.c")), options.prefix), "@TABLES@\n", text);
}

}  // namespace twinmap
