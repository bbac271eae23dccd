#include "framework/estimation/posterior/simulator_posterior.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <memory>
#include <numeric>

#include "framework/estimation/informativeness.hpp"
#include "framework/estimation/posterior/bound_test.hpp"
#include "framework/estimation/posterior/draws/linear_posterior.hpp"
#include "framework/estimation/posterior/draws/posterior_draws.hpp"
#include "framework/estimation/posterior/profile_likelihood.hpp"
#include "framework/estimation/posterior/search_team.hpp"
#include "framework/estimation/posterior/straight_ridge.hpp"
#include "framework/estimation/refined/acceptance.hpp"
#include "framework/estimation/segments/segmented_misfit.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using importance::AdaptiveDraws;

namespace {

MatrixXd toCoordinates(const LogCoordinates& coordinates, const MatrixXd& points) {
  MatrixXd at(points.rows(), points.cols());
  for (Index i = 0; i < points.cols(); ++i) {
    at.col(i) = coordinates.fromParameters(points.col(i));
  }
  return at;
}

MatrixXd toParameters(const LogCoordinates& coordinates, const MatrixXd& at) {
  MatrixXd points(at.rows(), at.cols());
  for (Index i = 0; i < at.cols(); ++i) {
    points.col(i) = coordinates.toParameters(at.col(i));
  }
  return points;
}

/// The misfits of all measurements, and the surface that they make. plain: of LogCoordinates.
class ProblemSurface {
 public:
  explicit ProblemSurface(const PosteriorProblem& problem, const std::vector<Index>& plain = {})
      : coordinates_(problem.unknown, plain),
        prior_(problem.unknown, problem.priors),
        surface_(makeParts(problem), coordinates_, prior_) {}

  MisfitSurface& upd() { return surface_; }
  const LogCoordinates& getCoordinates() const { return coordinates_; }
  const Prior& getPrior() const { return prior_; }

 private:
  struct Part {
    explicit Part(const MeasuredTrial& trial)
        : box(trial.model->getUnknown(), {0, static_cast<Index>(trial.model->getUnknown().size())},
              trial.held),
          misfit(*trial.simulator, *trial.model, box, trial.features) {}

    const SearchBox box;
    Misfit misfit;
  };

  std::vector<MeasuredPart> makeParts(const PosteriorProblem& problem) {
    std::vector<MeasuredPart> parts;
    for (const MeasuredTrial& trial : problem.trials) {
      if (trial.segments) {
        segmented_.push_back(std::make_unique<SegmentedMisfit>(*trial.simulator, *trial.segments));
        parts.push_back({segmented_.back().get(), nullptr, trial.unknown});
        continue;
      }
      parts_.push_back(std::make_unique<Part>(trial));
      parts.push_back(
          {&parts_.back()->misfit, trial.model, trial.unknown, makeLosses(trial.noise, *trial.model)});
    }
    return parts;
  }

