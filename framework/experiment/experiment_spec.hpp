#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "framework/experiment/design_spec.hpp"
#include "framework/experiment/evaluation_spec.hpp"
#include "framework/experiment/feature_spec.hpp"
#include "framework/experiment/gate_spec.hpp"
#include "framework/experiment/inverse_map_spec.hpp"
#include "framework/experiment/measurement_spec.hpp"
#include "framework/experiment/model/candidate_spec.hpp"
#include "framework/experiment/model/derived_spec.hpp"
#include "framework/experiment/model/model_spec.hpp"
#include "framework/experiment/noise_spec.hpp"
#include "framework/experiment/refinement_spec.hpp"
#include "framework/experiment/transform_spec.hpp"

namespace twinmap {

/// How inferences are judged.
struct TrustSpec {
  double level = 0.01;  ///< share of good measurements that are called a mismatch of the model
};

template <class Fields>
void describe(Fields& f, TrustSpec& s) {
  f.optional("level", s.level, "share of good measurements that may be called a mismatch of the model",
             kFraction);
}

struct ReportSpec {
  std::vector<Name> over;  ///< two parameters: axes of the pictures of the inferred sd; default the last two
};

template <class Fields>
void describe(Fields& f, ReportSpec& s) {
  f.optional("over", s.over, "two parameters: axes of the pictures of the inferred standard deviation",
             kNotEmpty);
  f.rule(s.over.empty() || s.over.size() == 2, "must name two parameters in 'over'");
}

struct TrialExperiment;

/// A whole experiment, as described by one YAML file.
struct ExperimentSpec {
  Name name;
  std::string description;
  std::uint64_t seed = 1;
  ModelSpec model;
  std::vector<DerivedSpec> derived;  ///< what follows from the parameters and is reported as they are
  std::vector<FeatureSpec> features;
  std::vector<TransformStepSpec> transform;  ///< default: whiten, principal_components
  NoiseSpec noise;
  DesignSpec design;
  InverseMapSpec inverse_map;
  EvaluationSpec evaluation;
  RefineMode refine = RefineMode::kAutomatic;
  TrustSpec trust;
  std::vector<GateSpec> gates;
  MeasurementSpec measurement;  ///< for inferring from files; no simulation depends on it
  ReportSpec report;
  std::vector<CandidateSpec> candidates;  ///< terms that the model may lack, for a diagnosis
  std::vector<TrialExperiment> trials;    ///< that it combines (combineTrials); empty for one alone

  // compiled once (experiment_spec.cpp)
  ExperimentSpec();
  ExperimentSpec(const ExperimentSpec&);
  ExperimentSpec(ExperimentSpec&&) noexcept;
  ExperimentSpec& operator=(const ExperimentSpec&);
  ExperimentSpec& operator=(ExperimentSpec&&) noexcept;
  ~ExperimentSpec();
};

/// One of several experiments with the same machine, as if it were alone.
struct TrialExperiment {
  std::string name;
  ExperimentSpec experiment;
};

template <class Fields>
void describe(Fields& f, ExperimentSpec& s) {
  f.required("name", s.name, "letters, digits, '_', '-' and '.'; names the run's folder");
  f.optional("description", s.description, "human-readable");
  f.optional("seed", s.seed, "all randomness follows from it");
  f.requiredMap("parameters", s.model.parameters, "the parameters to estimate");
  f.optionalMap("nuisance", s.model.nuisance, "unknown parameters that are sampled, but not inferred");
  f.optionalMap("inputs", s.model.inputs, "known settings, sampled in training, given with a measurement");
  f.optional("priors", s.model.priors, "what is known of several parameters together");
  f.optionalMap("constants", s.model.constants, "named values for expressions");
  f.optionalMap("derived", s.derived, "quantities that follow from the parameters, reported as they are");
  f.oneOf("must give exactly one of", choice("system", s.model.system, "the multibody model"),
          choice("model", s.model.source, "or a model that comes as a file"));
  f.optionalMap("excitation", s.model.excitation, "named signals for forces and moments");
  f.optional("initial", s.model.initial, "initial condition");
  f.optionalMap("outputs", s.model.outputs, "what is measured");
  f.optional("simulation", s.model.simulation, "how it is integrated");
  f.required("features", s.features, "what the inverse map sees of the response");
  f.optional("transform", s.transform, "steps from features to the inputs of the inverse map", kNotEmpty);
  f.required("noise", s.noise, "measurement noise, on training and test features");
  f.optional("design", s.design, "where the training and test samples lie");
  f.optional("inverse_map", s.inverse_map, "from features to parameters");
  f.optional("evaluation", s.evaluation, "what is found out about the map besides its errors");
  f.optional("refine", s.refine,
             "whether estimates are refined on the simulator; automatic: where that is cheap");
  f.optional("trust", s.trust, "how inferences from measurements are judged");
  f.optional("gates", s.gates, "acceptance criteria on the metrics; the report says which passed");
  f.optional("measurement", s.measurement, "how files of measurements are read");
  f.optional("report", s.report, "what the report shows");
  f.optionalMap("candidates", s.candidates, "terms that the model may lack, for diagnose to test");
  f.rule(!s.features.empty(), "must list at least one of features");
}

}  // namespace twinmap
