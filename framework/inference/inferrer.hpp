#pragma once

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/log/notice.hpp"
#include "framework/estimation/derived/derived_quantities.hpp"
#include "framework/estimation/refined/refined.hpp"
#include "framework/estimation/ridges/identified_combinations.hpp"
#include "framework/estimation/scatter.hpp"
#include "framework/estimation/trained/online_model.hpp"
#include "framework/inference/asked.hpp"
#include "framework/inference/measurement_reader.hpp"
#include "framework/inference/posterior_estimate.hpp"
#include "framework/inference/stated_prior.hpp"
#include "framework/store/trained_file.hpp"

namespace twinmap {

/// The term that a model most likely lacks (framework/diagnosis).
struct MissingTerm {
  std::string term, meaning, unit;
  double size = 0.0, stddev = 0.0;
  double share = 0.0;                 ///< of the misfit beyond the noise that it takes away
  double log_evidence = 0.0;          ///< against none
  Eigen::VectorXd shifts{};           ///< p: how the parameters move with it, in their sds without
  std::vector<std::string> rivals{};  ///< terms that the measurement does not tell from it
  bool explains = false;              ///< whether what remains with it is noise as it is stated
  double share_of_all = 0.0;          ///< of the whole misfit that it takes away
};

/// The term that may move a parameter most without being noticed.
struct UnnoticedTerm {
  std::string term, meaning, unit;
  double size = 0.0;          ///< that is noticed in 95 % of measurements
  std::size_t parameter = 0;  ///< that it moves most
  double shift = 0.0;         ///< by then, in its sds
};

/// What a measurement says of terms that the model lacks.
struct ModelTest {
  std::optional<MissingTerm> missing{};
  std::optional<UnnoticedTerm> unnoticed{};  ///< none where the size of the noise was not stated
};

/// A nuisance parameter of one recording.
struct NuisanceSize {
  std::string name;  ///< "late", in JSON
  double value = 0.0, stddev = 0.0;
  std::optional<double> from{};  ///< s: the first time that it acts at, if not the recording's
};

/// What is off in a recording, not in the machine, as its recorder's clock.
struct RecordingNuisance {
  Notice notice{};                         ///< the status that names it
  std::string kind{};                      ///< "clock", in JSON
  std::vector<std::string> alike_terms{};  ///< how terms (framework/diagnosis) begin that say the same
  std::vector<NuisanceSize> sizes{};       ///< the last of the recording's unknown parameters, in this order
  std::string text{};                      ///< "the record is 20 ms late (sd 0.1 ms)"

  bool isAlike(const std::string& term) const {
    return std::any_of(alike_terms.begin(), alike_terms.end(),
                       [&](const std::string& begin) { return term.rfind(begin, 0) == 0; });
  }
};

/// How a recording was cut, where it was inferred in segments.
struct SegmentReport {
  int count = 0;
  double length = 0.0;                 ///< s
  int states = 0;                      ///< of each segment's own
  std::vector<FeatureInfo> samples{};  ///< of all segments, in the order of the residual
};

/// What a measurement says about the machine.
struct InferredMeasurement {
  std::string source;                        ///< the file
  Asked asked{};                             ///< what the user asked for
  double start = 0.0;                        ///< time in the file that is 0 of the model, s
  std::vector<std::string> remarks{};        ///< how it was read, a phrase each
  std::vector<std::string> left_out{};       ///< what of the recording is missing and why, a phrase each
  Estimate by_estimator;                     ///< not given where there is no trained estimator
  bool estimator_is_calibrated = true;       ///< isCalibrated()
  bool estimator_coverage_is_short = false;  ///< of the run's test samples, unrefined (CoverageRecord)
  std::optional<Trust> trust;                ///< none where the run could fit no trust model
  Eigen::VectorXd explanation;   ///< sampled point that explains the features best; empty without trust
  Eigen::MatrixXd covariance{};  ///< there, u x u in half-widths, with the surrogate's errors; empty likewise
  /// u x n: the separate places that fit by the estimator, in the parameters' units, the likeliest first;
  /// one, or none where the estimator does not look for them.
  Eigen::MatrixXd basins{};
  std::optional<RecordingNuisance> nuisance{};  ///< that explains it
  std::string fault{};  ///< of the measurement, that explains a gross misfit (explainByFault()); "" of none
  std::optional<ModelTest> model_test{};  ///< where a simulation explains it, and the model is known
  bool coverage_is_short = false;  ///< of the run's refined test samples, where the refinement was accepted
  std::optional<Refined> refined;  ///< on the simulator, where that was tried; accepted or not
  std::optional<PosteriorEstimate> posterior{};  ///< where it was asked for, or taken; reliable or not
  std::shared_ptr<const DerivedQuantities> quantities{};  ///< of the experiment, if it derives any
  std::shared_ptr<const StatedPrior> prior{};             ///< of the experiment; null where all is uniform
  std::vector<std::string> against{};  ///< the model, where it explains nothing (listModelRemarks)
  std::vector<std::string> unused{};   ///< parameters that nothing in the experiment depends on
  std::vector<Ridge> ridges{};         ///< of the simulator's posterior, where that alone was sampled
  std::optional<SegmentReport> segments{};
  /// Of each parameter, over recordings that disagree; else empty.
  std::vector<ScatterEstimate> scatter{};

