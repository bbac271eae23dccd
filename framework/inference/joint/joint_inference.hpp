#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "framework/estimation/posterior/agreement.hpp"
#include "framework/estimation/scatter.hpp"
#include "framework/experiment/yaml/yaml_node.hpp"
#include "framework/inference/joint/recording_inference.hpp"
#include "framework/inference/known_value.hpp"
#include "framework/inference/measurement/explained_recording.hpp"

namespace twinmap {

/// A recording of one trial, or a window of it.
struct Recording {
  std::string label;            ///< names it among the others
  std::string trial;            ///< "" of an experiment without trials
  const Table* table;           ///< must outlive the inference
  std::optional<double> start;  ///< time in the table that is 0 of the model
};

/// Two recordings whose estimates of a parameter differ.
struct Contradiction {
  std::size_t parameter = 0, first = 0, second = 0;
  double distance = 0.0;  ///< in standard deviations of the difference
};

/// What several recordings say about one machine.
struct JointInference {
  std::vector<RecordingInference> alone;
  SimulatorPosterior joint;                   ///< of the machine's parameters
  InferredMeasurement together{};             ///< the same as an answer of one (describeTogether)
  std::optional<Agreement> agreement;         ///< where all could be simulated
  std::vector<Contradiction> contradictions;  ///< the largest of each parameter, the largest first
  std::vector<ScatterEstimate> scatter;  ///< of each parameter; empty of fewer than two that are reliable
  int simulations = 0;
  Asked asked{};                          ///< what the user asked for
  std::optional<ModelTest> model_test{};  ///< of all recordings together, where the model is known

  const MissingTerm* findMissing() const {
    return model_test && model_test->missing ? &*model_test->missing : nullptr;
  }

  bool disagrees() const { return agreement && agreement->p_value < kMismatchLevel; }
};

/// Names of what one or several recordings have that their files do not state: statuses of a sensor or a
/// nuisance (Concern). The joint estimate is without it.
std::vector<std::string> listRecordingFaults(const std::vector<RecordingInference>& alone);

/// Names of all that is to be said against the joint estimate (listNotices), the most severe first: of a
/// recording alone "model_mismatch" and listRecordingFaults(); "trials_disagree" below kMismatchLevel; {"ok"}
/// where nothing is. Of the first `parameters`, the machine's.
std::vector<std::string> listStatuses(const JointInference& inferred, Eigen::Index parameters);

/// Infers one machine from several recordings together, each with an initial state, an offset ... (nuisance
/// parameters) of its own, by simulation alone. For one thread, which OpenMP's others help.
class JointInferrer {
 public:
  /// root: the experiment's tree, with trials or without; draws: of a round; none: as many as suit the
  /// number of parameters.
  JointInferrer(const YamlNode& root, const std::vector<std::string>& known, std::optional<int> draws = {});
  /// experiment: as InferenceSource has it.
  JointInferrer(const ExperimentSpec& experiment, const std::vector<KnownValue>& known,
                std::optional<int> draws = {});

  /// The machine's, the same in all trials.
  const std::vector<ParameterSpec>& getParameters() const;
  /// Of a trial; throws ExperimentError for an unknown one.
  const MeasurementReader& getReader(const std::string& trial) const { return *find(trial).reader; }
  std::vector<std::string> listTrials() const;

  /// Of recordings as they are explained alone (explainRecording): with the faults of their sensors and their
  /// nuisance. Cost: that of DirectInference::infer() for each recording, and two simulations with
  /// derivatives of each recording and joint draw.
  JointInference infer(const std::vector<Recording>& recordings) const;

  /// What becomes of a fit that noise does not explain: it is the answer, or where a further search begins.
  enum class Misfits { kAnswers, kStarts };
  /// Each alone (explainRecording). kStarts: others begin at the best of a first one
  /// that noise does not explain.
  std::vector<ExplainedRecording> explainAlone(const std::vector<Recording>& recordings,
                                               Misfits misfits = Misfits::kAnswers) const;

 private:
  JointInferrer(std::vector<TrialExperiment> trials, const std::vector<KnownValue>& known,
                std::optional<int> draws);

  struct Member {
    std::string name;
    std::shared_ptr<const MeasurementReader> reader;
    std::unique_ptr<const SimulatorRefiner> simulator;
    Eigen::VectorXd known;
  };

  const Member& find(const std::string& trial) const;
  /// With a simulator of its own, for a thread of its own.
  ExplainedRecording explain(const Recording& recording, UnexplainedRecording read,
                             const SimulatorPosteriorOptions& options, const Eigen::VectorXd& lead) const;
  /// Of recordings that the model does not explain, or that disagree: of others it would take long.
  static void nameNoise(std::vector<ExplainedRecording>& alone, JointInference& inferred);
  /// Each with the faults that explain it alone. The recordings must outlive it.
  PosteriorProblem makeProblem(const std::vector<Recording>& recordings,
                               const std::vector<ExplainedRecording>& alone) const;

  std::vector<Member> members_;
  SimulatorPosteriorOptions options_, joint_options_;
};

/// A human-readable table: whether they agree, the joint estimate, each recording's.
std::string makeJointTable(const JointInference& inferred, const std::vector<ParameterSpec>& parameters);

/// CSV: rows of each recording, then of the joint estimate (source "joint"), in the columns of
/// makeInferenceCsvHeader().
std::string makeJointCsvRows(const JointInference& inferred, const std::vector<ParameterSpec>& parameters);

/// One line of JSON, without a line end (docs/how-to/estimate-from-measurements.md).
std::string makeJointJson(const JointInference& inferred, const std::vector<ParameterSpec>& parameters);

}  // namespace twinmap
