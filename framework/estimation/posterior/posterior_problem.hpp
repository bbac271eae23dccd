#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "framework/estimation/posterior/noise/noise_hypothesis.hpp"
#include "framework/estimation/refined/misfit.hpp"

namespace twinmap {

/// One measurement, and what simulates its trial.
struct MeasuredTrial {
  Simulator* simulator;
  const RefinementModel* model;
  Eigen::VectorXd features;           ///< d, finite where the model looks at them
  Eigen::VectorXd held;               ///< a point of the trial's sampled box, whose known inputs are kept
  std::vector<Eigen::Index> unknown;  ///< which of all unknown parameters the trial's are, in its order
  NoiseHypothesis noise{};
  std::shared_ptr<const RefinementModel> own_model{};  ///< `model`, where it is of this measurement alone
  /// In the place of model, features, held and noise, where the trial is not simulated whole.
  std::function<std::unique_ptr<MeasuredMisfit>()> make_misfit{};
  /// What the measurement shows of its unknown parameters, NaN of others; empty: of none (readShownStart).
  Eigen::VectorXd shown{};
};

/// The misfit of a trial that is simulated whole, over all that is unknown of it.
struct TrialMisfit {
  explicit TrialMisfit(const MeasuredTrial& trial)
      : box(trial.model->getUnknown(), {0, static_cast<Eigen::Index>(trial.model->getUnknown().size())},
            trial.held),
        misfit(*trial.simulator, *trial.model, box, trial.features) {}
  TrialMisfit(const TrialMisfit&) = delete;
  TrialMisfit& operator=(const TrialMisfit&) = delete;

  /// At a point of all that is unknown of it, in the parameters' units.
  LocalMisfit linearize(const Eigen::VectorXd& point) { return misfit.linearize(box.normalize(point)); }

  const SearchBox box;
  Misfit misfit;
};

/// What is known of a machine: one or several measurements, and what was known before.
struct PosteriorProblem {
  /// u: the machine's parameters, then what each measurement leaves unknown besides.
  std::vector<ParameterSpec> unknown;
  std::vector<PriorGroupSpec> priors;  ///< of several of them together
  std::vector<MeasuredTrial> trials;
  /// Of the unknown parameters, the first that are drawn; the others are integrated out (MarginalSurface).
  Eigen::Index drawn = 0;
};

/// Points to search from (u x n), and the last of them, without any the middle of the bounds, with what
/// measurements show of their start, where they show any.
Eigen::MatrixXd addShownStart(const PosteriorProblem& problem, const Eigen::MatrixXd& given);

/// Whether threads are better spent on whole trials: with more than kManyUnknown parameters a simulation
/// takes long enough, and few of them side by side leave a thread's lanes empty. No two may share a
/// simulator.
bool mayRunSideBySide(const PosteriorProblem& problem);

}  // namespace twinmap
