#include "framework/estimation/posterior/basins/search_team.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/estimation/refined/acceptance.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// From nearly a Gauss-Newton step to a short one: one of them fits wherever the linear model holds at all.
constexpr double kDampings[] = {0.01, 1.0, 30.0};
constexpr double kFirstDamping = 1e-2, kMinDamping = 1e-9, kMaxDamping = 1e8, kRaise = 100.0;
constexpr double kHeldLinear = 0.75;      // of the gain that the linear model says
constexpr double kLongestStep = 0.5;      // half of a coordinate's bounds
constexpr double kFirstDiagonal = 1e-12;  // of the largest: what the response does not depend on stays
constexpr double kFarAbove = 50.0;        // of the best chi-square: e^-25 of its density

/// The coordinates that a step may move: those at a bound whose descent points outwards are held.
std::vector<Index> findFree(const LocalSurface& local) {
  std::vector<Index> free;
  for (Index j = 0; j < local.at.size(); ++j) {
    if (!(std::abs(local.at[j]) >= 1.0 && local.at[j] * local.descent[j] > 0.0)) {
      free.push_back(j);
    }
  }
  return free;
}

/// What a step of the free coordinates may be made of (f x k): all of them, or what is at right angles to the
/// direction that is held.
MatrixXd makeBasis(const VectorXd& held, const std::vector<Index>& free) {
  const auto count = static_cast<Index>(free.size());
  Index largest = 0;
  if (held.size() == 0 || !(held(free).cwiseAbs().maxCoeff(&largest) > 0.0)) {
    return MatrixXd::Identity(count, count);
  }
  MatrixXd basis = MatrixXd::Zero(count, count - 1);
  for (Index i = 0, k = 0; i < count; ++i) {
    if (i != largest) {
      basis(i, k) = 1.0;
      basis(largest, k++) =
          -held[free[static_cast<std::size_t>(i)]] / held[free[static_cast<std::size_t>(largest)]];
    }
  }
  return basis;
}

/// (I + damping diag(I)) step = descent for the free coordinates, what has been stepped of the others given.
VectorXd solveFree(const LocalSurface& local, const VectorXd& held, double damping,
                   const std::vector<Index>& free, const VectorXd& stepped) {
  VectorXd step = stepped;
  const MatrixXd basis = makeBasis(held, free);
  if (basis.cols() == 0) {
    return step;
  }
  const VectorXd descent = local.descent - local.information * stepped;
  MatrixXd damped = basis.transpose() * local.information(free, free) * basis;
  const double floor = kFirstDiagonal * damped.diagonal().maxCoeff() + std::numeric_limits<double>::min();
  damped.diagonal() = (1.0 + damping) * damped.diagonal().array() + floor;
  step(free) = basis * linalg::solvePositiveDefinite(damped, basis.transpose() * descent(free));
  return step;
}

/// The step of Levenberg and Marquardt within the bounds: coordinates that it would take beyond them end
/// there, and the others are solved for again, as those make up for these no longer.
VectorXd calcStep(const LocalSurface& local, const VectorXd& held, double damping) {
  std::vector<Index> free = findFree(local);
  VectorXd step = VectorXd::Zero(local.at.size());
  while (!free.empty()) {
    const VectorXd all = solveFree(local, held, damping, free, step);
    const auto leaves = [&](Index j) { return std::abs(local.at[j] + all[j]) > 1.0; };
    const auto left = std::stable_partition(free.begin(), free.end(), [&](Index j) { return !leaves(j); });
    if (left == free.end() || held.size() > 0) {
      return all;
    }
    std::for_each(left, free.end(), [&](Index j) { step[j] = std::copysign(1.0, all[j]) - local.at[j]; });
    free.erase(left, free.end());
  }
  return step;
}

/// What a Gauss-Newton step would gain of chi-square if the linear model held.
double predictGain(const LocalSurface& local, const VectorXd& held) {
  return local.descent.dot(calcStep(local, held, kMinDamping));
}

