#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/base/log/search_stage.hpp"
#include "framework/estimation/posterior/basins/basin.hpp"
#include "framework/estimation/refined/damped_steps.hpp"

namespace twinmap {

/// How searches go and where they end. Of many parameters an iteration is dear, the response is nearly linear
/// where their priors leave them, and place and chi-square do not agree with a basin's by chance.
struct SearchPace {
  double converged = kLastGain;  ///< of chi-square, left to gain by the linear model
  /// The first iteration after which searches are judged: whatever is near a minimum has come down to it.
  int first_judged = 5;
  /// Whether searches end where their linear models lead into a basin that another has found; else where they
  /// are in it themselves.
  bool leads = false;
};

/// Of more than kManyUnknown a gain of 1.0 is left, as chi-square varies by some ten.
SearchPace choosePace(Eigen::Index dimensions);

/// What is left to gain of chi-square within the bounds by the linear model.
double calcGainLeft(const LocalSurface& local);

/// Searches for minima of chi-square that go side by side (DampedSteps): an iteration is a batch of
/// simulations and a batch with derivatives for those that moved. Searches far above the best are given up;
/// those that come into a basin that another has found end there, where they are not held.
class SearchTeam {
 public:
  /// starts: u x n. Search i does not move along column i of `held` (u x n; empty: all move freely).
  /// `surface` must outlive the object.
  SearchTeam(MisfitSurface& surface, const Eigen::MatrixXd& starts,
             const Eigen::MatrixXd& held = Eigen::MatrixXd());

  /// Basins of the same surface that earlier searches have found. Before run().
  void setKnown(const std::vector<Basin>& known) { known_ = known; }
  /// Another than choosePace(). Before run().
  void setPace(const SearchPace& pace) { pace_ = pace; }
  void run(int max_iterations);

  /// Where search i is.
  const LocalSurface& getLocal(Eigen::Index i) const { return searches_[static_cast<std::size_t>(i)].local; }
  /// Where the searches are that could be simulated.
  std::vector<LocalSurface> listEnds() const;

 private:
  struct Search {
    LocalSurface local;
    DampedSteps steps;
    bool active;
    double before = 0.0;  ///< chi-square before the last iteration
  };

  struct Place {
    Eigen::VectorXd at;
    double misfit;
  };

  void showProgress(SearchStage& stage) const;
  bool improve();
  std::vector<Search*> listActive();
  void move(const std::vector<Search*>& moved, const Eigen::MatrixXd& to);
  Place findPlace(const Search& search) const;
  void settle(Search& search);
  const LocalSurface* findBest() const;
  void giveUpHopeless();
  void giveUpSlow();

  MisfitSurface& surface_;
  SearchPace pace_;
  std::vector<Search> searches_;
  std::vector<Basin> known_;
};

}  // namespace twinmap
