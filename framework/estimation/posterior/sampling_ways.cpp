#include "framework/estimation/posterior/sampling_ways.hpp"

#include <algorithm>
#include <memory>
#include <optional>

#include "framework/estimation/levels.hpp"
#include "framework/estimation/posterior/basins/straight_ridge.hpp"
#include "framework/estimation/posterior/basins/valley.hpp"
#include "framework/estimation/posterior/draws/followed_draws.hpp"
#include "framework/estimation/posterior/draws/linear_posterior.hpp"
#include "framework/estimation/posterior/posterior_modes.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

std::string findObstacle(const PosteriorProblem& problem, MisfitSurface& surface, const Sampling& sampling) {
  const std::vector<Basin>& basins = sampling.landscape.basins;
  if (problem.drawn > kManyUnknown && !areOneBasin(surface, basins)) {
    return "several minima of so many parameters explain the measurement, and only one is sampled";
  }
  if (problem.drawn > kManyUnknown && !hasArrived(basins.front())) {
    return "the searches ended on the way to a minimum";
  }
  return sampling.drawn.findObstacle();
}

/// The shape of the best basin, and its nonlinearity in these coordinates where that was compared.
struct ChosenShape : RidgeShape {
  std::optional<double> nonlinearity;
};

/// As findRidgeShape() says; of many parameters the logarithms, or all as they are, whichever make the
/// response nearer to linear.
ChosenShape chooseShape(const PosteriorProblem& problem, const BasinSearch& found, ProblemSurface& whole,
                        std::uint64_t seed) {
  if (problem.drawn <= kManyUnknown) {
    return {findRidgeShape(whole.upd(), found.basins.front()), {}};
  }
  ProblemSurface plain(problem, listIndices(problem.unknown.size()));
  const std::vector<Basin> basins = convertBasins(found.basins, whole.get(), plain.get());
  const double as_they_are = calcNonlinearity(plain.upd(), basins.front(), seed);
  const double in_logarithms = calcNonlinearity(whole.upd(), found.basins.front(), seed);
  ChosenShape shape;
  shape.nonlinearity = std::min(as_they_are, in_logarithms);
  if (as_they_are < in_logarithms) {
    shape.plain = listIndices(problem.unknown.size());
  }
  return shape;
}

/// Where the draws fall into several modes, looks whether valleys connect these: at the end of a ridge draws
/// are few, and seem to lie apart from the others.
void connectModes(MisfitSurface& surface, Sampling& sampling) {
  const importance::WeightedDraws& draws = sampling.drawn.draws;
  Landscape& landscape = sampling.landscape;
  if (surface.getDimensions() <= kManyUnknown && sampling.obstacle.empty() &&
      findModes(draws.points, draws.points, draws.weights,
                projectBasins(landscape.basins, draws.points.rows()), {})
              .size() > 1) {
    landscape.connected = findConnections(surface, landscape.basins);
  }
}

/// In the logarithms but for what the shape says.
Sampling sampleBasins(const PosteriorProblem& problem, const BasinSearch& found, const ChosenShape& shape,
                      ProblemSurface& whole, const PosteriorDrawOptions& options) {
  std::unique_ptr<ProblemSurface> straight;
  Sampling sampling{shape.plain, {found.basins, {}, shape.is_straight, shape.nonlinearity}, {}, {}, 0};
  if (!shape.plain.empty()) {
    straight = std::make_unique<ProblemSurface>(problem, shape.plain);
    sampling.landscape.basins = convertBasins(found.basins, whole.get(), straight->upd());
  }
  MisfitSurface& surface = straight ? straight->upd() : whole.upd();
  sampling.drawn = drawPosterior(surface, sampling.landscape, problem.drawn, options);
  sampling.obstacle = findObstacle(problem, surface, sampling);
  connectModes(surface, sampling);
  sampling.simulations = straight ? surface.getSimulations() : 0;
  return sampling;
}

/// What the basins on a ridge show to be identified (findRidges).
std::vector<Ridge> findRidgesOf(const std::vector<Basin>& basins, const LogCoordinates& coordinates,
                                const std::vector<ParameterSpec>& unknown) {
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
  const std::vector<Ridge> ridges = findRidgesOf(found.basins, whole.getCoordinates(), problem.unknown);
  const SumCoordinates sums(problem.unknown, ridges);
  Sampling sampling;
  sampling.obstacle = "no sums are known";
  if (sums.isEmpty()) {
    return sampling;
  }
  sampling.plain = SumCoordinates::listReplaced(problem.unknown, ridges);
  ProblemSurface plain(problem, sampling.plain);
  MisfitSurface& surface = plain.upd();
  sampling.landscape.basins = convertBasins(found.basins, whole.get(), surface);
  sampling.drawn = drawInSums(surface, sampling.landscape.basins, sums, options);
  sampling.obstacle = findObstacle(problem, surface, sampling);
  connectModes(surface, sampling);
  sampling.simulations = surface.getSimulations();
  return sampling;
}