VectorXd take(const LocalSurface& local, const VectorXd& step) {
  const double length = step.cwiseAbs().maxCoeff();
  const double scale = length > kLongestStep ? kLongestStep / length : 1.0;
  return (local.at + scale * step).cwiseMax(-1.0).cwiseMin(1.0);
}

/// What a step gains of chi-square if the linear model holds.
double calcLinearGain(const LocalSurface& local, const VectorXd& step) {
  return 2.0 * step.dot(local.descent) - step.dot(local.information * step);
}

}  // namespace

SearchPace choosePace(Index dimensions) {
  return dimensions > kManyUnknown ? SearchPace{1.0, 4, true} : SearchPace{};
}

double calcGainLeft(const LocalSurface& local) {
  return predictGain(local, {});
}

SearchTeam::SearchTeam(MisfitSurface& surface, const MatrixXd& starts, const MatrixXd& held)
    : surface_(surface), pace_(choosePace(surface.getDimensions())) {
  std::vector<LocalSurface> locals = surface.linearize(starts);
  for (std::size_t i = 0; i < locals.size(); ++i) {
    const bool simulated = locals[i].simulated;
    searches_.push_back({std::move(locals[i]),
                         held.cols() > 0 ? VectorXd(held.col(static_cast<Index>(i))) : VectorXd(),
                         kFirstDamping, simulated});
  }
}

/// How many searches have ended, and the best of them.
void SearchTeam::showProgress(SearchStage& stage) const {
  const auto ended =
      std::count_if(searches_.begin(), searches_.end(), [](const Search& search) { return !search.active; });
  stage.show(static_cast<int>(ended), static_cast<int>(searches_.size()));
  const LocalSurface* best = surface_.seesAll() ? findBest() : nullptr;
  if (best != nullptr) {
    const VectorXd values = surface_.getCoordinates().toParameters(best->at);
    noteBest(best->chi_square, best->degrees, {values.begin(), values.end()});
  }
}

void SearchTeam::run(int max_iterations) {
  SearchStage stage("searches that have ended", static_cast<int>(searches_.size()));
  constexpr int kJudgedAgainstKnown = 3;  // what must be better than a known basin, sooner
  const int first_judged = known_.empty() ? pace_.first_judged : kJudgedAgainstKnown;
  for (int i = 1; i <= max_iterations && improve(); ++i) {
    showProgress(stage);
    if (i == first_judged || i == 2 * first_judged) {
      giveUpHopeless();
    }
    if (i >= first_judged) {
      giveUpSlow();
    }
  }
}

std::vector<LocalSurface> SearchTeam::listEnds() const {
  std::vector<LocalSurface> ends;
  for (const Search& search : searches_) {
    if (search.local.simulated) {
      ends.push_back(search.local);
    }
  }
  return ends;
}

std::vector<SearchTeam::Search*> SearchTeam::listActive() {
  std::vector<Search*> active;
  for (Search& search : searches_) {
    if (search.active) {
      active.push_back(&search);
    }
  }
  return active;
}

/// One iteration of all that have not converged; false if there are none.
bool SearchTeam::improve() {
  const std::vector<Search*> active = listActive();
  if (active.empty()) {
    return false;
  }
  Index count = 0;
  for (Search* search : active) {
    search->factors.assign(std::begin(kDampings),
                           search->linear ? std::begin(kDampings) + 1 : std::end(kDampings));
    count += static_cast<Index>(search->factors.size());
  }
  MatrixXd trials(surface_.getDimensions(), count);
  Index column = 0;
  for (const Search* search : active) {
    for (const double factor : search->factors) {
      trials.col(column++) =
          take(search->local, calcStep(search->local, search->held, search->damping * factor));
    }
  }
  const VectorXd reached = surface_.calcMisfits(trials);
  std::vector<Search*> moved;
  std::vector<Index> columns;
  column = 0;
  for (Search* search : active) {
    const auto tried = static_cast<Index>(search->factors.size());
    Index best = 0;
    const double least = reached.segment(column, tried).minCoeff(&best);
    search->before = search->local.misfit;
    if (least < search->local.misfit) {
      const double expected = calcLinearGain(search->local, trials.col(column + best) - search->local.at);
      search->linear = best == 0 && search->local.misfit - least > kHeldLinear * expected;
      search->damping = std::max(search->damping * kDampings[best], kMinDamping);
      moved.push_back(search);
      columns.push_back(column + best);
    } else {
      search->damping *= search->linear ? 1.0 : kRaise;
      search->linear = false;
      search->active = search->damping < kMaxDamping;
    }
    column += tried;
  }
  move(moved, trials(Eigen::all, columns));
  return true;
}

