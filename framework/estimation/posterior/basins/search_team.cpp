#include "framework/estimation/posterior/basins/search_team.hpp"

#include <algorithm>
#include <cmath>

#include "framework/estimation/bounded_information.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/estimation/refined/acceptance.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

LinearModel getModel(const LocalSurface& local) {
  return {local.at, local.misfit, local.information, local.descent};
}

StepBounds makeBounds(Index dimensions, VectorXd held) {
  return {VectorXd::Constant(dimensions, -1.0), VectorXd::Ones(dimensions), std::move(held)};
}

/// Whether a search leaves a gross misfit for good.
bool creeps(const LocalSurface& local, double before) {
  return isGross(local.chi_square, local.degrees) && local.misfit > (1.0 - kCreeping) * before;
}

/// What a Gauss-Newton step would gain of chi-square if the linear model held.
double predictGain(const LocalSurface& local, const DampedSteps& steps) {
  return local.descent.dot(steps.calcNewtonStep(getModel(local)));
}

}  // namespace

SearchPace choosePace(Index dimensions) {
  return dimensions > kManyUnknown ? SearchPace{1.0, 4, true} : SearchPace{};
}

double calcGainLeft(const LocalSurface& local) {
  return predictGain(local, DampedSteps(makeBounds(local.at.size(), {})));
}

SearchTeam::SearchTeam(MisfitSurface& surface, const MatrixXd& starts, const MatrixXd& held)
    : surface_(surface), pace_(choosePace(surface.getDimensions())) {
  std::vector<LocalSurface> locals = surface.linearize(starts);
  for (std::size_t i = 0; i < locals.size(); ++i) {
    const bool simulated = locals[i].simulated;
    searches_.push_back(
        {std::move(locals[i]),
         DampedSteps(makeBounds(starts.rows(),
                                held.cols() > 0 ? VectorXd(held.col(static_cast<Index>(i))) : VectorXd())),
         simulated});
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
  const int first_judged = pace_.first_judged;
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
  std::vector<MatrixXd> tried;
  Index count = 0;
  for (const Search* search : active) {
    tried.push_back(search->steps.propose(getModel(search->local)));
    count += tried.back().cols();
  }
  MatrixXd trials(surface_.getDimensions(), count);
  Index column = 0;
  for (const MatrixXd& one : tried) {
    trials.middleCols(column, one.cols()) = one;
    column += one.cols();
  }
  const VectorXd reached = surface_.calcMisfits(trials);
  std::vector<Search*> moved;
  std::vector<Index> columns;
  column = 0;
  for (std::size_t i = 0; i < active.size(); ++i) {
    Search& search = *active[i];
    search.before = search.local.misfit;
    const auto best =
        search.steps.choose(getModel(search.local), tried[i], reached.segment(column, tried[i].cols()));
    if (best) {
      moved.push_back(&search);
      columns.push_back(column + *best);
    } else {
      search.active = !search.steps.areExhausted();
    }
    column += tried[i].cols();
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
    search.active = reached[i].simulated && predictGain(reached[i], search.steps) > pace_.converged &&
                    !creeps(reached[i], search.before);
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
  const VectorXd step = search.steps.calcNewtonStep(getModel(local));
  return {search.steps.take(getModel(local), step), local.misfit - local.descent.dot(step)};
}

/// Ends a search that has come into a known basin, both by its place and by its chi-square. A packet of lanes
/// costs as much for the last searches as for all of them. One that has converged elsewhere makes a basin
/// known.
void SearchTeam::settle(Search& search) {
  if (search.steps.getBounds().held.size() > 0) {
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
    known_.push_back({search.local, BoundedInformation(search.local.information).calcCovariance(), 1});
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
  const double near = least + std::max(kBasinAbove, least);
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
    search.active = search.active && (above < kBasinAbove || above < kSlow * (search.before - best->misfit));
  }
}

}  // namespace twinmap
