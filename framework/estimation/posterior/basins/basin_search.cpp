#include "framework/estimation/posterior/basins/basin_search.hpp"

#include <algorithm>
#include <cmath>

#include "framework/estimation/levels.hpp"
#include "framework/estimation/posterior/basins/search_team.hpp"
#include "framework/estimation/refined/acceptance.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/point_set.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Batches after which such a misfit's best fit is what was found.
constexpr int kBatchesOfMisfit = 2;

bool isExplained(const LocalSurface& local) {
  return local.chi_square < calcChiSquareLimit(local.degrees);
}

bool isExplained(const std::vector<Basin>& basins) {
  return !basins.empty() && isExplained(basins.front().local);
}

/// Whether even the best of some ends leaves what no noise is taken for.
bool areGross(const std::vector<LocalSurface>& ends) {
  return std::all_of(ends.begin(), ends.end(),
                     [](const LocalSurface& end) { return isGross(end.chi_square, end.degrees); });
}

/// The quarter of the least misfits.
void keepLeast(std::vector<LocalSurface>& ends) {
  std::stable_sort(ends.begin(), ends.end(),
                   [](const LocalSurface& a, const LocalSurface& b) { return a.misfit < b.misfit; });
  ends.resize((ends.size() + 3) / 4);
}

struct GrownSearch {
  std::vector<LocalSurface> ends;
  bool explains_beginning = true;  ///< whether, of each window before the whole, any search did
};

/// The ends of searches of more and more of the response, each from where the last one ended. A chaotic
/// response has many minima. Its beginning has few, which lie where the next ones do. What no search explains
/// of a window, none will of the next: the quarter of the least misfits goes on. It does so in the whole at
/// once where even that is gross.
GrownSearch searchGrowing(MisfitSurface& surface, MatrixXd starts, int max_iterations) {
  GrownSearch grown;
  const auto search = [&](std::size_t window, int iterations) {
    surface.setWindow(window);
    SearchTeam team(surface, starts);
    team.run(iterations);
    return team.listEnds();
  };
  const std::size_t last = surface.countWindows() - 1;
  bool is_gross = false;
  for (std::size_t i = 0; i < last && starts.cols() > 0 && !is_gross; ++i) {
    std::vector<LocalSurface> ends = search(i, kFewIterations);
    is_gross = areGross(ends);
    if (std::none_of(ends.begin(), ends.end(), [](const LocalSurface& end) { return isExplained(end); })) {
      grown.explains_beginning = false;
      keepLeast(ends);
    }
    starts.resize(Eigen::NoChange, static_cast<Index>(ends.size()));
    for (std::size_t k = 0; k < ends.size(); ++k) {
      starts.col(static_cast<Index>(k)) = ends[k].at;
    }
  }
  surface.setWindow(last);
  if (starts.cols() > 0) {
    grown.ends = search(last, max_iterations);
  }
  return grown;
}

/// The basin that is nearest to a point.
const Basin& findNearest(const std::vector<Basin>& basins, const VectorXd& at) {
  return *std::min_element(basins.begin(), basins.end(), [&](const Basin& a, const Basin& b) {
    return (a.local.at - at).squaredNorm() < (b.local.at - at).squaredNorm();
  });
}

/// Chi-square on the way from the nearest basin to each point (u x n), which ends it. A search from a point
/// to which it rises all the way would most likely end in that basin. Returns where it falls again, the
/// lowest of these places first, but for what noise could be.
MatrixXd findFalls(MisfitSurface& surface, const std::vector<Basin>& basins, const MatrixXd& points) {
  MatrixXd ways(points.rows(), kWayPoints * points.cols());
  for (Index i = 0; i < points.cols(); ++i) {
    const VectorXd& from = findNearest(basins, points.col(i)).local.at;
    for (Index k = 0; k < kWayPoints; ++k) {
      const double share = static_cast<double>(k + 1) / static_cast<double>(kWayPoints);
      ways.col(i * kWayPoints + k) = from + share * (points.col(i) - from);
    }
  }
  const VectorXd reached = surface.calcMisfits(ways);
  std::vector<Index> falls;
  for (Index i = 0; i < points.cols(); ++i) {
    double before = findNearest(basins, points.col(i)).local.misfit;
    Index lowest = -1;
    for (Index k = i * kWayPoints; k < (i + 1) * kWayPoints; ++k) {
      if (std::isfinite(reached[k]) && reached[k] < before - kBarrier) {
        lowest = lowest < 0 || reached[k] < reached[lowest] ? k : lowest;
      }
      before = reached[k];
    }
    if (lowest >= 0) {
      falls.push_back(lowest);
    }
  }
  std::stable_sort(falls.begin(), falls.end(), [&](Index a, Index b) { return reached[a] < reached[b]; });
  return ways(Eigen::all, falls);
}