void SearchTeam::move(const std::vector<Search*>& moved, const MatrixXd& to) {
  if (moved.empty()) {
    return;
  }
  std::vector<LocalSurface> reached = surface_.linearize(to);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    Search& search = *moved[i];
    search.active = reached[i].simulated && predictGain(reached[i], search.held) > pace_.converged;
    if (reached[i].simulated) {
      search.local = std::move(reached[i]);
      settle(search);
    }
  }
  if (pace_.leads) {  // into what others of these have found as well
    std::for_each(moved.begin(), moved.end(), [this](Search* search) {
      if (search->active) {
        settle(*search);
      }
    });
  }
}

/// Where a search is, or where its linear model leads (SearchPace::leads).
SearchTeam::Place SearchTeam::findPlace(const Search& search) const {
  const LocalSurface& local = search.local;
  if (!pace_.leads) {
    return {local.at, local.misfit};
  }
  const VectorXd step = calcStep(local, search.held, kMinDamping);
  return {take(local, step), local.misfit - local.descent.dot(step)};
}

/// Ends a search that has come into a known basin, both by its place and by its chi-square. A packet of lanes
/// costs as much for the last searches as for all of them. One that has converged elsewhere makes a basin
/// known.
void SearchTeam::settle(Search& search) {
  if (search.held.size() > 0) {
    return;
  }
  const Place place = findPlace(search);
  const auto own = std::find_if(known_.begin(), known_.end(), [&](const Basin& basin) {
    return search.local.misfit >= basin.local.misfit &&
           place.misfit < basin.local.misfit + kBasinReach * kBasinReach && liesIn(basin, place.at);
  });
  if (own != known_.end()) {
    search.local = own->local;
    search.active = false;
  } else if (!search.active) {
    known_.push_back({search.local, calcBasinCovariance(search.local.information), 1});
  }
}

/// Of all searches and known basins; null where nothing was simulated.
const LocalSurface* SearchTeam::findBest() const {
  const LocalSurface* best = nullptr;
  const auto compare = [&best](const LocalSurface& local) {
    if (local.simulated && (best == nullptr || local.misfit < best->misfit)) {
      best = &local;
    }
  };
  for (const Search& search : searches_) {
    compare(search.local);
  }
  for (const Basin& basin : known_) {
    compare(basin.local);
  }
  return best;
}

/// Searches far above the best one; a quarter of all is kept whatever it is.
void SearchTeam::giveUpHopeless() {
  constexpr double kOfBest = 0.5;
  std::vector<double> reached;
  for (const Search& search : searches_) {
    if (search.local.simulated) {
      reached.push_back(search.local.misfit);
    }
  }
  if (reached.empty()) {
    return;
  }
  std::sort(reached.begin(), reached.end());
  const double least = findBest()->misfit;
  const double near = least + std::max(kFarAbove, kOfBest * least);
  const double limit = std::max(near, reached[reached.size() / 4]);
  for (Search& search : searches_) {
    search.active = search.active && search.local.misfit <= limit;
  }
}

/// Where noise explains the best: searches far above it that an iteration brought less than half the way.
void SearchTeam::giveUpSlow() {
  constexpr double kSlow = 0.5;
  const LocalSurface* best = findBest();
  if (best == nullptr || !(best->chi_square < calcChiSquareLimit(best->degrees))) {
    return;
  }
  for (Search& search : searches_) {
    const double above = search.local.misfit - best->misfit;
    search.active = search.active && (above < kFarAbove || above < kSlow * (search.before - best->misfit));
  }
}

}  // namespace twinmap
