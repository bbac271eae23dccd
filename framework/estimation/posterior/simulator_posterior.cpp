#include "framework/estimation/posterior/simulator_posterior.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "framework/estimation/posterior/linear_posterior.hpp"
#include "framework/estimation/posterior/marginal_surface.hpp"
#include "framework/estimation/posterior/valley.hpp"
#include "framework/estimation/refined/acceptance.hpp"
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

/// Most draws as far from a basin's minimum as its linear model says, some twice and few four times as far,
/// and few anywhere.
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

/// Basin of each draw: the nearest in its own metric.
std::vector<std::size_t> assign(const MatrixXd& points, const std::vector<Basin>& basins) {
  std::vector<std::size_t> nearest(static_cast<std::size_t>(points.cols()), 0);
  VectorXd least = VectorXd::Constant(points.cols(), std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; basins.size() > 1 && k < basins.size(); ++k) {
    const MatrixXd lower = linalg::calcCholesky(basins[k].covariance).lower;
    const MatrixXd apart = linalg::solveLower(lower, points.colwise() - basins[k].local.at);
    for (Index i = 0; i < points.cols(); ++i) {
      if (const double distance = apart.col(i).squaredNorm(); distance < least[i]) {
        least[i] = distance;
        nearest[static_cast<std::size_t>(i)] = k;
      }
    }
  }
  return nearest;
}

/// The part of weighted draws that belongs to one group of basins.
importance::WeightedDraws takePart(const MatrixXd& points, const VectorXd& weights,
                                   const std::vector<std::size_t>& group_of_draw, std::size_t group) {
  VectorXd own = weights;
  for (Index i = 0; i < own.size(); ++i) {
    own[i] *= group_of_draw[static_cast<std::size_t>(i)] == group ? 1.0 : 0.0;
  }
  return {points, own};
}

/// Whether two parts of a distribution have a gap between them: seen along the line through their means,
/// these are more than twice the sum of the standard deviations apart. Two halves of a uniform distribution
/// are 1.7 times it apart, of a normal one 1.3 times.
bool areApart(const importance::WeightedDraws& a, const importance::WeightedDraws& b) {
  constexpr double kApart = 2.0;
  const auto normalize = [](const importance::WeightedDraws& part) {
    return importance::WeightedDraws{part.points, part.weights / part.weights.sum()};
  };
  const importance::WeightedDraws first = normalize(a), second = normalize(b);
  const VectorXd way = importance::calcMean(second) - importance::calcMean(first);
  const double length = way.norm();
  const auto spread = [&](const importance::WeightedDraws& part) {
    return std::sqrt(way.dot(importance::calcCovariance(part) * way)) / length;
  };
  return length > kApart * (spread(first) + spread(second));
}

/// The nearest basin of each draw, with those taken together that a valley connects or that have no gap
/// between them: they are a ridge, or one basin found twice.
std::vector<std::size_t> groupDraws(const MatrixXd& points, const VectorXd& weights,
                                    const std::vector<Basin>& basins, const Valleys& valleys) {
  std::vector<std::size_t> group_of_draw = assign(points, basins);
  const auto unite = [&](std::size_t kept, std::size_t other) {
    std::replace(group_of_draw.begin(), group_of_draw.end(), other, kept);
  };
  std::vector<std::size_t> group_of_basin(basins.size());
  std::iota(group_of_basin.begin(), group_of_basin.end(), std::size_t{0});
  for (const auto& [from, to] : valleys.connected) {
    const std::size_t kept = group_of_basin[from], other = group_of_basin[to];
    std::replace(group_of_basin.begin(), group_of_basin.end(), other, kept);
    if (kept != other) {
      unite(kept, other);
    }
  }
  for (std::size_t a = 0; a < basins.size(); ++a) {
    for (std::size_t b = a + 1; b < basins.size(); ++b) {
      const importance::WeightedDraws first = takePart(points, weights, group_of_draw, a),
                                      second = takePart(points, weights, group_of_draw, b);
      if (first.weights.sum() > 0.0 && second.weights.sum() > 0.0 && !areApart(first, second)) {
        unite(a, b);
        b = a;  // the group has grown: it may touch others now
      }
    }
  }
  return group_of_draw;
}

