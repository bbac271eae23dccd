#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "framework/estimation/estimate.hpp"
#include "framework/estimation/posterior/noise/residual_test.hpp"
#include "framework/estimation/posterior/simulator_posterior.hpp"
#include "framework/estimation/surrogate/posterior/posterior_sampler.hpp"
#include "framework/experiment/model/model_spec.hpp"

namespace twinmap {

/// What the likelihood of a posterior is computed by.
enum class PosteriorSource { kSurrogate, kSimulator };

/// "surrogate", "simulator".
const char* toString(PosteriorSource source);

/// What was found of an output's noise, by name.
struct NoiseReport {
  std::string output, unit;
  double stated = 0.0;  ///< standard deviation, in the output's unit; 0 where it is stated to be unknown
  double stddev = 0.0;  ///< found
  FoundNoise found;

  bool isStated() const { return stated > 0.0; }
  /// Whether it has significantly another size than stated.
  bool differs() const;
};

/// How well the simulator explains a measurement at its best, and what it took to find that.
struct SimulatorFit {
  double chi_square = 0.0, degrees = 0.0;  ///< 0 degrees of freedom where nothing could be simulated
  bool explained = false;                  ///< SimulatorPosterior::isExplained()
  Eigen::VectorXd residual;                ///< whitened
  ResidualTest test;
  std::string largest_feature{};  ///< its name
  std::vector<std::string>
      outliers{};  ///< features that are not noise and count for nothing, with their size
  std::vector<Eigen::Index> outlier_features{};  ///< their numbers among the experiment's
  std::vector<NoiseReport> noise{};              ///< of the outputs of which something was inferred
  Eigen::VectorXd best{};                        ///< the unknown parameters (u)
  std::vector<std::string> beyond{};  ///< of them, those that fit best beyond a bound (findBeyondBounds)
  int searches = 0, found_best = 0, simulations = 0;

  bool isSimulated() const { return degrees > 0.0; }
  bool isPlausible() const { return test.isPlausible(); }
  /// Not of several measurements together, each of which is tested alone.
  bool isTested() const { return residual.size() > 0 || !isSimulated(); }
  /// Whether the noise was supposed to be as it is stated.
  bool isAsStated() const;
  /// What is left is so much that no noise is taken for it (kGrossMisfit).
  bool isGross() const;
  /// Of the noise over that stated, of the output where it differs most; 1 where it does nowhere.
  double getNoiseFactor() const;
  bool isColoured() const;
  bool hasOffset() const;
};

/// A posterior by draws, whoever drew them, as an estimate of the p parameters that are reported.
struct PosteriorEstimate {
  PosteriorSource source = PosteriorSource::kSurrogate;
  Estimate estimate;  ///< with draws of all unknown parameters; not given unless it is reliable
  double effective_sample_size = 0.0;
  double pareto_shape = 0.0;
  int evaluations = 0;              ///< draws of all rounds
  std::string message;              ///< why it is not reliable; else empty
  std::string doubt{};              ///< what speaks against the surrogate's (findPosteriorDoubt); else empty
  std::optional<SimulatorFit> fit;  ///< where it is the simulator's
  PosteriorShape shape = PosteriorShape::kInformative;  ///< of the simulator's, where it is reliable
  std::vector<Profile> profiles;                        ///< likewise, where they were asked for
  Eigen::MatrixXd places{};                             ///< SimulatorPosterior::places
  FloorDraws floor{};                                   ///< SimulatorPosterior::floor
  /// Where it is not reliable: what is determined of the parameters that are reported all the same, by those
  /// draws; NaN of the others (FloorDraws::determine).
  Estimate determined{};
  std::vector<ParameterSpec> nuisance{};  ///< of the simulator's: drawn behind those reported

  bool isReliable() const { return message.empty(); }
  /// "ok", "unreliable", or "posterior_uncalibrated" of a surrogate's that is in doubt.
  const char* getStatus() const;
};

/// unknown: all u parameters that were drawn. doubt: PosteriorEstimate::doubt.
PosteriorEstimate makePosteriorEstimate(const SurrogatePosterior& posterior,
                                        const std::vector<ParameterSpec>& unknown, const std::string& doubt);
/// p: how many of them are reported, the first ones; infos: of the residuals, which are tested as they should
/// be independent and of unit variance (SimulatorPosterior::standardized): outliers not at all, noise of
/// unknown size by its shape alone; of several measurements together none. The reports of the noise have no
/// names yet.
PosteriorEstimate makePosteriorEstimate(const SimulatorPosterior& posterior,
                                        const std::vector<ParameterSpec>& unknown, Eigen::Index p,
                                        const std::vector<FeatureInfo>& infos);

/// Probabilities of the quantiles that are printed of an estimate by draws.
constexpr std::array<double, 5> kQuantileProbabilities{0.025, 0.16, 0.5, 0.84, 0.975};

/// Of each parameter (p x kQuantileProbabilities) of an estimate by draws.
Eigen::MatrixXd calcQuantiles(const Estimate& estimate);

/// Adds what a posterior's shape says against it, "multimodal" or "uninformative", to a list of statuses.
void addStatus(PosteriorShape shape, std::vector<std::string>& statuses);

}  // namespace twinmap
