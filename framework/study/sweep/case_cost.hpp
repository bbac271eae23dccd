#pragma once

#include <vector>

#include "framework/data/reduction/response_reduction.hpp"
#include "framework/experiment/experiment_spec.hpp"

namespace twinmap {

inline constexpr double kGibibyte = 1024.0 * 1024.0 * 1024.0;  ///< bytes

/// Numbers of a simulated response, with the modes of one.
double countRecordedRows(const ExperimentSpec& experiment);
/// The same of what a run keeps of it: where samples are reduced, so many scores a window and two sums.
double countRows(const ExperimentSpec& experiment, double scores = double(kMostScores));
/// Windows of a surrogate's features, at least.
double countWindows(const ExperimentSpec& experiment);

/// Searches for hyperparameters that follow one another in the training of a map.
struct TrainingStep {
  double samples = 0.0;    ///< n; an evaluation of the marginal likelihood takes some n^3 flops
  double processes = 0.0;  ///< one per parameter
  double searches = 0.0;   ///< of each; 0: evaluations are counted in relative_cost
  double relative_cost = 1.0;
};

/// The steps of training (trainGpMap): all starts on the first of the replicates, one search on all of them,
/// or on countSearchedReplicates() and a fit to all; for a sparse map on its subset, then the evaluations of
/// the bound, n m^2 flops each. With several length scales, searches for a shared one lead the last start.
std::vector<TrainingStep> listTrainingSteps(const ExperimentSpec& experiment);

/// What a case needs beside its simulations; estimates.
struct CaseCost {
  double bytes = 0.0;  ///< at the peak
  double flops = 0.0;  ///< of the training, with kEvaluations to a search
};

/// bytes: for exact processes with n samples, replicates included, m of them searched with, and P parameters,
/// 8 m^2 (2.5 a search that runs at the same time + 1), at least 8 n^2 3.5 to fit one, and 8 n^2 1.5 P; and
/// 10 numbers for every one of a response; 8 d^2 numbers for d features; and where there is an information
/// limit, the stencils of the test samples, which exact derivatives stay below; and the draws of exact
/// posteriors.
CaseCost calcCaseCost(const ExperimentSpec& experiment, int threads);

/// Throws ExperimentError, before any work begins, where a case needs more than `bytes`.
void requireMemory(const ExperimentSpec& experiment, int threads, double bytes);

/// Of the machine, bytes.
double getMachineMemory();

/// What a run may still take: of the machine what is free or can be freed, within the limits of its container
/// (cgroup v2) and of the process (ulimit -v); bytes.
double getAvailableMemory();

/// Evaluations of the marginal likelihood in one search.
inline constexpr double kEvaluations = 30.0;

}  // namespace twinmap