/// Of many parameters, the best basin and those others that are minima. Searches of so many end early
/// (choosePace), and creep along bent valleys: where they are given up looks like minima beside the one to
/// which the valley leads, or is taken for it. A few iterations more reach a minimum that is near; what does
/// not arrive is none.
std::vector<Basin> keepMinima(MisfitSurface& surface, std::vector<Basin> basins, int max_iterations) {
  const bool arrived = !basins.empty() && hasArrived(basins.front());
  const Index first = arrived ? 1 : 0, count = static_cast<Index>(basins.size()) - first;
  if (surface.getDimensions() <= kManyUnknown || count <= 0) {
    return basins;
  }
  MatrixXd starts(surface.getDimensions(), count);
  for (Index k = 0; k < count; ++k) {
    starts.col(k) = basins[static_cast<std::size_t>(first + k)].local.at;
  }
  const int iterations = arrived ? kFewIterations : max_iterations;
  SearchTeam team(surface, starts);
  if (arrived) {
    team.setKnown({basins.front()});
  }
  team.setPace({SearchPace().converged, iterations, true});
  team.run(iterations);
  std::vector<LocalSurface> ends{basins.front().local};
  for (LocalSurface& end : team.listEnds()) {
    if (end.misfit < ends.front().misfit) {
      std::swap(end, ends.front());
    }
    if (calcGainLeft(end) <= SearchPace().converged) {
      ends.push_back(std::move(end));
    }
  }
  const int searches = basins.front().searches;
  basins = collectBasins(std::move(ends));
  basins.front().searches += searches - 1;
  return basins;
}

/// Ends of searches and the starts that are left.
class BasinHunt {
 public:
  BasinHunt(MisfitSurface& surface, MatrixXd starts, const BasinSearchOptions& options)
      : surface_(surface), starts_(std::move(starts)), options_(options) {}

  const BasinSearch& getFound() const { return found_; }
  bool isExplained() const { return twinmap::isExplained(found_.basins); }
  bool isConfirmed() const {
    return !found_.basins.empty() && found_.basins.front().searches >= options_.confirmations;
  }

  /// What the best basin leaves is so much that no noise is taken for it, or none explains even the
  /// beginning: no basin that is hard to find would.
  bool isHopeless() const {
    const LocalSurface& best = found_.basins.front().local;
    return isGross(best.chi_square, best.degrees) || !explains_beginning_;
  }

  /// Whether enough searches end in the best basin, which is as wide as if the noise were as large as the
  /// residual.
  bool isSettled() const {
    if (found_.basins.empty()) {
      return false;
    }
    const Basin& best = found_.basins.front();
    const double scale = std::max(1.0, best.local.chi_square / best.local.degrees);
    const auto count = std::count_if(ends_.begin(), ends_.end(), [&](const LocalSurface& end) {
      return end.misfit < best.local.misfit + scale * kBasinAbove &&
             calcDistance(best, end.at) < kBasinReach * std::sqrt(scale);
    });
    return count >= options_.confirmations;
  }

  /// The next starts, at most so many.
  MatrixXd takeStarts(int count) {
    const Index most = std::min<Index>(count, starts_.cols() - taken_);
    taken_ += most;
    return starts_.middleCols(taken_ - most, most);
  }
  int countTaken() const { return static_cast<int>(taken_); }

  void search(const MatrixXd& starts) {
    SearchTeam team(surface_, starts);
    team.setKnown(found_.basins);
    team.run(options_.max_iterations);
    add(team.listEnds());
    found_.starts += static_cast<int>(starts.cols());
  }