/// The groups' parts of the draws (in the parameters' units), the heaviest first; those of hardly any weight
/// are left out.
std::vector<PosteriorMode> collectModes(const std::vector<Basin>& basins,
                                        const std::vector<std::size_t>& group_of_draw, const MatrixXd& draws,
                                        const VectorXd& weights) {
  constexpr double kMinWeight = 1e-3;  // 1000 to 1 is certain
  std::vector<PosteriorMode> modes;
  for (std::size_t k = 0; k < basins.size(); ++k) {
    importance::WeightedDraws part = takePart(draws, weights, group_of_draw, k);
    const double weight = part.weights.sum();
    if (weight >= kMinWeight) {
      part.weights /= weight;
      const MatrixXd covariance = importance::calcCovariance(part);
      modes.push_back({weight, importance::calcMean(part), covariance.diagonal().cwiseSqrt(),
                       basins[k].local.chi_square, covariance});
    }
  }
  std::stable_sort(modes.begin(), modes.end(),
                   [](const PosteriorMode& a, const PosteriorMode& b) { return a.weight > b.weight; });
  return modes;
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

/// The misfits of all measurements, and the surface that they make.
class ProblemSurface {
 public:
  explicit ProblemSurface(const PosteriorProblem& problem)
      : coordinates_(problem.unknown),
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
      parts_.push_back(std::make_unique<Part>(trial));
      parts.push_back(
          {&parts_.back()->misfit, trial.model, trial.unknown, makeLosses(trial.noise, *trial.model)});
    }
    return parts;
  }

  const LogCoordinates coordinates_;
  const Prior prior_;
  std::vector<std::unique_ptr<Part>> parts_;
  MisfitSurface surface_;
};