/// Whether linear responses about eight of the draws put no mean elsewhere by more than half a standard
/// deviation: 95 % intervals of that parameter then hold .92.
bool isLinearFor(MisfitSurface& surface, const Basin& basin, const MatrixXd& draws) {
  constexpr Index kChecked = 8;  // the root mean square is then known to a quarter
  const Index count = std::min(kChecked, draws.cols());
  MatrixXd points(draws.rows(), count);
  for (Index i = 0; i < count; ++i) {
    points.col(i) = draws.col(i * draws.cols() / count);  // of a chain, far apart
  }
  return calcDisplacements(surface, basin, points).maxCoeff() <= kNoticeable;
}

/// In the parameters as they are, by `draw` of a surface and the basins there.
template <class Draw>
Sampling samplePlain(const PosteriorProblem& problem, const BasinSearch& found, const ProblemSurface& whole,
                     const Draw& draw) {
  Sampling sampling;
  sampling.plain = listIndices(problem.unknown.size());
  ProblemSurface plain(problem, sampling.plain);
  MisfitSurface& surface = plain.upd();
  sampling.landscape.basins = convertBasins(found.basins, whole.get(), surface);
  sampling.drawn = draw(surface, sampling.landscape.basins);
  sampling.obstacle = findObstacle(problem, surface, sampling);
  sampling.drawn.draws.points = MatrixXd(sampling.drawn.draws.points.topRows(problem.drawn));
  connectModes(surface, sampling);
  sampling.simulations = surface.getSimulations();
  return sampling;
}

/// Of many, where no weights make the draws those of the posterior.
Sampling sampleFollowed(const PosteriorProblem& problem, const BasinSearch& found,
                        const ProblemSurface& whole, const PosteriorDrawOptions& options) {
  return samplePlain(problem, found, whole, [&](MisfitSurface& surface, const std::vector<Basin>& basins) {
    return drawFollowed(surface, basins.front(), options.draws, options.seed);
  });
}

Sampling sampleWalks(const PosteriorProblem& problem, const BasinSearch& found, const ProblemSurface& whole,
                     const PosteriorDrawOptions& options) {
  return samplePlain(problem, found, whole, [&](MisfitSurface& surface, const std::vector<Basin>& basins) {
    return drawAlongWalks(surface, basins, options);
  });
}

}  // namespace

std::optional<Sampling> sampleLinearModel(const PosteriorProblem& problem, const BasinSearch& found,
                                          ProblemSurface& whole, bool is_explained,
                                          const PosteriorDrawOptions& options) {
  MisfitSurface& surface = whole.upd();
  Sampling sampling{{}, {found.basins, {}, false, {}}, {}, {}, 0};
  sampling.drawn = drawLinear(surface, found.basins.front(), options.draws, options.seed);
  if (is_explained && !isLinearFor(surface, found.basins.front(), sampling.drawn.draws.points)) {
    return {};
  }
  sampling.drawn.draws.points = MatrixXd(sampling.drawn.draws.points.topRows(problem.drawn));
  sampling.obstacle = findObstacle(problem, surface, sampling);
  return sampling;
}

bool mayBend(const PosteriorProblem& problem) {
  return problem.drawn == static_cast<Index>(problem.unknown.size()) && problem.drawn <= kManyUnknown;
}

Sampling samplePosterior(const PosteriorProblem& problem, const BasinSearch& found, ProblemSurface& whole,
                         const PosteriorDrawOptions& options) {
  const bool may_bend = mayBend(problem);
  constexpr double kHopeless = 1e4;  // 6e10 with the 129 parameters of an arm of seven joints
  const ChosenShape shape = chooseShape(problem, found, whole, options.seed);
  int simulations = 0;
  if (may_bend && !shape.is_straight) {
    Sampling in_sums = sampleSums(problem, found, whole, options);
    if (in_sums.obstacle.empty()) {
      return in_sums;
    }
    simulations += in_sums.simulations;
  }
  if (shape.nonlinearity.value_or(0.0) > kHopeless) {
    return sampleFollowed(problem, found, whole, options);
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
  if (!sampling.obstacle.empty() && problem.drawn > kManyUnknown) {
    Sampling followed = sampleFollowed(problem, found, whole, options);
    followed.simulations += sampling.simulations;
    if (followed.obstacle.empty()) {
      return followed;
    }
    sampling.simulations = followed.simulations;
  }
  return sampling;
}

}  // namespace twinmap
