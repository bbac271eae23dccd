#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "framework/optimal_design/excitation_evaluation.hpp"
#include "kernels/optimization/constrained_search.hpp"

namespace twinmap::experiment_design {

struct TriedDesign {
  Eigen::VectorXd point;  ///< fractions of the bounds
  DesignScore score;
};

/// The largest of measure / most - 1: above 0 where a limit is broken; infinite where a simulation failed,
/// minus infinity where there are no limits.
double calcViolation(const DesignScore& score, const Eigen::VectorXd& most);

struct SearchOptions {
  int budget = 2000;       ///< designs that run() may try
  bool global = false;     ///< an evolution strategy before the local searches: for phases
  std::uint64_t seed = 1;  ///< of the starts
};

/// Searches the free values of an excitation for the least cost within limits. A fifth of the budget goes to
/// the present design and a Sobol sequence; where asked for, three tenths to an evolution strategy; the rest
/// to local searches (COBYLA, then sequential quadratic programming on differences) from the three best, and
/// from the best of all. Deterministic: the same judge gives the same path.
class DesignSearch {
 public:
  /// Costs of a simulation or two a point; may throw to stop, after which path and best stay readable.
  using Judge = std::function<DesignScore(const Eigen::VectorXd& point)>;

  /// `most`: what the search keeps each measure below; 0.5 % of it stays unused, so that designs at a limit
  /// keep it.
  DesignSearch(Judge judge, Eigen::VectorXd most, const SearchOptions& options);

  void run(const Eigen::VectorXd& present);

  /// Goes on from the best after limits were tightened: at most so many designs.
  void refine(const Eigen::VectorXd& most, int budget);

  const std::vector<TriedDesign>& getPath() const { return path_; }
  /// The tried design of least cost that keeps the limits; none if none does.
  const TriedDesign* findBest() const;
  /// The design of least violation.
  const TriedDesign& findLeastViolation() const;

 private:
  DesignScore tryDesign(const Eigen::VectorXd& point);
  double calcMerit(const TriedDesign& tried) const;
  void screen(const Eigen::VectorXd& present, int count);
  /// What a search keeps the measures below: the limits with their margin, where designs differ in the
  /// measure at all.
  Eigen::VectorXd calcTargets() const;
  std::vector<Eigen::VectorXd> findStarts(std::size_t count) const;
  void searchFrom(const Eigen::VectorXd& start, double first_step, int budget);
  void search(const Eigen::VectorXd& start, optimization::ConstrainedMethod method, double first_step,
              int budget);

  Judge judge_;
  Eigen::VectorXd most_;
  SearchOptions options_;
  std::vector<TriedDesign> path_;
};

}  // namespace twinmap::experiment_design