  const LogCoordinates coordinates_;
  const Prior prior_;
  std::vector<std::unique_ptr<Part>> parts_;
  std::vector<std::unique_ptr<SegmentedMisfit>> segmented_;
  MisfitSurface surface_;
};

/// The same basins in the coordinates of another surface of the same problem: those that are one there,
/// because a ridge is straight, once.
std::vector<Basin> convertBasins(const std::vector<Basin>& basins, const LogCoordinates& coordinates,
                                 MisfitSurface& surface) {
  MatrixXd points(coordinates.getCount(), static_cast<Index>(basins.size()));
  for (std::size_t k = 0; k < basins.size(); ++k) {
    points.col(static_cast<Index>(k)) =
        surface.getCoordinates().fromParameters(coordinates.toParameters(basins[k].local.at));
  }
  std::vector<LocalSurface> ends = surface.linearize(points);
  const auto failed =
      std::remove_if(ends.begin(), ends.end(), [](const LocalSurface& end) { return !end.simulated; });
  ends.erase(failed, ends.end());
  return collectBasins(std::move(ends));
}

void setBest(const BasinSearch& found, const LogCoordinates& coordinates, SimulatorPosterior& posterior) {
  const Basin& best = found.basins.front();
  posterior.best = coordinates.toParameters(best.local.at);
  posterior.beyond = findBeyondBounds(best.local);
  posterior.chi_square = best.local.chi_square;
  posterior.misfit = best.local.misfit;
  posterior.information = best.local.information;
  posterior.residual = best.local.residual;
  posterior.residual_weights = best.local.weights;
  posterior.degrees = best.local.degrees;
  posterior.found_best = best.searches;
}

/// Of a single measurement, the residual as its hypothesis of the noise explains it.
ResidualLoss::Standardized standardize(MisfitSurface& surface, const MeasuredTrial& trial,
                                       const LocalSurface& best) {
  if (trial.segments) {
    return {best.residual, best.degrees, {}};
  }
  MatrixXd jacobian(best.residual.size(), 0);
  if (!trial.noise.outputs.empty()) {
    const VectorXd box = surface.getCoordinates().toBox(best.at);
    jacobian = surface.getParts().front().misfit->linearizeAll(box(trial.unknown)).front().jacobian;
  }
  return ResidualLoss(trial.noise, *trial.model, trial.model->getWhole())
      .standardize(best.residual, jacobian, best.degrees);
}

/// Draws, and the coordinates in which they were drawn.
struct Sampling {
  std::vector<Index> plain;  ///< of LogCoordinates
  Landscape landscape;
  AdaptiveDraws drawn;
  std::string obstacle;  ///< why they are not to be believed; else empty
  int simulations = 0;   ///< of surfaces other than that of the searches
};

std::string findObstacle(const PosteriorProblem& problem, MisfitSurface& surface, const Sampling& sampling) {
  const std::vector<Basin>& basins = sampling.landscape.basins;
  if (problem.drawn > kManyUnknown && !areOneBasin(surface, basins)) {
    return "several minima of so many parameters explain the measurement, and only one is sampled";
  }
  // where the first round did, the posterior is what the linear models of the basins say
  const bool is_adapted = sampling.drawn.rounds > 1 && problem.drawn == surface.getDimensions();
  if (sampling.drawn.isReliable() && is_adapted &&
      endTooEarly(surface, sampling.drawn.draws, basins.front().local.misfit)) {
    return "the draws end where the measurement still fits";
  }
  return sampling.drawn.findObstacle();
}

std::vector<Index> listAll(const PosteriorProblem& problem) {
  std::vector<Index> all(problem.unknown.size());
  std::iota(all.begin(), all.end(), Index{0});
  return all;
}

/// Whether the response is nearer to linear in the parameters as they are than in their logarithms.
bool isStraighterPlain(const BasinSearch& found, ProblemSurface& whole, ProblemSurface& plain,
                       std::uint64_t seed) {
  const std::vector<Basin> basins = convertBasins(found.basins, whole.getCoordinates(), plain.upd());
  return calcNonlinearity(plain.upd(), basins.front(), seed) <
         calcNonlinearity(whole.upd(), found.basins.front(), seed);
}

/// As findRidgeShape() says; of many parameters the logarithms, or all as they are, whichever is straighter.
RidgeShape chooseShape(const PosteriorProblem& problem, const BasinSearch& found, ProblemSurface& whole,
                       std::uint64_t seed) {
  if (problem.drawn <= kManyUnknown) {
    return findRidgeShape(whole.upd(), found.basins.front());
  }
  ProblemSurface plain(problem, listAll(problem));
  RidgeShape shape;
  if (isStraighterPlain(found, whole, plain, seed)) {
    shape.plain = listAll(problem);
  }
  return shape;
}

/// In the logarithms but for what the shape says.
Sampling sampleBasins(const PosteriorProblem& problem, const BasinSearch& found, const RidgeShape& shape,
                      ProblemSurface& whole, const PosteriorDrawOptions& options) {
  std::unique_ptr<ProblemSurface> straight;
  Sampling sampling{shape.plain, {found.basins, {}, shape.is_straight}, {}, {}, 0};
  if (!shape.plain.empty()) {
    straight = std::make_unique<ProblemSurface>(problem, shape.plain);
    sampling.landscape.basins = convertBasins(found.basins, whole.getCoordinates(), straight->upd());
  }
  MisfitSurface& surface = straight ? straight->upd() : whole.upd();
  sampling.drawn = drawPosterior(surface, sampling.landscape, problem.drawn, options);
  sampling.obstacle = findObstacle(problem, surface, sampling);
  sampling.simulations = straight ? surface.getSimulations() : 0;
  return sampling;
}

/// What the basins on a ridge show to be identified (findRidges), with points of its floor where they are
/// few.
std::vector<Ridge> findRidgesOf(std::vector<Basin> basins, MisfitSurface& surface,
                                const std::vector<ParameterSpec>& unknown) {
  constexpr std::size_t kEnough = 6;
  if (basins.size() < kEnough) {
    std::vector<Basin> floors = followValleys(surface, basins).floors;
    std::move(floors.begin(), floors.end(), std::back_inserter(basins));
  }
  const LogCoordinates& coordinates = surface.getCoordinates();
  std::vector<MatrixXd> information;
  MatrixXd points(coordinates.getCount(), static_cast<Index>(basins.size()));
  for (std::size_t k = 0; k < basins.size(); ++k) {
    const LocalSurface& local = basins[k].local;
    const VectorXd per_width = 2.0 * coordinates.calcSlopes(local.at).cwiseInverse();
    information.emplace_back(per_width.asDiagonal() * local.information * per_width.asDiagonal());
    points.col(static_cast<Index>(k)) = coordinates.toParameters(local.at);
  }
  return findRidges(information, points, unknown);
}

/// With the sums that alone are determined in the place of parameters, if there are some; else not reliable.
Sampling sampleSums(const PosteriorProblem& problem, const BasinSearch& found, ProblemSurface& whole,
                    const PosteriorDrawOptions& options) {
  const std::vector<Ridge> ridges = findRidgesOf(found.basins, whole.upd(), problem.unknown);
  const SumCoordinates sums(problem.unknown, ridges);
  Sampling sampling;
  sampling.obstacle = "no sums are known";
  if (sums.isEmpty()) {
    return sampling;
  }
  sampling.plain = SumCoordinates::listReplaced(problem.unknown, ridges);
  ProblemSurface plain(problem, sampling.plain);
  MisfitSurface& surface = plain.upd();
  sampling.landscape.basins = convertBasins(found.basins, whole.getCoordinates(), surface);
  sampling.drawn = drawInSums(surface, sampling.landscape.basins, sums, options);
  sampling.obstacle = findObstacle(problem, surface, sampling);
  sampling.simulations = surface.getSimulations();
  return sampling;
}

/// In the parameters as they are.
Sampling sampleWalks(const PosteriorProblem& problem, const BasinSearch& found, const ProblemSurface& whole,
                     const PosteriorDrawOptions& options) {
  Sampling sampling;
  sampling.plain = listAll(problem);
  ProblemSurface plain(problem, sampling.plain);
  MisfitSurface& surface = plain.upd();
  sampling.landscape.basins = convertBasins(found.basins, whole.getCoordinates(), surface);
  sampling.drawn = drawAlongWalks(surface, sampling.landscape.basins, options);
  sampling.obstacle = findObstacle(problem, surface, sampling);
  sampling.simulations = surface.getSimulations();
  return sampling;
}

/// The straightest way first: along a bent ridge mixtures may find draws of a part of it good enough.
Sampling sample(const PosteriorProblem& problem, const BasinSearch& found, ProblemSurface& whole,
                const SimulatorPosteriorOptions& options) {
  const LocalSurface& best = found.basins.front().local;
  const bool is_spared = options.spares_misfit && !(best.chi_square < calcChiSquareLimit(best.degrees));
  const bool may_bend = !is_spared && problem.drawn == static_cast<Index>(problem.unknown.size()) &&
                        problem.drawn <= kManyUnknown;
  const RidgeShape shape = chooseShape(problem, found, whole, options.seed);
  int simulations = 0;
  if (may_bend && !shape.is_straight) {
    Sampling in_sums = sampleSums(problem, found, whole, options);
    if (in_sums.obstacle.empty()) {
      return in_sums;
    }
    simulations += in_sums.simulations;
  }
  Sampling sampling = sampleBasins(problem, found, shape, whole, options);
  sampling.simulations += simulations;
  if (!sampling.obstacle.empty() && may_bend) {
    Sampling walked = sampleWalks(problem, found, whole, options);
    walked.simulations += sampling.simulations;
    if (walked.obstacle.empty()) {
      return walked;
    }
    sampling.simulations = walked.simulations;
  }
  return sampling;
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
  posterior.modes = findModes(drawn.draws.points, posterior.draws, posterior.weights,
                              projectBasins(landscape.basins, coordinates.getCount()), landscape.valleys);
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
  const MatrixXd starts = addMedian(given, whole.getPrior(), surface.getDimensions(), problem.drawn);
  const BasinSearch found = findBasins(surface, toCoordinates(coordinates, starts), options.seed,
                                       limitSearch(options.search, problem.drawn));
  SimulatorPosterior posterior;
  posterior.starts = found.starts;
  posterior.simulations = surface.getSimulations();
  if (found.basins.empty()) {
    posterior.message = "every search failed at its first simulation";
    return posterior;
  }
  setBest(found, coordinates, posterior);
  if (problem.trials.size() == 1) {
    posterior.standardized = standardize(surface, problem.trials.front(), found.basins.front().local);
  }
  Sampling sampling = sample(problem, found, whole, options);
  posterior.simulations = surface.getSimulations() + sampling.simulations;
  posterior.effective_sample_size = sampling.drawn.effective_sample_size;
  posterior.pareto_shape = sampling.drawn.pareto_shape;
  posterior.message = sampling.obstacle;
  if (posterior.isReliable()) {
    const std::vector<ParameterSpec> kept(problem.unknown.begin(), problem.unknown.begin() + problem.drawn);
    setDraws(sampling.drawn, sampling.landscape, LogCoordinates(kept, sampling.plain), posterior);
    posterior.prior_stddev = whole.getPrior().calcStddevs().head(problem.drawn);
    if (options.profiles && problem.drawn == surface.getDimensions() && problem.drawn <= kManyUnknown) {
      setProfiles(problem, whole, posterior);
    }
  }
  return posterior;
}

SimulatorPosterior samplePosterior(Simulator& simulator, const RefinementModel& model,
                                   const std::vector<PriorGroupSpec>& priors, const VectorXd& features,
                                   const VectorXd& held, const MatrixXd& given,
                                   const SimulatorPosteriorOptions& options) {
  PosteriorProblem problem{model.getUnknown(), priors, {}, static_cast<Index>(model.getUnknown().size())};
  std::vector<Index> all(problem.unknown.size());
  std::iota(all.begin(), all.end(), Index{0});
  problem.trials.push_back({&simulator, &model, features, held, std::move(all)});
  return samplePosterior(problem, given, options);
}

double findLeastChiSquare(const PosteriorProblem& problem) {
  constexpr int kPoints = 32, kSearches = 3;
  ProblemSurface whole(problem);
  MisfitSurface& surface = whole.upd();
  const MatrixXd points = makeStarts(surface.getDimensions(), 1, kPoints);
  const VectorXd misfits = surface.calcMisfits(points);
  std::vector<Index> order(kPoints);
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    return std::isfinite(misfits[a]) && !(misfits[a] >= misfits[b]);
  });
  order.resize(kSearches);
  SearchTeam team(surface, points(Eigen::all, order));
  team.run(BasinSearchOptions{}.max_iterations);
  double least = std::numeric_limits<double>::infinity();
  for (const LocalSurface& end : team.listEnds()) {
    least = std::min(least, end.chi_square);
  }
  return least;
}

}  // namespace twinmap