  void searchWindows(const MatrixXd& starts) {
    GrownSearch grown = searchGrowing(surface_, starts, options_.max_iterations);
    explains_beginning_ = explains_beginning_ && grown.explains_beginning;
    add(std::move(grown.ends));
    found_.starts += static_cast<int>(starts.cols());
  }

  /// Instead of searches from the next starts, where chi-square rises towards them all the way.
  void probe() {
    const MatrixXd starts = takeStarts(options_.probes);
    const MatrixXd falls = findFalls(surface_, found_.basins, starts);
    if (falls.cols() > 0) {
      search(falls.leftCols(std::min<Index>(falls.cols(), options_.starts)));
    }
  }

 private:
  void add(std::vector<LocalSurface> ends) {
    ends_.insert(ends_.end(), std::make_move_iterator(ends.begin()), std::make_move_iterator(ends.end()));
    found_.basins = collectBasins(ends_);
  }

  MisfitSurface& surface_;
  const MatrixXd starts_;
  const BasinSearchOptions options_;
  Index taken_ = 0;
  bool explains_beginning_ = true;
  std::vector<LocalSurface> ends_;
  BasinSearch found_;
};

/// All of findBasins() but for what keepMinima() says.
BasinSearch findEnds(MisfitSurface& surface, const MatrixXd& given, std::uint64_t seed,
                     const BasinSearchOptions& options) {
  const int most = options.starts * options.max_batches + options.probes;
  const MatrixXd starts = makeStarts(surface.getDimensions(), seed, most);
  BasinHunt hunt(surface, options.from_prior ? surface.spreadAsPrior(starts) : starts, options);
  MatrixXd scouts(surface.getDimensions(), options.scouts + given.cols());
  scouts.leftCols(options.scouts) = hunt.takeStarts(options.scouts);
  if (given.cols() > 0) {  // else it may have no rows either
    scouts.rightCols(given.cols()) = given;
  }
  hunt.search(scouts);
  while (hunt.isExplained() && !hunt.isConfirmed() && hunt.countTaken() < options.starts) {
    hunt.search(hunt.takeStarts(std::clamp(options.scouts, 1, options.starts - hunt.countTaken())));
  }
  if (hunt.isExplained() && hunt.isConfirmed()) {
    hunt.probe();
    if (hunt.isConfirmed()) {
      return hunt.getFound();
    }
  }
  if (options.settles && !hunt.isExplained() && hunt.isSettled()) {
    return hunt.getFound();
  }
  MatrixXd again = hunt.countTaken() == options.scouts ? scouts : MatrixXd(scouts.rows(), 0);
  for (int batch = 0; batch < options.max_batches; ++batch) {
    const MatrixXd next =
        hunt.takeStarts(again.cols() > 0 ? options.starts - options.scouts : options.starts);
    hunt.search(next);
    if (!hunt.isExplained() && surface.countWindows() > 1) {
      MatrixXd all(next.rows(), next.cols() + again.cols());
      all << next, again;
      hunt.searchWindows(all);
    }
    again.resize(Eigen::NoChange, 0);
    if (hunt.getFound().basins.empty() || hunt.isConfirmed()) {
      break;
    }
    if ((options.settles || hunt.isHopeless()) && (hunt.isSettled() || batch + 1 >= kBatchesOfMisfit)) {
      break;
    }
  }
  return hunt.getFound();
}

}  // namespace

MatrixXd makeStarts(Index dimensions, std::uint64_t seed, int count) {
  PointSetSpec sobol;
  sobol.method = DesignMethod::kSobol;
  sobol.samples = count;
  const MatrixXd unit =
      sampleUnitCube(sobol, static_cast<int>(dimensions), seed, RandomPurpose::kBasinStarts);
  return 2.0 * unit.array() - 1.0;
}

bool hasArrived(const Basin& basin) {
  const LocalSurface& local = basin.local;
  const double scale = std::max(1.0, local.chi_square / local.degrees);  // as if noise were the residual
  return calcGainLeft(local) <= scale * choosePace(local.at.size()).converged;
}

BasinSearch findBasins(MisfitSurface& surface, const MatrixXd& given, std::uint64_t seed,
                       const BasinSearchOptions& options) {
  BasinSearch found = findEnds(surface, given, seed, options);
  found.basins = keepMinima(surface, std::move(found.basins), options.max_iterations);
  return found;
}

}  // namespace twinmap
