#include "framework/estimation/posterior/simulator_posterior.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "framework/estimation/informativeness.hpp"
#include "framework/estimation/posterior/bound_test.hpp"
#include "framework/estimation/posterior/linear_posterior.hpp"
#include "framework/estimation/posterior/marginal_surface.hpp"
#include "framework/estimation/posterior/search_team.hpp"
#include "framework/estimation/posterior/straight_ridge.hpp"
#include "framework/estimation/refined/acceptance.hpp"
#include "framework/estimation/segments/segmented_misfit.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"
#include "kernels/sampling/adaptive_importance.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using importance::AdaptiveDraws;
using importance::BoxMixture;
using importance::RoundNumbers;

namespace {

constexpr int kMaxRounds = 8;  // bent ridges take several until the mixture follows them
constexpr double kEnough =
    0.4;  // effective draws a draw of a round: with 200, quantiles at 2.5 % are as good as means
constexpr int kCenters = 24;  // parts about single draws, of a proposal

/// The numbers of the rounds, made when first asked for.
class Numbers {
 public:
  Numbers(Index dimensions, const SimulatorPosteriorOptions& options)
      : dimensions_(dimensions), draws_(options.draws), random_(options.seed, RandomPurpose::kPosterior) {}

  const RoundNumbers& get(int round) {
    while (static_cast<int>(rounds_.size()) <= round) {
      rounds_.push_back(make(static_cast<std::uint64_t>(rounds_.size())));
    }
    return rounds_[static_cast<std::size_t>(round)];
  }

 private:
  RoundNumbers make(std::uint64_t round) const {
    const auto uniform = [&](std::uint64_t channel) {
      return [this, channel, round](Index i) {
        return random_.calcUniform(static_cast<std::uint64_t>(i), channel, round);
      };
    };
    RoundNumbers numbers{VectorXd::NullaryExpr(draws_, uniform(0)), MatrixXd(dimensions_, draws_),
                         VectorXd::NullaryExpr(kCenters, uniform(1))};
    for (Index i = 0; i < draws_; ++i) {
      random_.drawNormals(static_cast<std::uint64_t>(i), round, numbers.normals.col(i).data(),
                          static_cast<std::size_t>(dimensions_));
    }
    return numbers;
  }

