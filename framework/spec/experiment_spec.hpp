#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "framework/spec/feature_spec.hpp"
#include "framework/spec/gate_spec.hpp"
#include "framework/spec/measurement_spec.hpp"
#include "framework/spec/model_spec.hpp"

namespace twinmap {

/// Each feature minus its mean, over its standard deviation.
struct ZScoreSpec {};

/// By stddev: each feature over the standard deviation of its noise. By covariance: combinations of features
/// whose noise is independent and of unit variance, for features whose noise is correlated.
enum class WhitenBy { kStddev, kCovariance };
struct WhitenSpec {
  WhitenBy by = WhitenBy::kStddev;
};

/// How many components a projection keeps; none: automatic.
struct ComponentCount {
  std::optional<int> number;
};

/// Principal components of the training features, those of largest variance. How many: as given, or enough to
/// explain a fraction of the variance, or by default those that stand above the noise of whitened features.
struct PrincipalComponentsSpec {
  ComponentCount components;
  std::optional<double> explained_variance;
};

/// Directions of the training features that have most covariance with the parameters, those that predict
/// other simulations best by default.
struct PartialLeastSquaresSpec {
  ComponentCount components;
};

/// The features that tell most about the parameters beyond what those selected before tell, by mutual
/// information.
struct MutualInformationSpec {
  int count = 0;
  int neighbours = 3;  ///< of the estimator
};

/// The features that determine the parameters best, to first order: greedy D-optimal selection.
struct FisherInformationSpec {
  int count = 0;
};

/// Some of the features; exactly one member is given.
struct SelectSpec {
  std::vector<Name> features;
  std::optional<MutualInformationSpec> mutual_information;
  std::optional<FisherInformationSpec> fisher_information;
};

/// One step from features to the inputs of the inverse map, fitted on the training features; exactly one
/// member is set.
struct TransformStepSpec {
  std::optional<ZScoreSpec> z_score;
  std::optional<WhitenSpec> whiten;
  std::optional<PrincipalComponentsSpec> principal_components;
  std::optional<PartialLeastSquaresSpec> partial_least_squares;
  std::optional<SelectSpec> select;
  SourceLocation where;
};

struct OutputNoiseSpec {
  Name name;            ///< an output
  double stddev = 0.0;  ///< in the output's unit
};

/// Correlation of an output's noise e_k over its samples; one of the two lists is given.
struct NoiseCorrelationSpec {
  Name name;                           ///< an output
  std::vector<double> autoregression;  ///< a_i of e_k = a_1 e_{k-1} + a_2 e_{k-2} + ... + w_k
  std::vector<double> values;          ///< autocorrelation at lags 0, 1, 2 ...; 0 beyond
  std::optional<double> sample_time;   ///< s, of a lag; default: the spacing of the output's feature times
};

/// Noise of the modes' natural frequencies and damping ratios, as identified from a measurement.
struct ModesNoiseSpec {
  double frequency = 0.0;      ///< standard deviation, Hz
  double damping_ratio = 0.0;  ///< standard deviation
};

/// Normal noise on every sample of every output, independent unless correlated, in training and test alike.
struct NoiseSpec {
  double scale = 1.0;             ///< multiplies every stddev
  std::optional<int> replicates;  ///< noise draws per training simulation; default 4, fewer for many samples
  std::vector<OutputNoiseSpec> stddev;
  std::optional<ModesNoiseSpec> modes;
  std::vector<NoiseCorrelationSpec> correlation{};  ///< of the outputs whose noise is not white
};

enum class DesignMethod { kLatinHypercube, kNestedLatinHypercube, kSobol, kUniform };

/// Points in the parameter box.
struct PointSetSpec {
  DesignMethod method = DesignMethod::kLatinHypercube;
  int samples = 0;
  std::optional<int>
      smallest;  ///< nested_latin_hypercube: Latin at this size and 2, 4, 8 ... times it; default 1
};

struct DesignSpec {
  PointSetSpec train{DesignMethod::kLatinHypercube, 250, {}};
  PointSetSpec test{DesignMethod::kUniform, 500, {}};
};

enum class GpCovariance { kSquaredExponential, kMatern32, kMatern52, kRationalQuadratic };
enum class GpMean { kConstant, kZero, kLinear };
/// Exact, or the variational sparse approximation on inducing inputs (SGPR; Titsias 2009).
enum class GpApproximation { kExact, kSgpr };
/// The noise of a parameter: one standard deviation, or that of the features through the slope of the map.
enum class GpNoise { kFollowsSlope, kConstant };
enum class LengthScales { kShared, kPerOutput, kPerFeature };

/// Bounds of the hyperparameters during training, relative to the natural scale of each.
struct GpBoundsSpec {
  Bounds length_scale{1e-2, 1e3, {}};   ///< times the median distance of the training inputs
  Bounds signal_stddev{1e-2, 1e3, {}};  ///< times the standard deviation of the target
  Bounds noise_stddev{1e-5, 3.0, {}};   ///< times the standard deviation of the target
};

/// A log-normal prior on each length scale l: log(l / median distance) ~ N(log_mean, log_stddev^2).
struct LengthScalePriorSpec {
  double log_mean = 0.0;
  double log_stddev = 2.0;
};

/// One Gaussian process per parameter, hyperparameters by maximum marginal likelihood.
struct GpMapSpec {
  GpCovariance covariance = GpCovariance::kSquaredExponential;
  bool linear_term = false;  ///< adds a linear covariance term
  GpMean mean = GpMean::kConstant;
  GpNoise noise = GpNoise::kFollowsSlope;
  LengthScales length_scales = LengthScales::kPerFeature;  ///< after a projection: per component
  std::optional<LengthScalePriorSpec> length_scale_prior;  ///< none: maximum likelihood
  int starts = 2;
  int max_evaluations = 200;  ///< of the marginal likelihood, per start
  GpApproximation approximation = GpApproximation::kExact;
  int inducing = 500;            ///< sgpr: inducing inputs
  int subset = 1000;             ///< sgpr: samples on which an exact process finds the hyperparameters
  int refine_evaluations = 100;  ///< sgpr: of the variational bound over all samples; 0 for none
  GpBoundsSpec bounds;
};

struct InverseMapSpec {
  GpMapSpec gp;
};

/// The exact posterior of some test samples by importance sampling of the simulator.
struct PosteriorSpec {
  int samples = 20;  ///< the first that could be simulated
  int draws = 500;   ///< simulations of each, and per round
};

/// Inverse maps to compare with, on the same test samples.
struct PriorMeanSpec {};
struct LinearRegressionSpec {};

enum class LeastSquaresStart { kBoxCenter, kNearestTraining };

/// Classical iterative updating of each test sample by the simulator itself.
struct LeastSquaresSpec {
  int samples = 50;  ///< the first that could be simulated
  LeastSquaresStart start = LeastSquaresStart::kBoxCenter;
  int max_simulations = 500;  ///< of each sample
};

/// Exactly one member is set.
struct BaselineSpec {
  std::optional<PriorMeanSpec> prior_mean;
  std::optional<LinearRegressionSpec> linear_regression;
  std::optional<LeastSquaresSpec> least_squares;
  SourceLocation where;
};

struct EvaluationSpec {
  bool limit = true;  ///< the information limit of every test sample
  std::optional<PosteriorSpec> posterior;
  std::vector<BaselineSpec> baselines;
};

/// How inferences are judged.
struct TrustSpec {
  double level = 0.01;  ///< share of good measurements that are called a mismatch of the model
};

struct ReportSpec {
  std::vector<Name> over;  ///< two parameters: axes of the pictures of the inferred sd; default the last two
};

/// A whole experiment, as described by one YAML file.
struct ExperimentSpec {
  Name name;
  std::string description;
  std::uint64_t seed = 1;
  ModelSpec model;
  std::vector<FeatureSpec> features;
  std::vector<TransformStepSpec> transform;  ///< default: whiten, principal_components
  NoiseSpec noise;
  DesignSpec design;
  InverseMapSpec inverse_map;
  EvaluationSpec evaluation;
  TrustSpec trust;
  std::vector<GateSpec> gates;
  MeasurementSpec measurement;  ///< for inferring from files; no simulation depends on it
  ReportSpec report;
};

}  // namespace twinmap
