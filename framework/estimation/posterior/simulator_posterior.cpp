#include "framework/estimation/posterior/simulator_posterior.hpp"

#include <algorithm>

#include "framework/base/log/search_stage.hpp"
#include "framework/estimation/estimate.hpp"
#include "framework/estimation/posterior/basins/search_team.hpp"
#include "framework/estimation/posterior/bound_test.hpp"
#include "framework/estimation/posterior/draws/linear_posterior.hpp"
#include "framework/estimation/posterior/draws/valley_places.hpp"
#include "framework/estimation/posterior/sampling_ways.hpp"
#include "framework/estimation/refined/acceptance.hpp"
#include "framework/experiment/check/known_names.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using importance::AdaptiveDraws;

namespace {

/// Of a single measurement, the residual as its hypothesis of the noise explains it.
ResidualLoss::Standardized standardize(MisfitSurface& surface, const MeasuredTrial& trial,
                                       const LocalSurface& best) {
  if (trial.make_misfit) {
    return {best.residual, {}, best.degrees, {}};
  }
  MatrixXd jacobian(best.residual.size(), 0);
  if (!trial.noise.outputs.empty()) {
    const VectorXd box = surface.getCoordinates().toBox(best.at);
    jacobian = surface.getParts().front().misfit->linearizeAll(box(trial.unknown)).front().jacobian;
  }
  return ResidualLoss(trial.noise, *trial.model, trial.model->getWhole())
      .standardize(best.residual, jacobian, best.degrees);
}

void setBest(const BasinSearch& found, const PosteriorProblem& problem, MisfitSurface& surface,
             SimulatorPosterior& posterior) {
  const Basin& best = found.basins.front();
  posterior.best = surface.getCoordinates().toParameters(best.local.at);
  posterior.beyond = findBeyondBounds(best.local);
  posterior.chi_square = best.local.chi_square;
  posterior.misfit = best.local.misfit;
  posterior.information = best.local.information;
  posterior.residual = best.local.residual;
  posterior.residual_weights = best.local.weights;
  posterior.degrees = best.local.degrees;
  posterior.found_best = best.searches;
  if (problem.trials.size() == 1) {
    posterior.standardized = standardize(surface, problem.trials.front(), best.local);
  }
  posterior.message = "not drawn from";
}

/// Moments, draws and modes, of the first parameters, as many as `coordinates` has.
void setDraws(const AdaptiveDraws& drawn, const Landscape& landscape, const LogCoordinates& coordinates,
              SimulatorPosterior& posterior) {
  posterior.weights = drawn.draws.weights;
  posterior.draws = toParameters(coordinates, drawn.draws.points);
  const importance::WeightedDraws draws{posterior.draws, posterior.weights};
  posterior.mean = importance::calcMean(draws);
  posterior.covariance = importance::calcCovariance(draws);
  posterior.stddev = posterior.covariance.diagonal().cwiseSqrt();
  noteStddevs({posterior.stddev.begin(), posterior.stddev.end()});
  posterior.modes = findModes(drawn.draws.points, posterior.draws, posterior.weights,
                              projectBasins(landscape.basins, coordinates.getCount()), landscape.connected);
}

/// What is identified is seen from the valleys, however badly they are sampled.
void setPlaces(const BasinSearch& found, ProblemSurface& whole, std::uint64_t seed,
               SimulatorPosterior& posterior) {
  std::vector<LocalSurface> places = findValleyPlaces(whole.upd(), found.basins, seed);
  places.insert(places.begin(), found.basins.front().local);
  const LogCoordinates& coordinates = whole.getCoordinates();
  posterior.places.resize(coordinates.getCount(), static_cast<Index>(places.size()));
  for (std::size_t k = 0; k < places.size(); ++k) {
    posterior.places.col(static_cast<Index>(k)) = coordinates.toParameters(places[k].at);
  }
  posterior.floor = drawAcrossValleys(places, coordinates, seed);
}

/// In the logarithms, whatever the draws were drawn in.
void setProfiles(const PosteriorProblem& problem, ProblemSurface& whole, SimulatorPosterior& posterior) {
  const LogCoordinates& coordinates = whole.getCoordinates();
  const importance::WeightedDraws draws{toCoordinates(coordinates, posterior.draws), posterior.weights};
  posterior.profiles = calcProfiles(whole.upd(), draws, posterior.misfit, problem.drawn);
  for (Profile& profile : posterior.profiles) {
    profile.points = toParameters(coordinates, profile.points);
  }
}

/// The three of the least chi-square of 32 points all over the bounds.
MatrixXd findLowest(MisfitSurface& surface) {
  constexpr int kPoints = 32, kLowest = 3;
  const MatrixXd points = makeStarts(surface.getDimensions(), 1, kPoints);
  const VectorXd misfits = surface.calcMisfits(points);
  std::vector<Index> order = sortIndices(
      kPoints, [&](Index a, Index b) { return std::isfinite(misfits[a]) && !(misfits[a] >= misfits[b]); });
  order.resize(kLowest);
  return points(Eigen::all, order);
}

}  // namespace

bool SimulatorPosterior::isExplained() const {
  return degrees > 0.0 && chi_square < calcChiSquareLimit(degrees);
}

