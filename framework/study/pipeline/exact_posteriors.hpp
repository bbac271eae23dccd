#pragma once

#include <vector>

#include "framework/estimation/posterior/simulator_posterior.hpp"
#include "framework/results/run_summary.hpp"
#include "framework/study/pipeline/preparation/prepare_data.hpp"

namespace twinmap {

/// The exact posteriors of the first `count` test samples, on a team of threads (samplePosterior), as
/// `twinmap infer FILE.yaml` gives them. draws: of a round; seconds: unless null, what each took. Throws
/// std::invalid_argument for a feature without noise.
std::vector<SimulatorPosterior> sampleTestPosteriors(const Study& study, const LabelledFeatures& test,
                                                     Eigen::Index count, int draws,
                                                     Eigen::VectorXd* seconds = nullptr);

/// Half widths, in standard deviations, of the intervals about the mean that hold half, and 95 %, of the
/// weight of draws.
IntervalFactor calcDrawnFactor(const Eigen::VectorXd& values, const Eigen::VectorXd& weights, double mean,
                               double stddev);

/// The posteriors that are reliable (p x n) as estimates whose intervals hold the draws that they say: mean
/// +- what holds half, and 95 %, of their weight. `samples`: their indices.
struct ReliablePosteriors {
  std::vector<Eigen::Index> samples;
  Estimates estimates;
};
ReliablePosteriors takeReliable(const std::vector<SimulatorPosterior>& posteriors, Eigen::Index parameters);

/// The row of methods.csv of exact posteriors, of the first test samples.
MethodSummary summarizePosteriors(const std::vector<ParameterSpec>& parameters, const Eigen::MatrixXd& truth,
                                  const std::vector<SimulatorPosterior>& posteriors,
                                  const Eigen::MatrixXd& limit_stddev);

/// Refined estimates beside exact posteriors of the same, first samples.
struct PosteriorDifference {
  int compared = 0;  ///< accepted, with a reliable posterior
  int apart = 0;     ///< of them, mean or sd of a parameter more than .3 of the posterior's sd off

  double calcShare() const { return static_cast<double>(apart) / compared; }
  /// Above one sample in twenty.
  bool isConspicuous() const { return 20 * apart > compared; }
};
PosteriorDifference compareRefined(const std::vector<Refined>& refined,
                                   const std::vector<SimulatorPosterior>& posteriors,
                                   Eigen::Index parameters);

}  // namespace twinmap
