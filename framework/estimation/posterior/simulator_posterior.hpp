#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "framework/estimation/posterior/basins/basin_search.hpp"
#include "framework/estimation/posterior/draws/floor_draws.hpp"
#include "framework/estimation/posterior/draws/posterior_draws.hpp"
#include "framework/estimation/posterior/posterior_modes.hpp"
#include "framework/estimation/posterior/posterior_problem.hpp"
#include "framework/estimation/posterior/profile_likelihood.hpp"

namespace twinmap {

/// What the shape of a posterior says against it.
enum class PosteriorShape { kInformative, kUninformative, kMultimodal };

/// The posterior of unknown parameters given measurements, by simulation alone: normal noise, a prior within
/// the bounds. u parameters in their units. Moments, quantiles and draws are there only where it is reliable.
struct SimulatorPosterior {
  Eigen::VectorXd mean, stddev;      ///< u
  Eigen::VectorXd prior_stddev;      ///< u
  Eigen::MatrixXd covariance;        ///< u x u
  Eigen::MatrixXd draws;             ///< u x n, weighted by `weights`
  Eigen::VectorXd weights;           ///< n, sum 1
  Eigen::VectorXd best;              ///< all unknown, the least misfit; there where anything was simulated
  std::vector<PosteriorMode> modes;  ///< the heaviest first
  std::vector<Profile> profiles;     ///< of all unknown, in their units, where they were asked for
  std::vector<Eigen::Index>
      beyond;                   ///< of all unknown, those that fit best beyond a bound (findBeyondBounds)
  double misfit = 0.0;          ///< there: chi-square and that of the prior
  Eigen::MatrixXd information;  ///< there, of all unknown, in LogCoordinates
  Eigen::VectorXd residual;     ///< there, whitened; of one measurement after the other
  Eigen::VectorXd residual_weights;  ///< about 0 of outliers (LocalSurface::weights)
  /// Of a single measurement, as they are independent and of unit variance if its hypothesis is true.
  ResidualLoss::Standardized standardized;
  double chi_square = 0.0, degrees = 0.0;  ///< of the best point; 0 degrees where nothing could be simulated
  bool is_linear = false;  ///< whether draws are those of a linear response about the best fit
  double effective_sample_size = 0.0;
  double pareto_shape = 0.0;
  int starts = 0;       ///< searches for basins
  int found_best = 0;   ///< of them, those that ended in the best one
  int simulations = 0;  ///< those with derivatives count once
  std::string message;  ///< why it is not reliable; else empty
  /// u x n: where on the floors of its valleys it fits (findValleyPlaces), best first, in the place of draws
  /// where it is not reliable but noise explains it; empty else, and of more than kManyUnknown.
  Eigen::MatrixXd places;
  FloorDraws floor{};  ///< likewise, about these

  bool isReliable() const { return message.empty(); }
  /// Whether noise explains the best point (calcChiSquareLimit).
  bool isExplained() const;
  /// Whether several values that lie apart fit, or else one of the first p parameters is hardly better known
  /// than before (isUninformative). Only where it is reliable.
  PosteriorShape findShape(Eigen::Index p) const;
  /// Quantiles (u x k) at probabilities (k). Only where it is reliable.
  Eigen::MatrixXd calcQuantiles(const Eigen::VectorXd& probabilities) const;
  /// Draws of equal weight (u x n), one for each of the uniforms (n) in (0, 1). Only where it is reliable.
  Eigen::MatrixXd resample(const Eigen::VectorXd& uniforms) const;
};

struct SimulatorPosteriorOptions : PosteriorDrawOptions {
  BasinSearchOptions search{};
  /// Whether draws are those of a linear response about the best point where noise does not explain that:
  /// they would be of a wrong model.
  bool spares_misfit = false;
  /// Whether draws are wanted of what the search found (no draws are there yet); default: they are. Not
  /// reliable where they are not.
  std::function<bool(const SimulatorPosterior&)> wants_draws{};
  /// Of more than kManyUnknown: whether draws are those of a linear response about the best fit, within the
  /// prior and the bounds, without a simulation of any, where that does (sampleLinearModel).
  bool is_linear = false;
  bool profiles = false;  ///< whether profile likelihoods are wanted, of up to kManyUnknown, all drawn
};

/// Finds every basin (findBasins), then samples all of them together (importance::sampleAdaptively) in
/// LogCoordinates, with sums in the parameters themselves (findRidgeShape), from a mixture of what the linear
/// models in the basins say. Where the draws cannot be believed, they come from drawAlongWalks(), in the
/// parameters as they are. Without a map or a surrogate. given: points of the unknown parameters (u x n) to
/// search from as well. The result depends on neither threads nor other measurements. Cost: some 2000
/// simulations for the basins and `draws` a round.
SimulatorPosterior samplePosterior(const PosteriorProblem& problem, const Eigen::MatrixXd& given,
                                   const SimulatorPosteriorOptions& options);

/// The same of one measurement, of all unknown parameters of `model`.
SimulatorPosterior samplePosterior(Simulator& simulator, const RefinementModel& model,
                                   const std::vector<PriorGroupSpec>& priors, const Eigen::VectorXd& features,
                                   const Eigen::VectorXd& held, const Eigen::MatrixXd& given,
                                   const SimulatorPosteriorOptions& options);

/// The end of few searches: an infinite chi-square and no point where none could be simulated.
struct LeastMisfit {
  double chi_square = std::numeric_limits<double>::infinity();
  Eigen::VectorXd best{};  ///< all unknown parameters (u)
};

/// The best that three searches find, from the best of 32 points all over the bounds, and one from each given
/// point (u x n, may be empty) and from the start that measurements show (addShownStart). Of many parameters,
/// three steps from the given ones or the priors' medians. To compare gross misfits: no test of other basins.
/// Cost: 32 simulations and some 10 a search. Half of these have derivatives.
LeastMisfit findLeastMisfit(const PosteriorProblem& problem, const Eigen::MatrixXd& given = {});

}  // namespace twinmap