  const Index dimensions_, draws_;
  const RandomStream random_;
  std::vector<RoundNumbers> rounds_;
};

/// The shares of the basins by Laplace's approximation, half of all spread evenly: it is wrong where a basin
/// is not a paraboloid.
VectorXd calcShares(const std::vector<Basin>& basins, const MisfitSurface& surface) {
  const auto count = static_cast<Index>(basins.size());
  VectorXd logs(count);
  for (Index k = 0; k < count; ++k) {
    const Basin& basin = basins[static_cast<std::size_t>(k)];
    const MatrixXd lower = linalg::calcCholesky(basin.covariance).lower;
    logs[k] =
        -0.5 * basin.local.loss + lower.diagonal().array().log().sum() + surface.calcLogPrior(basin.local.at);
  }
  const VectorXd weights = (logs.array() - logs.maxCoeff()).exp();
  return (0.5 * weights / weights.sum()).array() + 0.5 / static_cast<double>(count);
}

/// Most draws as far from a basin's centre as its covariance says, some twice and few four times as far, and
/// few anywhere.
BoxMixture proposeFirst(const std::vector<Basin>& basins, const VectorXd& shares) {
  constexpr double kNear = 0.7, kFar = 0.2, kFarthest = 0.05;
  std::vector<importance::NormalPart> parts;
  for (std::size_t k = 0; k < basins.size(); ++k) {
    const double share = shares[static_cast<Index>(k)];
    const MatrixXd lower = linalg::calcCholesky(basins[k].covariance).lower;
    parts.push_back({kNear * share, basins[k].local.at, 1.1 * lower});
    parts.push_back({kFar * share, basins[k].local.at, 2.0 * lower});
    parts.push_back({kFarthest * share, basins[k].local.at, 4.0 * lower});
  }
  return BoxMixture(std::move(parts));
}

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

/// The basins as they are seen in the first `drawn` coordinates alone.
std::vector<Basin> projectBasins(std::vector<Basin> basins, Index drawn) {
  for (Basin& basin : basins) {
    basin.local.at = VectorXd(basin.local.at.head(drawn));
    basin.covariance = MatrixXd(basin.covariance.topLeftCorner(drawn, drawn));
  }
  return basins;
}

/// Basins and the valleys between them, in the coordinates in which they are sampled.
struct Landscape {
  std::vector<Basin> basins;
  Valleys valleys;
  bool is_straight = true;  // RidgeShape
};

/// Where the draws of the first round go: basins and floors of valleys, by the shares of their masses.
BoxMixture propose(const MisfitSurface& surface, const Landscape& landscape, Index drawn) {
  std::vector<Basin> places = landscape.basins;
  const std::vector<Basin>& floors = landscape.valleys.floors;
  places.insert(places.end(), floors.begin(), floors.end());
  const VectorXd shares = calcShares(places, surface);
  if (landscape.is_straight) {
    std::transform(landscape.basins.begin(), landscape.basins.end(), places.begin(), levelBasin);
  }
  return proposeFirst(projectBasins(std::move(places), drawn), shares);
}

AdaptiveDraws drawFrom(MisfitSurface& surface, const Landscape& landscape, Index drawn,
                       const SimulatorPosteriorOptions& options) {
  Numbers numbers(drawn, options);
  importance::AdaptiveOptions adaptive;
  adaptive.max_rounds = kMaxRounds;
  adaptive.enough = kEnough;
  std::vector<Index> kept(static_cast<std::size_t>(drawn));
  std::iota(kept.begin(), kept.end(), Index{0});
  std::optional<MarginalSurface> marginal;
  if (drawn < surface.getDimensions()) {
    marginal.emplace(surface, kept, landscape.basins);
  }
  return importance::sampleAdaptively(
      [&](const MatrixXd& points) {
        return marginal ? marginal->calcLogPosteriors(points) : surface.calcLogPosteriors(points);
      },
      propose(surface, landscape, drawn),
      [&](int round) -> const RoundNumbers& { return numbers.get(round); }, adaptive);
}

/// Draws of the first `kept` coordinates: about the only basin (areOneBasin) of more than kFewUnknown as if
/// the response were linear, if that is good enough; else of all basins by mixtures, on the floors of valleys
/// too, which are followed then.
AdaptiveDraws draw(MisfitSurface& surface, Landscape& landscape, Index kept,
                   const SimulatorPosteriorOptions& options) {
  const bool has_many = kept > kManyUnknown;
  if (has_many || (surface.getDimensions() > kFewUnknown && areOneBasin(surface, landscape.basins))) {
    AdaptiveDraws drawn = sampleLinearized(surface, landscape.basins.front(), options.draws, options.seed);
    const bool is_good = drawn.isReliable() && drawn.effective_sample_size >= kEnough * options.draws &&
                         drawn.pareto_shape <= importance::AdaptiveOptions().good_pareto_shape;
    if (has_many || is_good) {
      drawn.draws.points = MatrixXd(drawn.draws.points.topRows(kept));
      return drawn;
    }
  }
  landscape.valleys = followValleys(surface, landscape.basins);
  return drawFrom(surface, landscape, kept, options);
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
  const BasinSearch found =
      findBasins(surface, toCoordinates(coordinates, addMedian(given, whole.getPrior(), problem.drawn)),
                 options.seed, limitSearch(options.search, problem.drawn));
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
  const RidgeShape shape = findRidgeShape(surface, found.basins.front());
  Landscape landscape{found.basins, {}, shape.is_straight};
  std::unique_ptr<ProblemSurface> straight;
  if (!shape.plain.empty()) {
    straight = std::make_unique<ProblemSurface>(problem, shape.plain);
    landscape.basins = convertBasins(found.basins, coordinates, straight->upd());
  }
  MisfitSurface& sampled = straight ? straight->upd() : surface;
  const AdaptiveDraws drawn = draw(sampled, landscape, problem.drawn, options);
  posterior.simulations = surface.getSimulations() + (straight ? sampled.getSimulations() : 0);
  posterior.effective_sample_size = drawn.effective_sample_size;
  posterior.pareto_shape = drawn.pareto_shape;
  posterior.message = drawn.findObstacle();
  if (problem.drawn > kManyUnknown && !areOneBasin(sampled, landscape.basins)) {
    posterior.message =
        "several minima of so many parameters explain the measurement, and only one is sampled";
  }
  if (posterior.isReliable()) {
    const std::vector<ParameterSpec> kept(problem.unknown.begin(), problem.unknown.begin() + problem.drawn);
    setDraws(drawn, landscape, LogCoordinates(kept, shape.plain), posterior);
    posterior.prior_stddev = whole.getPrior().calcStddevs().head(problem.drawn);
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