PosteriorShape SimulatorPosterior::findShape(Index p) const {
  if (modes.size() > 1) {
    return PosteriorShape::kMultimodal;
  }
  return isUninformative(stddev.head(p), prior_stddev.head(p)) ? PosteriorShape::kUninformative
                                                               : PosteriorShape::kInformative;
}

MatrixXd SimulatorPosterior::calcQuantiles(const VectorXd& probabilities) const {
  return importance::calcQuantiles({draws, weights}, probabilities);
}

MatrixXd SimulatorPosterior::resample(const VectorXd& uniforms) const {
  return importance::resample({draws, weights}, uniforms);
}

SimulatorPosterior samplePosterior(const PosteriorProblem& problem, const MatrixXd& given,
                                   const SimulatorPosteriorOptions& options) {
  ProblemSurface whole(problem);
  MisfitSurface& surface = whole.upd();
  const LogCoordinates& coordinates = whole.getCoordinates();
  std::optional<SearchStage> stage(std::in_place, "search for the best fit");
  beginBest(collectNames(problem.unknown));
  const MatrixXd starts =
      addShownStart(problem, addMedian(given, whole.getPrior(), surface.getDimensions(), problem.drawn));
  const BasinSearch found = findBasins(surface, toCoordinates(coordinates, starts), options.seed,
                                       limitSearch(options.search, problem.drawn));
  SimulatorPosterior posterior;
  posterior.starts = found.starts;
  posterior.simulations = surface.getSimulations();
  if (found.basins.empty()) {
    posterior.message = "every search failed at its first simulation";
    return posterior;
  }
  stage.reset();
  stage.emplace("draw from the posterior");
  setBest(found, problem, surface, posterior);
  if (options.wants_draws && !options.wants_draws(posterior)) {
    return posterior;
  }
  std::optional<Sampling> linear;
  const bool is_spared =
      options.spares_misfit && !posterior.isExplained() && areOneBasin(surface, found.basins);
  if (is_spared || (options.is_linear && problem.drawn > kManyUnknown)) {
    linear = sampleLinearModel(problem, found, whole, posterior.isExplained(), options);
  }
  const Sampling sampling = linear ? *linear : samplePosterior(problem, found, whole, options);
  posterior.is_linear = linear.has_value();
  posterior.simulations = surface.getSimulations() + sampling.simulations;
  posterior.effective_sample_size = sampling.drawn.effective_sample_size;
  posterior.pareto_shape = sampling.drawn.pareto_shape;
  posterior.message = sampling.obstacle;
  if (posterior.isReliable()) {
    const std::vector<ParameterSpec> kept(problem.unknown.begin(), problem.unknown.begin() + problem.drawn);
    setDraws(sampling.drawn, sampling.landscape, LogCoordinates(kept, sampling.plain), posterior);
    posterior.prior_stddev = whole.getPrior().calcStddevs().head(problem.drawn);
    if (options.profiles && problem.drawn == surface.getDimensions() && problem.drawn <= kManyUnknown) {
      const SearchStage profiles("profiles of the likelihood");
      setProfiles(problem, whole, posterior);
    }
  } else if (posterior.isExplained() && mayBend(problem)) {
    setPlaces(found, whole, options.seed, posterior);
    posterior.simulations = surface.getSimulations() + sampling.simulations;
  }
  return posterior;
}

SimulatorPosterior samplePosterior(Simulator& simulator, const RefinementModel& model,
                                   const std::vector<PriorGroupSpec>& priors, const VectorXd& features,
                                   const VectorXd& held, const MatrixXd& given,
                                   const SimulatorPosteriorOptions& options) {
  PosteriorProblem problem{model.getUnknown(), priors, {}, static_cast<Index>(model.getUnknown().size())};
  problem.trials.push_back({&simulator, &model, features, held, listIndices(problem.unknown.size())});
  return samplePosterior(problem, given, options);
}

LeastMisfit findLeastMisfit(const PosteriorProblem& problem, const MatrixXd& given) {
  constexpr int kSteps = 3;  // of many parameters, from the priors' medians
  ProblemSurface whole(problem);
  MisfitSurface& surface = whole.upd();
  const MatrixXd near =
      addShownStart(problem, addMedian(given, whole.getPrior(), surface.getDimensions(), problem.drawn));
  const bool has_many = near.cols() > 0 && surface.getDimensions() > kManyUnknown;
  const MatrixXd lowest = has_many ? MatrixXd(surface.getDimensions(), 0) : findLowest(surface);
  MatrixXd starts(surface.getDimensions(), lowest.cols() + near.cols());
  starts.leftCols(lowest.cols()) = lowest;
  if (near.cols() > 0) {
    starts.rightCols(near.cols()) = toCoordinates(whole.getCoordinates(), near);
  }
  SearchTeam team(surface, starts);
  team.run(has_many ? kSteps : BasinSearchOptions{}.max_iterations);
  LeastMisfit best;
  for (const LocalSurface& end : team.listEnds()) {
    if (end.chi_square < best.chi_square) {
      best = {end.chi_square, whole.getCoordinates().toParameters(end.at)};
    }
  }
  return best;
}

}  // namespace twinmap