void setBest(const BasinSearch& found, const LogCoordinates& coordinates, SimulatorPosterior& posterior) {
  const Basin& best = found.basins.front();
  posterior.best = coordinates.toParameters(best.local.at);
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
  MatrixXd jacobian(best.residual.size(), 0);
  if (!trial.noise.outputs.empty()) {
    const VectorXd box = surface.getCoordinates().toBox(best.at);
    jacobian = surface.getParts().front().misfit->linearize(box(trial.unknown)).jacobian;
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

AdaptiveDraws drawFrom(MisfitSurface& surface, const std::vector<Basin>& places,
                       const std::vector<Basin>& basins, const std::vector<Basin>& projected,
                       const SimulatorPosteriorOptions& options) {
  const Index drawn = projected.front().local.at.size();
  Numbers numbers(drawn, options);
  importance::AdaptiveOptions adaptive;
  adaptive.max_rounds = kMaxRounds;
  adaptive.enough = kEnough;
  std::vector<Index> kept(static_cast<std::size_t>(drawn));
  std::iota(kept.begin(), kept.end(), Index{0});
  std::optional<MarginalSurface> marginal;
  if (drawn < surface.getDimensions()) {
    marginal.emplace(surface, kept, basins);
  }
  return importance::sampleAdaptively(
      [&](const MatrixXd& points) {
        return marginal ? marginal->calcLogPosteriors(points) : surface.calcLogPosteriors(points);
      },
      proposeFirst(projected, calcShares(places, surface)),
      [&](int round) -> const RoundNumbers& { return numbers.get(round); }, adaptive);
}

/// Draws of the first `kept` coordinates: about the only basin of more than kFewUnknown as if the response
/// were linear, if that is good enough; else of all basins by mixtures, on the floors of valleys too.
AdaptiveDraws draw(MisfitSurface& surface, const std::vector<Basin>& basins, Index kept,
                   const SimulatorPosteriorOptions& options, Valleys& valleys) {
  const bool has_many = kept > kManyUnknown;
  if (has_many || (surface.getDimensions() > kFewUnknown && basins.size() == 1)) {
    AdaptiveDraws drawn = sampleLinearized(surface, basins.front(), options.draws, options.seed);
    const bool is_good = drawn.isReliable() && drawn.effective_sample_size >= kEnough * options.draws &&
                         drawn.pareto_shape <= importance::AdaptiveOptions().good_pareto_shape;
    if (has_many || is_good) {
      drawn.draws.points = MatrixXd(drawn.draws.points.topRows(kept));
      return drawn;
    }
  }
  valleys = followValleys(surface, basins);
  std::vector<Basin> places = basins;
  places.insert(places.end(), valleys.floors.begin(), valleys.floors.end());
  return drawFrom(surface, places, basins, projectBasins(places, kept), options);
}

/// Moments, draws and modes, of the first parameters, as many as `projected` has coordinates.
void setDraws(const AdaptiveDraws& drawn, const std::vector<Basin>& projected, const Valleys& valleys,
              const LogCoordinates& coordinates, SimulatorPosterior& posterior) {
  posterior.weights = drawn.draws.weights;
  posterior.draws = toParameters(coordinates, drawn.draws.points);
  const importance::WeightedDraws draws{posterior.draws, posterior.weights};
  posterior.mean = importance::calcMean(draws);
  posterior.covariance = importance::calcCovariance(draws);
  posterior.stddev = posterior.covariance.diagonal().cwiseSqrt();
  const std::vector<std::size_t> groups =
      groupDraws(drawn.draws.points, posterior.weights, projected, valleys);
  posterior.modes = collectModes(projected, groups, posterior.draws, posterior.weights);
}

}  // namespace

bool SimulatorPosterior::isExplained() const {
  return degrees > 0.0 && chi_square < calcChiSquareLimit(degrees);
}

PosteriorShape SimulatorPosterior::findShape(Index p) const {
  constexpr double kShare = 0.9;  // as trained estimators are judged
  if (modes.size() > 1) {
    return PosteriorShape::kMultimodal;
  }
  return (stddev.head(p).array() > kShare * prior_stddev.head(p).array()).any()
             ? PosteriorShape::kUninformative
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
    posterior.message = "no simulation within the bounds succeeded";
    return posterior;
  }
  setBest(found, coordinates, posterior);
  if (problem.trials.size() == 1) {
    posterior.standardized = standardize(surface, problem.trials.front(), found.basins.front().local);
  }
  Valleys valleys;
  const AdaptiveDraws drawn = draw(surface, found.basins, problem.drawn, options, valleys);
  posterior.simulations = surface.getSimulations();
  posterior.effective_sample_size = drawn.effective_sample_size;
  posterior.pareto_shape = drawn.pareto_shape;
  posterior.message = drawn.findObstacle();
  if (problem.drawn > kManyUnknown && found.basins.size() > 1) {
    posterior.message =
        "several minima of so many parameters explain the measurement, and only one is sampled";
  }
  if (posterior.isReliable()) {
    const std::vector<ParameterSpec> kept(problem.unknown.begin(), problem.unknown.begin() + problem.drawn);
    setDraws(drawn, projectBasins(found.basins, problem.drawn), valleys, LogCoordinates(kept), posterior);
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

double findLeastChiSquare(const PosteriorProblem& problem, int searches) {
  ProblemSurface whole(problem);
  BasinSearchOptions options;
  options.scouts = options.probes = searches;
  options.confirmations = searches + 1;  // neither probes nor batches follow
  options.max_batches = 0;
  const BasinSearch found = findBasins(whole.upd(), MatrixXd(whole.upd().getDimensions(), 0), 1, options);
  return found.basins.empty() ? std::numeric_limits<double>::infinity()
                              : found.basins.front().local.chi_square;
}

}  // namespace twinmap
