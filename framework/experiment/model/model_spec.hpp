#pragma once

#include <string>
#include <vector>

#include "framework/experiment/model/excitation_spec.hpp"
#include "framework/experiment/model/initial_spec.hpp"
#include "framework/experiment/model/output_spec.hpp"
#include "framework/experiment/model/parameter_spec.hpp"
#include "framework/experiment/model/simulation_spec.hpp"
#include "framework/experiment/model/source_spec.hpp"
#include "framework/experiment/model/system_spec.hpp"

namespace twinmap {

struct TrialModel;

/// Everything that determines a trajectory but the parameter point.
struct ModelSpec {
  std::vector<ParameterSpec> parameters;  ///< updating: to be inferred from a response
  std::vector<ParameterSpec> nuisance;    ///< unknown too, but not inferred: initial state, offset, friction
  std::vector<ParameterSpec> inputs;      ///< known settings of the set-up, given with a measurement
  std::vector<PriorGroupSpec> priors;     ///< of several unknown parameters together
  std::vector<ConstantSpec> constants;
  SystemSpec system;                 ///< without bodies where `source` is the model
  std::optional<SourceSpec> source;  ///< a model from elsewhere
  std::vector<SignalSpec> excitation;
  InitialSpec initial;
  std::vector<OutputSpec> outputs;
  SimulationSpec simulation;
  /// The input that is the time (s) of the excitation and of `t` at which a simulation begins; not in the
  /// file: inference in segments sets it. None: 0.
  std::optional<Name> time_origin{};
  /// Of several trials simulated as one (combineTrials), what each is; nuisance, excitation and outputs are
  /// then theirs together, by the names of nameInTrial(). Not in the file.
  std::vector<TrialModel> trials;

  // compiled once (experiment_spec.cpp)
  ModelSpec();
  ModelSpec(const ModelSpec&);
  ModelSpec(ModelSpec&&) noexcept;
  ModelSpec& operator=(const ModelSpec&);
  ModelSpec& operator=(ModelSpec&&) noexcept;
  ~ModelSpec();
};

/// The model of one of several trials. Its own names are without that of the trial.
struct TrialModel {
  std::string name;
  ModelSpec model;
  int modes = 0;  ///< that its features need
};

}  // namespace twinmap