  /// Unknown parameters behind the model's own.
  std::size_t countSizes() const { return nuisance ? nuisance->sizes.size() : 0; }

  /// Null of none.
  const MissingTerm* findMissing() const {
    return model_test && model_test->missing ? &*model_test->missing : nullptr;
  }
};

/// The buffers of one thread; the model must outlive them.
struct OnlineWorkspace {
  explicit OnlineWorkspace(const OnlineModel& model);
  std::unique_ptr<Estimator::Workspace> map;
  std::optional<TrustWorkspace> trust;
};

/// Infers and judges by a trained model alone. features: d, finite; known: the inputs of the set-up (q).
/// Cost: that of Estimator::infer() and judge().
InferredMeasurement inferOnline(const OnlineModel& model, const Eigen::VectorXd& features,
                                const Eigen::VectorXd& known, OnlineWorkspace& workspace);

/// The maps.h5 of a finished run, given its folder or the file itself. Throws std::runtime_error where there
/// is none.
std::filesystem::path findMaps(const std::filesystem::path& run_or_maps);

/// Whether nothing is known against a map's standard deviations: neither by its cross-validation nor by the
/// run's test samples.
bool isCalibrated(const Estimator& map, const TrustModel* trust);

/// A finished run made ready for measurements. Immutable; its workspaces are for one thread each.
class Inferrer {
 public:
  /// `run_or_maps`: the folder of a run, or its maps.h5, which holds all that is needed. Throws
  /// std::runtime_error for a file that is missing or was made by another version.
  explicit Inferrer(const std::filesystem::path& run_or_maps);

  const MeasurementReader& getReader() const { return reader_; }
  const ExperimentSpec& getExperiment() const { return reader_.getExperiment(); }
  const ResponseLayout& getLayout() const { return reader_.getLayout(); }
  const FeatureExtractor& getExtractor() const { return reader_.getExtractor(); }
  const OnlineModel& getModel() const { return online_; }
  const Estimator& getMap() const { return *online_.map; }
  const std::optional<TrustModel>& getTrustModel() const { return online_.trust; }

  /// inferOnline(), with what the experiment says beside.
  InferredMeasurement infer(const Eigen::VectorXd& features, const Eigen::VectorXd& known,
                            OnlineWorkspace& workspace) const;

 private:
  explicit Inferrer(TrainedFile loaded);

  MeasurementReader reader_;
  OnlineModel online_;
  std::shared_ptr<const DerivedQuantities> quantities_;  // none where nothing is derived
  std::shared_ptr<const StatedPrior> prior_;             // null where all is uniform
  std::vector<std::string> unused_;                      // parameters
};

}  // namespace twinmap
