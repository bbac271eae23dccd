#include "framework/estimation/posterior/basin_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "framework/estimation/refined/acceptance.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/experiment/points/point_set.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// From nearly a Gauss-Newton step to a short one: one of them fits wherever the linear model holds at all.
constexpr std::array<double, 3> kDampings{0.01, 1.0, 30.0};
constexpr double kFirstDamping = 1e-2, kMinDamping = 1e-9, kMaxDamping = 1e8, kRaise = 100.0;
constexpr double kLongestStep = 0.5;      // half of a coordinate's bounds
constexpr double kConvergedGain = 0.01;   // of chi-square: a tenth of a standard deviation
constexpr double kFirstDiagonal = 1e-12;  // of the largest: what the response does not depend on stays

struct Search {
  LocalSurface local;
  double damping = kFirstDamping;
  bool active = true;
};

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

/// (I + damping diag(I)) step = descent for the free coordinates; the others stay.
VectorXd calcStep(const LocalSurface& local, double damping) {
  const std::vector<Index> free = findFree(local);
  VectorXd step = VectorXd::Zero(local.at.size());
  if (free.empty()) {
    return step;
  }
  MatrixXd damped = local.information(free, free);
  const double floor = kFirstDiagonal * damped.diagonal().maxCoeff() + std::numeric_limits<double>::min();
  damped.diagonal() = (1.0 + damping) * damped.diagonal().array() + floor;
  step(free) = linalg::solvePositiveDefinite(damped, local.descent(free));
  return step;
}

/// What a Gauss-Newton step would gain of chi-square if the linear model held.
double predictGain(const LocalSurface& local) {
  return local.descent.dot(calcStep(local, kMinDamping));
}

VectorXd take(const LocalSurface& local, const VectorXd& step) {
  const double length = step.cwiseAbs().maxCoeff();
  const double scale = length > kLongestStep ? kLongestStep / length : 1.0;
  return (local.at + scale * step).cwiseMax(-1.0).cwiseMin(1.0);
}

/// Searches that go side by side.
class SearchTeam {
 public:
  SearchTeam(MisfitSurface& surface, const MatrixXd& starts) : surface_(surface) {
    for (LocalSurface& local : surface.linearize(starts)) {
      const bool simulated = local.simulated;
      searches_.push_back({std::move(local), kFirstDamping, simulated});
    }
  }

  void run(int max_iterations) {
    for (int i = 1; i <= max_iterations && improve(); ++i) {
      if (i == 5 || i == 10) {
        giveUpHopeless();
      }
    }
  }

  /// The ends that could be simulated.
  std::vector<LocalSurface> listEnds() const {
    std::vector<LocalSurface> ends;
    for (const Search& search : searches_) {
      if (search.local.simulated) {
        ends.push_back(search.local);
      }
    }
    return ends;
  }

 private:
  /// One iteration of all that have not converged; false if there are none.
  bool improve() {
    std::vector<Search*> active;
    for (Search& search : searches_) {
      if (search.active) {
        active.push_back(&search);
      }
    }
    if (active.empty()) {
      return false;
    }
    const auto count = static_cast<Index>(active.size());
    constexpr auto kTrials = static_cast<Index>(kDampings.size());
    MatrixXd trials(surface_.getDimensions(), kTrials * count);
    for (Index k = 0; k < kTrials * count; ++k) {
      const Search& search = *active[static_cast<std::size_t>(k / kTrials)];
      const double factor = kDampings[static_cast<std::size_t>(k % kTrials)];
      trials.col(k) = take(search.local, calcStep(search.local, search.damping * factor));
    }
    const VectorXd reached = surface_.calcMisfits(trials);
    std::vector<Search*> moved;
    std::vector<Index> columns;
    for (Index i = 0; i < count; ++i) {
      Search& search = *active[static_cast<std::size_t>(i)];
      Index best = 0;
      if (reached.segment(i * kTrials, kTrials).minCoeff(&best) < search.local.misfit) {
        search.damping = std::max(search.damping * kDampings[static_cast<std::size_t>(best)], kMinDamping);
        moved.push_back(&search);
        columns.push_back(i * kTrials + best);
      } else {
        search.damping *= kRaise;
        search.active = search.damping < kMaxDamping;
      }
    }
    move(moved, trials(Eigen::all, columns));
    return true;
  }

  void move(const std::vector<Search*>& moved, const MatrixXd& to) {
    if (moved.empty()) {
      return;
    }
    std::vector<LocalSurface> reached = surface_.linearize(to);
    for (std::size_t i = 0; i < moved.size(); ++i) {
      Search& search = *moved[i];
      search.active = reached[i].simulated && predictGain(reached[i]) > kConvergedGain;
      if (reached[i].simulated) {
        search.local = std::move(reached[i]);
      }
    }
  }

  /// Searches far above the best one; a quarter of all is kept whatever it is.
  void giveUpHopeless() {
    constexpr double kAbove = 50.0, kOfBest = 0.5;
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
    const double near = reached.front() + std::max(kAbove, kOfBest * reached.front());
    const double limit = std::max(near, reached[reached.size() / 4]);
    for (Search& search : searches_) {
      search.active = search.active && search.local.misfit <= limit;
    }
  }

