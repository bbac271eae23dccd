#pragma once

#include <algorithm>
#include <optional>
#include <variant>
#include <vector>

#include "framework/experiment/fields/fields.hpp"
#include "framework/experiment/fields/one_of.hpp"
#include "framework/experiment/model/bounds_spec.hpp"

namespace twinmap {

enum class GpCovariance { kSquaredExponential, kMatern32, kMatern52, kRationalQuadratic };

template <>
struct EnumNames<GpCovariance> {
  static constexpr EnumName<GpCovariance> values[] = {
      {"squared_exponential", GpCovariance::kSquaredExponential},
      {"matern32", GpCovariance::kMatern32},
      {"matern52", GpCovariance::kMatern52},
      {"rational_quadratic", GpCovariance::kRationalQuadratic},
  };
};

enum class GpMean { kConstant, kZero, kLinear };

template <>
struct EnumNames<GpMean> {
  static constexpr EnumName<GpMean> values[] = {
      {"constant", GpMean::kConstant}, {"zero", GpMean::kZero}, {"linear", GpMean::kLinear}};
};

/// Exact, or the variational sparse approximation on inducing inputs (SGPR; Titsias 2009).
enum class GpApproximation { kExact, kSgpr };

template <>
struct EnumNames<GpApproximation> {
  static constexpr EnumName<GpApproximation> values[] = {{"exact", GpApproximation::kExact},
                                                         {"sgpr", GpApproximation::kSgpr}};
};

/// The noise of a parameter: one standard deviation, or that of the features through the slope of the map.
enum class GpNoise { kFollowsSlope, kConstant };

template <>
struct EnumNames<GpNoise> {
  static constexpr EnumName<GpNoise> values[] = {{"follows_slope", GpNoise::kFollowsSlope},
                                                 {"constant", GpNoise::kConstant}};
};

enum class LengthScales { kShared, kPerOutput, kPerFeature };

template <>
struct EnumNames<LengthScales> {
  static constexpr EnumName<LengthScales> values[] = {
      {"shared", LengthScales::kShared},
      {"per_output", LengthScales::kPerOutput},
      {"per_feature", LengthScales::kPerFeature},
  };
};

/// Bounds of the hyperparameters during training, relative to the natural scale of each.
struct GpBoundsSpec {
  Bounds length_scale{1e-2, 1e3, {}};   ///< times the median distance of the training inputs
  Bounds signal_stddev{1e-2, 1e3, {}};  ///< times the standard deviation of the target
  Bounds noise_stddev{1e-5, 3.0, {}};   ///< times the standard deviation of the target
};

template <class Fields>
void describe(Fields& f, GpBoundsSpec& s) {
  f.optional("length_scale", s.length_scale, "times the median distance of the training inputs");
  f.optional("signal_stddev", s.signal_stddev, "times the target's standard deviation");
  f.optional("noise_stddev", s.noise_stddev, "times the target's standard deviation");
  for (const Bounds* bounds : {&s.length_scale, &s.signal_stddev, &s.noise_stddev}) {
    f.rule(bounds->lower > 0.0, "must give lower bounds above 0");
  }
}

/// A log-normal prior on each length scale l: log(l / median distance) ~ N(log_mean, log_stddev^2).
struct LengthScalePriorSpec {
  double log_mean = 0.0;
  double log_stddev = 2.0;
};

template <class Fields>
void describe(Fields& f, LengthScalePriorSpec& s) {
  f.optional("log_mean", s.log_mean, "mean of log(length scale / median distance)");
  f.optional("log_stddev", s.log_stddev, "standard deviation of the same", kPositive);
}

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

/// A Gaussian process surrogate of the simulator, from parameters to features, inverted for each measurement.
struct SurrogateMapSpec {};

template <class Fields>
void describe(Fields&, SurrogateMapSpec&) {}

/// What a network learns from.
enum class NetworkSamples { kAutomatic, kSimulations, kSurrogate };

template <>
struct EnumNames<NetworkSamples> {
  static constexpr EnumName<NetworkSamples> values[] = {{"automatic", NetworkSamples::kAutomatic},
                                                        {"simulations", NetworkSamples::kSimulations},
                                                        {"surrogate", NetworkSamples::kSurrogate}};
};

inline constexpr NumberRule kMixtureComponents{2.0, 4.0, true, "must be a whole number from 2 to 4"};

/// The distribution that a network's estimates have.
enum class NetworkHead { kGaussian, kMixture };

template <>
struct EnumNames<NetworkHead> {
  static constexpr EnumName<NetworkHead> values[] = {{"gaussian", NetworkHead::kGaussian},
                                                     {"mixture", NetworkHead::kMixture}};
};

/// Which weights of a network are known by a distribution, not by their best values.
enum class NetworkBayes { kNone, kLastLayer, kHamiltonian };

template <>
struct EnumNames<NetworkBayes> {
  static constexpr EnumName<NetworkBayes> values[] = {{"none", NetworkBayes::kNone},
                                                      {"last_layer", NetworkBayes::kLastLayer},
                                                      {"hamiltonian", NetworkBayes::kHamiltonian}};
};

/// A neural network from features to the distribution of all parameters (docs/explanation/networks.md).
struct NetworkMapSpec {
  std::optional<std::vector<int>> hidden;
  NetworkHead head = NetworkHead::kGaussian;
  int components = 3;  ///< of a mixture
  NetworkSamples samples_from = NetworkSamples::kAutomatic;
  int surrogate_samples = 20000;
  std::optional<int> steps;
  std::optional<int> batch;
  std::optional<double> learning_rate;
  NetworkBayes bayesian = NetworkBayes::kNone;
  int chains = 4;   ///< of a Hamiltonian sampler
  int draws = 500;  ///< of each chain, after as many to warm up

