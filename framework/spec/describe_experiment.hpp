#pragma once

#include "framework/spec/describe_evaluation.hpp"
#include "framework/spec/describe_excitation.hpp"
#include "framework/spec/describe_features.hpp"
#include "framework/spec/describe_measurement.hpp"
#include "framework/spec/describe_system.hpp"
#include "framework/spec/experiment_spec.hpp"
#include "framework/spec/fields/fields.hpp"

namespace twinmap {

template <>
struct EnumNames<RelativeTo> {
  static constexpr EnumName<RelativeTo> values[] = {{"value", RelativeTo::kValue},
                                                    {"range", RelativeTo::kRange}};
};

template <>
struct EnumNames<Integrator> {
  static constexpr EnumName<Integrator> values[] = {
      {"dopri5", Integrator::kDopri5},
      {"runge_kutta_merson", Integrator::kRungeKuttaMerson},
      {"cpodes", Integrator::kCpodes},
  };
};

template <>
struct EnumNames<DesignMethod> {
  static constexpr EnumName<DesignMethod> values[] = {
      {"latin_hypercube", DesignMethod::kLatinHypercube},
      {"nested_latin_hypercube", DesignMethod::kNestedLatinHypercube},
      {"sobol", DesignMethod::kSobol},
      {"uniform", DesignMethod::kUniform},
  };
};

template <>
struct EnumNames<GpCovariance> {
  static constexpr EnumName<GpCovariance> values[] = {
      {"squared_exponential", GpCovariance::kSquaredExponential},
      {"matern32", GpCovariance::kMatern32},
      {"matern52", GpCovariance::kMatern52},
      {"rational_quadratic", GpCovariance::kRationalQuadratic},
  };
};

template <>
struct EnumNames<GpMean> {
  static constexpr EnumName<GpMean> values[] = {
      {"constant", GpMean::kConstant}, {"zero", GpMean::kZero}, {"linear", GpMean::kLinear}};
};

template <>
struct EnumNames<GpApproximation> {
  static constexpr EnumName<GpApproximation> values[] = {{"exact", GpApproximation::kExact},
                                                         {"sgpr", GpApproximation::kSgpr}};
};

template <>
struct EnumNames<WhitenBy> {
  static constexpr EnumName<WhitenBy> values[] = {{"stddev", WhitenBy::kStddev},
                                                  {"covariance", WhitenBy::kCovariance}};
};

template <>
struct EnumNames<GpNoise> {
  static constexpr EnumName<GpNoise> values[] = {{"follows_slope", GpNoise::kFollowsSlope},
                                                 {"constant", GpNoise::kConstant}};
};

template <>
struct EnumNames<LengthScales> {
  static constexpr EnumName<LengthScales> values[] = {
      {"shared", LengthScales::kShared},
      {"per_output", LengthScales::kPerOutput},
      {"per_feature", LengthScales::kPerFeature},
  };
};

template <class Fields>
void describe(Fields& f, ParameterSpec& s) {
  f.required("bounds", s.bounds, "[lower, upper]; the parameter box is sampled within");
  f.optional("unit", s.unit, "coherent SI unit, such as N s/m; shown in tables and checked where it is used");
  f.optional("description", s.description, "for people");
  f.optional("relative_to", s.relative_to,
             "what relative errors are relative to: the value, or upper - lower");
}

template <class Fields>
void describe(Fields& f, ConstantSpec& s) {
  f.required("value", s.value, "number, or expression of parameters and constants declared before");
  f.optional("unit", s.unit, "coherent SI unit; checked where the constant is used");
  f.optional("description", s.description, "for people");
}

template <class Fields>
void describe(Fields& f, SimulationSpec& s) {
  constexpr NumberRule kRelative{1e-13, 0.1, true, "must be a number from 1e-13 to 0.1"};
  constexpr NumberRule kAbsolute{1e-18, 1.0, true, "must be a number from 1e-18 to 1"};
  constexpr NumberRule kWallTime{0.0, 86400.0, false, "must be a number above 0, at most 86400 (a day)"};
  f.optional("duration", s.duration, "simulated time; s; needed for features of outputs", kNonNegative);
  f.optional("integrator", s.integrator, "dopri5, or one of Simbody's as a cross-check");
  f.optional("relative_tolerance", s.relative_tolerance, "local error per step, relative", kRelative);
  f.optional("absolute_tolerance", s.absolute_tolerance, "local error per step, absolute", kAbsolute);
  f.optional("max_steps", s.max_steps, "per sample; more is a failure", kCount);
  f.optional("max_wall_time", s.max_wall_time, "per sample; more is a failure; s", kWallTime);
  f.optional("allowed_failures", s.allowed_failures,
             "fraction of the training or test samples that may fail before the run does", kFraction);
}

template <class Fields>
void describe(Fields&, ZScoreSpec&) {}

template <class Fields>
void describe(Fields& f, WhitenSpec& s) {
  f.optional("by", s.by, "each feature's own stddev, or the covariance, which makes noise independent too");
}

template <class Fields>
void describe(Fields& f, PrincipalComponentsSpec& s) {
  f.optional("components", s.components, "how many, or automatic");
  f.optional("explained_variance", s.explained_variance, "as many as explain this fraction", kFraction);
  f.rule(!s.components.number || !s.explained_variance,
         "must give components or explained_variance, not both");
}

template <class Fields>
void describe(Fields& f, PartialLeastSquaresSpec& s) {
  f.optional("components", s.components, "how many, or automatic: by cross-validation");
}

template <class Fields>
void describe(Fields& f, MutualInformationSpec& s) {
  f.required("count", s.count, "features to select", kCount);
  f.optional("neighbours", s.neighbours, "of the nearest-neighbour estimator", kThousand);
}

template <class Fields>
void describe(Fields& f, FisherInformationSpec& s) {
  f.required("count", s.count, "features to select", kCount);
}

template <class Fields>
void describe(Fields& f, SelectSpec& s) {
  f.optional("features", s.features, "their names, such as y(0.05 s)");
  f.optional("mutual_information", s.mutual_information, "relevant to the parameters, without redundancy");
  f.optional("fisher_information", s.fisher_information, "greedy D-optimal, by simulated sensitivities");
  f.rule(!s.features.empty() + s.mutual_information.has_value() + s.fisher_information.has_value() == 1,
         "must give one of features, mutual_information, fisher_information");
}

template <class Fields>
void describe(Fields& f, TransformStepSpec& s) {
  f.optional("z_score", s.z_score, "each feature minus its mean, over its standard deviation");
  f.optional("whiten", s.whiten, "features in units of their noise");
  f.optional("principal_components", s.principal_components,
             "projection on the directions of largest variance; by default those above the noise");
  f.optional("partial_least_squares", s.partial_least_squares,
             "projection on the directions that predict the parameters best");
  f.optional("select", s.select, "keeps some of the features");
  f.rule(s.z_score.has_value() + s.whiten.has_value() + s.principal_components.has_value() +
                 s.partial_least_squares.has_value() + s.select.has_value() ==
             1,
         "must be one of z_score, whiten, principal_components, partial_least_squares, select");
}

template <class Fields>
void describe(Fields& f, ModesNoiseSpec& s) {
  f.required("frequency", s.frequency, "standard deviation of every natural frequency; Hz", kNonNegative);
  f.required("damping_ratio", s.damping_ratio, "standard deviation of every damping ratio", kNonNegative);
}

template <class Fields>
void describe(Fields& f, NoiseCorrelationSpec& s) {
  f.optional("autoregression", s.autoregression,
             "a_i of e_k = a_1 e_{k-1} + a_2 e_{k-2} + ... + white noise");
  f.optional("values", s.values, "autocorrelation at lags 0, 1, 2 ...: [1, r_1, r_2, ...]; 0 beyond");
  f.optional("sample_time", s.sample_time, "of a lag; default: spacing of the output's feature times; s",
             kPositive);
  f.rule(s.autoregression.empty() != s.values.empty(), "must give exactly one of autoregression, values");
  f.rule(s.values.empty() || s.values.front() == 1.0, "must give values that begin with 1");
}

template <class Fields>
void describe(Fields& f, NoiseSpec& s) {
  f.optional("scale", s.scale, "multiplies every stddev", kNonNegative);
  f.optional("replicates", s.replicates,
             "noise draws per training simulation (default: 4, fewer for more than 750 samples)", kThousand);
  f.optionalMap("stddev", s.stddev, "standard deviation of each output's noise, in the output's unit");
  f.optionalMap("correlation", s.correlation, "of outputs whose noise is not white");
  f.optional("modes", s.modes, "of natural frequencies and damping ratios, where modes are features");
}

template <class Fields>
void describe(Fields& f, PointSetSpec& s) {
  f.optional("method", s.method, "how the parameter box is sampled");
  f.optional("samples", s.samples, "number of points", kSampleCount);
  f.optional("smallest", s.smallest,
             "nested_latin_hypercube: a Latin hypercube at this size and 2, 4, 8 ... times it (default 1)",
             kSampleCount);
  f.rule(!s.smallest || s.method == DesignMethod::kNestedLatinHypercube,
         "must give smallest with 'method: nested_latin_hypercube' only");
}

template <class Fields>
void describe(Fields& f, DesignSpec& s) {
  f.optional("train", s.train, "points to train on");
  f.optional("test", s.test, "points to test on");
}

template <class Fields>
void describe(Fields& f, GpBoundsSpec& s) {
  f.optional("length_scale", s.length_scale, "times the median distance of the training inputs");
  f.optional("signal_stddev", s.signal_stddev, "times the target's standard deviation");
  f.optional("noise_stddev", s.noise_stddev, "times the target's standard deviation");
  for (const Bounds* bounds : {&s.length_scale, &s.signal_stddev, &s.noise_stddev}) {
    f.rule(bounds->lower > 0.0, "must give lower bounds above 0");
  }
}

template <class Fields>
void describe(Fields& f, LengthScalePriorSpec& s) {
  f.optional("log_mean", s.log_mean, "mean of log(length scale / median distance)");
  f.optional("log_stddev", s.log_stddev, "standard deviation of the same", kPositive);
}

template <class Fields>
void describe(Fields& f, GpMapSpec& s) {
  f.optional("covariance", s.covariance, "covariance function");
  f.optional("linear_term", s.linear_term, "adds a linear term to the covariance function");
  f.optional("mean", s.mean, "mean function; its coefficients are integrated out");
  f.optional("noise", s.noise,
             "follows_slope: that of the features through the slope of the map; or constant");
  f.optional("length_scales", s.length_scales, "one for all features, per output, or per feature");
  f.optional("length_scale_prior", s.length_scale_prior, "log-normal prior; without it, maximum likelihood");
  f.optional("starts", s.starts, "optimisations of the marginal likelihood, from different points",
             kThousand);
  f.optional("max_evaluations", s.max_evaluations, "of the marginal likelihood, per start", kHundredThousand);
  f.optional("approximation", s.approximation, "exact, or sgpr: sparse on inducing inputs, for many samples");
  f.optional("inducing", s.inducing, "sgpr: inducing inputs", kHundredThousand);
  f.optional("subset", s.subset, "sgpr: samples on which an exact process finds the hyperparameters",
             kHundredThousand);
  f.optional("refine_evaluations", s.refine_evaluations, "sgpr: of the bound over all samples", kCountOrNone);
  f.optional("bounds", s.bounds, "of the hyperparameters");
  f.rule(s.approximation == GpApproximation::kExact || !s.linear_term,
         "must not have a linear_term with 'approximation: sgpr'");
}

template <class Fields>
void describe(Fields& f, InverseMapSpec& s) {
  f.optional("gp", s.gp, "one Gaussian process per parameter");
}

template <class Fields>
void describe(Fields& f, TrustSpec& s) {
  f.optional("level", s.level, "share of good measurements that may be called a mismatch of the model",
             kFraction);
}

template <class Fields>
void describe(Fields& f, ReportSpec& s) {
  f.optional("over", s.over, "two parameters: axes of the pictures of the inferred standard deviation",
             kNotEmpty);
  f.rule(s.over.empty() || s.over.size() == 2, "must name two parameters in 'over'");
}

template <class Fields>
void describe(Fields& f, GateSpec& s) {
  f.required("metric", s.metric, "a column of metrics.csv, such as coverage95 or ratio_to_limit");
  f.optional("parameter", s.parameter, "the parameter it holds for (default: every one)");
  f.optional("min", s.min, "least value that passes");
  f.optional("max", s.max, "greatest value that passes");
  f.rule(s.min || s.max, "must give min, max or both");
  f.rule(!s.min || !s.max || *s.min <= *s.max, "must have min not above max");
}

template <class Fields>
void describe(Fields& f, ExperimentSpec& s) {
  f.required("name", s.name, "letters, digits, '_', '-' and '.'; names the run's folder");
  f.optional("description", s.description, "for people");
  f.optional("seed", s.seed, "all randomness follows from it");
  f.requiredMap("parameters", s.model.parameters, "the updating parameters");
  f.optionalMap("nuisance", s.model.nuisance, "unknown parameters that are sampled, but not inferred");
  f.optionalMap("inputs", s.model.inputs, "known settings, sampled in training, given with a measurement");
  f.optionalMap("constants", s.model.constants, "named values for expressions");
  f.required("system", s.model.system, "the multibody model");
  f.optionalMap("excitation", s.model.excitation, "named signals for forces and moments");
  f.optional("initial", s.model.initial, "initial condition");
  f.optionalMap("outputs", s.model.outputs, "what is measured");
  f.optional("simulation", s.model.simulation, "how it is integrated");
  f.required("features", s.features, "what the inverse map sees of the response");
  f.optional("transform", s.transform, "steps from features to the inputs of the inverse map", kNotEmpty);
  f.required("noise", s.noise, "measurement noise, on training and test features");
  f.optional("design", s.design, "where the parameter box is sampled");
  f.optional("inverse_map", s.inverse_map, "from features to parameters");
  f.optional("evaluation", s.evaluation, "what is found out about the map besides its errors");
  f.optional("trust", s.trust, "how inferences from measurements are judged");
  f.optional("gates", s.gates, "conditions on the metrics; the report says which passed");
  f.optional("measurement", s.measurement, "how files of measurements are read");
  f.optional("report", s.report, "what the report shows");
  f.rule(!s.features.empty(), "must list at least one of features");
}

}  // namespace twinmap