  MisfitSurface& surface_;
  std::vector<Search> searches_;
};

MatrixXd calcCovariance(const MatrixXd& information) {
  const Index u = information.rows();
  return linalg::solveCholesky(
      linalg::calcCholesky(information + kHalfWidthInformation * MatrixXd::Identity(u, u)).lower,
      MatrixXd::Identity(u, u));
}

/// Whether a point is within three standard deviations of a basin's minimum.
bool liesIn(const Basin& basin, const VectorXd& at) {
  constexpr double kReach = 3.0;
  const VectorXd apart = at - basin.local.at;
  return apart.dot(linalg::solvePositiveDefinite(basin.covariance, apart)) < kReach * kReach;
}

/// The ends that may bear some of the posterior, each basin once. An end 25 above the best bears a share of
/// 4e-6 for the same volume.
std::vector<Basin> collectBasins(std::vector<LocalSurface> ends) {
  constexpr double kAbove = 25.0;
  constexpr std::size_t kMax = 12;
  std::stable_sort(ends.begin(), ends.end(),
                   [](const LocalSurface& a, const LocalSurface& b) { return a.misfit < b.misfit; });
  std::vector<Basin> basins;
  for (LocalSurface& end : ends) {
    if (end.misfit > ends.front().misfit + kAbove) {
      break;
    }
    const auto known =
        std::find_if(basins.begin(), basins.end(), [&](const Basin& basin) { return liesIn(basin, end.at); });
    if (known != basins.end()) {
      ++known->searches;
    } else if (basins.size() < kMax) {
      MatrixXd covariance = calcCovariance(end.information);
      basins.push_back({end, std::move(covariance), 1});
    }
  }
  return basins;
}

bool isExplained(const std::vector<Basin>& basins) {
  return !basins.empty() &&
         basins.front().local.chi_square < calcChiSquareLimit(basins.front().local.degrees);
}

/// The ends of searches of more and more of the response, each from where the last one ended: a chaotic
/// response has many minima, but its beginning has few, and they lie where the next ones do.
std::vector<LocalSurface> searchGrowing(MisfitSurface& surface, MatrixXd starts, int max_iterations) {
  constexpr int kIterations = 8;  // where a window ends is but the next one's start
  const std::size_t windows = surface.countWindows();
  for (std::size_t i = 0; i + 1 < windows && starts.cols() > 0; ++i) {
    surface.setWindow(i);
    SearchTeam team(surface, starts);
    team.run(kIterations);
    const std::vector<LocalSurface> ends = team.listEnds();
    starts.resize(Eigen::NoChange, static_cast<Index>(ends.size()));
    for (std::size_t k = 0; k < ends.size(); ++k) {
      starts.col(static_cast<Index>(k)) = ends[k].at;
    }
  }
  surface.setWindow(windows - 1);
  if (starts.cols() == 0) {
    return {};
  }
  SearchTeam team(surface, starts);
  team.run(max_iterations);
  return team.listEnds();
}

/// All starts that may be needed (u x n): a batch is n columns on from those before it.
MatrixXd makeStarts(Index dimensions, std::uint64_t seed, const BasinSearchOptions& options) {
  PointSetSpec sobol;
  sobol.method = DesignMethod::kSobol;
  sobol.samples = options.starts * options.max_batches;
  const MatrixXd unit =
      sampleUnitCube(sobol, static_cast<int>(dimensions), seed, RandomPurpose::kBasinStarts);
  return 2.0 * unit.array() - 1.0;
}

}  // namespace

BasinSearch findBasins(MisfitSurface& surface, const MatrixXd& given, std::uint64_t seed,
                       const BasinSearchOptions& options) {
  const MatrixXd all = makeStarts(surface.getDimensions(), seed, options);
  BasinSearch search;
  std::vector<LocalSurface> ends;
  for (int batch = 0; batch < options.max_batches; ++batch) {
    const bool first = batch == 0;
    MatrixXd starts(all.rows(), options.starts + (first ? given.cols() : 0));
    starts.leftCols(options.starts) = all.middleCols(batch * options.starts, options.starts);
    if (first && given.cols() > 0) {
      starts.rightCols(given.cols()) = given;
    }
    SearchTeam team(surface, starts);
    team.run(options.max_iterations);
    std::vector<LocalSurface> found = team.listEnds();
    ends.insert(ends.end(), found.begin(), found.end());
    search.starts += static_cast<int>(starts.cols());
    search.basins = collectBasins(ends);
    if (!isExplained(search.basins) && surface.countWindows() > 1) {
      found = searchGrowing(surface, starts, options.max_iterations);
      ends.insert(ends.end(), found.begin(), found.end());
      search.basins = collectBasins(ends);
    }
    if (search.basins.empty() || search.basins.front().searches >= options.confirmations) {
      break;
    }
  }
  return search;
}

}  // namespace twinmap