  int countComponents() const { return head == NetworkHead::kMixture ? components : 1; }
  /// A surrogate of more simulations than kMaxOfSurrogate takes longer than the network learns from it.
  bool mayLearnFromSurrogate(int simulations) const {
    return samples_from == NetworkSamples::kSurrogate ||
           (samples_from == NetworkSamples::kAutomatic && bayesian != NetworkBayes::kHamiltonian &&
            simulations <= kMaxOfSurrogate);
  }

  static constexpr int kMaxOfSurrogate = 2000;
  /// So many simulations teach more (NetworkSize), and those held out tell how calibrated it is.
  static constexpr int kMany = kMaxOfSurrogate + 1;
  static constexpr int kVeryMany = 20000;
};

template <class Fields>
void describe(Fields& f, NetworkMapSpec& s) {
  constexpr int kWidest = 1024;
  constexpr std::size_t kDeepest = 8;
  constexpr NumberRule kChains{2.0, 64.0, true, "must be a whole number from 2 to 64"};
  constexpr NumberRule kDraws{20.0, 1e5, true, "must be a whole number from 20 to 100000"};
  f.optional("hidden", s.hidden,
             "units of each hidden layer (default: 64, 64; of 20000 simulations or more 192, 192; where they "
             "are sampled 8)");
  f.optional("head", s.head, "one normal distribution, or a mixture: where estimates may be multimodal");
  f.optional("components", s.components, "normal distributions of a mixture", kMixtureComponents);
  f.optional("samples_from", s.samples_from,
             "simulations; a surrogate that is trained on them first; or automatic");
  f.optional("surrogate_samples", s.surrogate_samples, "parameter points that a surrogate is asked for",
             kSampleCount);
  f.optional("steps", s.steps, "of the optimiser (default: 8000; of more than 2000 simulations 18000)",
             kSampleCount);
  f.optional("batch", s.batch,
             "samples of a step, each with its own draw of the noise (default: 256; of more than "
             "2000 simulations 1024)",
             kHundredThousand);
  f.optional("learning_rate", s.learning_rate,
             "its largest value (default: 0.002; of more than 2000 simulations 0.004)", kPositive);
  f.optional(
      "bayesian", s.bayesian,
      "last_layer: five networks, of whose last layers the exact posterior is known; hamiltonian: draws "
      "of all weights of a small network, for studies");
  f.optional("chains", s.chains, "of the Hamiltonian sampler", kChains);
  f.optional("draws", s.draws, "that each chain keeps, after as many to warm up", kDraws);
  f.rule(!s.hidden || (!s.hidden->empty() && s.hidden->size() <= kDeepest &&
                       std::all_of(s.hidden->begin(), s.hidden->end(),
                                   [](int units) { return units >= 1 && units <= kWidest; })),
         "must give 1 to 8 hidden layers of 1 to 1024 units");
  f.rule(s.bayesian == NetworkBayes::kNone || s.head == NetworkHead::kGaussian,
         "must have 'head: gaussian' with bayesian");
  f.rule(s.bayesian != NetworkBayes::kHamiltonian || s.samples_from != NetworkSamples::kSurrogate,
         "must learn from simulations with 'bayesian: hamiltonian'");
  f.rule(s.surrogate_samples >= 1000, "must give at least 1000 surrogate_samples");
}

/// A surrogate where it can be trained: all features have noise, and the samples suffice; else gp, with its
/// defaults.
struct AutomaticMapSpec {
  GpMapSpec gp;
};

template <class Fields>
void describe(Fields&, AutomaticMapSpec&) {}

/// None: each measurement is answered by the exact posterior on the simulator
/// (docs/how-to/sample-the-posterior.md).
struct NoMapSpec {};

template <class Fields>
void describe(Fields&, NoMapSpec&) {}

struct InverseMapSpec {
  std::variant<AutomaticMapSpec, GpMapSpec, SurrogateMapSpec, NetworkMapSpec, NoMapSpec> kind;

  bool isNone() const { return std::holds_alternative<NoMapSpec>(kind); }
  bool isAutomatic() const { return std::holds_alternative<AutomaticMapSpec>(kind); }
  /// Null for another kind.
  const GpMapSpec* findGp() const { return std::get_if<GpMapSpec>(&kind); }
  GpMapSpec* findGp() { return std::get_if<GpMapSpec>(&kind); }
  const NetworkMapSpec* findNetwork() const { return std::get_if<NetworkMapSpec>(&kind); }
  /// Of Gaussian processes from features to parameters, where there are to be any; null for other maps.
  const GpMapSpec* findProcesses() const {
    const auto* automatic = std::get_if<AutomaticMapSpec>(&kind);
    return automatic != nullptr ? &automatic->gp : findGp();
  }
};

template <class Fields>
void describe(Fields& f, InverseMapSpec& s) {
  f.scalarIsKey();
  f.oneOf("must be one of",
          choice<AutomaticMapSpec>("automatic", s.kind, "a surrogate where it can be trained, else gp"),
          choice<GpMapSpec>("gp", s.kind, "one Gaussian process per parameter"),
          choice<SurrogateMapSpec>("surrogate", s.kind,
                                   "processes from parameters to features, inverted for each measurement"),
          choice<NetworkMapSpec>("network", s.kind, "a neural network, the fastest to infer"),
          choice<NoMapSpec>("none", s.kind,
                            "no map: each measurement is estimated by its posterior on the simulator"));
}

}  // namespace twinmap
