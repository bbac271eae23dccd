#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "kernels/gp/gaussian_process.hpp"
#include "kernels/gp/model.hpp"
#include "kernels/gp/training_options.hpp"

namespace twinmap::gp {

/// One local search.
struct StartReport {
  Hyperparameters start;
  Hyperparameters end;
  double nlml = 0.0;       ///< nats, +infinity if no evaluation succeeded
  double objective = 0.0;  ///< NLML plus the prior's negative log density
  int evaluations = 0;
  double largest_jitter = 0.0;  ///< over all evaluations
  bool noise_only = false;      ///< explains the target no better than pure noise does
  bool converged = false;
  std::string stop_reason;
};

/// A hyperparameter and the bounds of its search.
struct BoundedHyperparameter {
  std::string name;  ///< "length_scale[0]"
  double value = 0.0, lower = 0.0, upper = 0.0;
};

struct TrainingReport {
  std::vector<StartReport> starts;
  int best_start = -1;
  int evaluations = 0;                ///< of all starts, those of the shared warm start included
  double noise_only_nlml = 0.0;       ///< the least NLML without a signal, for comparison
  std::vector<std::string> at_bound;  ///< e.g. "noise_stddev at its lower bound 1e-05"
  std::vector<BoundedHyperparameter> hyperparameters;  ///< of the best start
  double condition = 0.0;  ///< estimated 1-norm condition number of K + (s_n^2 + jitter) I
  double jitter = 0.0;     ///< squared target units, of the final factor
};

enum class TrainingStatus {
  kConverged,
  kEvaluationLimit,  ///< usable; the best start hit max_evaluations
  kNoiseOnly,        ///< usable, but every start found the target to be noise: the features say nothing
  kConstantTarget,   ///< no process: the target does not vary
  kFailed            ///< no process: no start had a finite NLML
};
const char* toString(TrainingStatus status);

struct TrainingResult {
  TrainingStatus status = TrainingStatus::kFailed;
  std::string message;                        ///< for a person: what happened and why
  std::shared_ptr<const GaussianProcess> gp;  ///< null where the status says so
  TrainingReport report;
  Eigen::MatrixXd curvature;  ///< of the NLML at the end (calcCurvature()); empty unless asked for
};

/// Trains one process per row of `targets` (t x n) on the same inputs (d x n): hyperparameters by least NLML,
/// NLopt's L-BFGS on their logarithms within bounds, from several deterministic starts. Results are bitwise
/// the same for any number of threads. Throws std::invalid_argument for input that cannot be meant: NaN,
/// sizes that do not fit, n < 2, all inputs equal, options out of range; Stopped where the options ask for
/// it. A constant target is a status. Cost per evaluation: n^3 flops; memory per thread: 2.5 n^2 doubles.
std::vector<TrainingResult> train(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                  const Eigen::Ref<const Eigen::MatrixXd>& targets,
                                  const ModelStructure& structure, const TrainingOptions& options = {});

}  // namespace twinmap::gp
