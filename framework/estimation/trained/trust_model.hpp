#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "framework/estimation/estimator.hpp"
#include "framework/estimation/surrogate/score_inversion.hpp"
#include "framework/estimation/trained/anomaly.hpp"
#include "framework/estimation/trained/residual_space.hpp"
#include "framework/estimation/trained/test_records.hpp"

namespace twinmap {

/// What to think of an inference, the most severe first.
enum class TrustStatus {
  kModelMismatch,    ///< no point of the box explains the features within their noise
  kOutsideTraining,  ///< the features are far from all the map was trained on
  kAtBounds,         ///< a parameter lies beyond its bounds
  kUninformative,    ///< a parameter's standard deviation is close to that of the prior
  kOk
};

/// "model_mismatch", ...
const char* toString(TrustStatus status);

/// Whether to believe an inference, with the numbers that tell.
struct Trust {
  std::vector<TrustStatus> statuses;  ///< all that apply, the most severe first; {kOk} if none does
  double p_value = 1.0;               ///< of the residual, as if the model were right
  double chi_square = 0.0;            ///< sum of the squared residuals, in variances
  Eigen::Index residuals = 0;         ///< how many
  Anomaly anomaly;                    ///< the most conspicuous stretch of residuals
  double anomaly_p_value = 1.0, chi_square_p_value = 1.0;  ///< each test's own
  double distance = 0.0;  ///< to the nearest training sample, 1: the farthest of simulated measurements
  double smallest_p_value = 0.0;  ///< that simulated measurements can show; p_value claims no less
};

/// A statistic of simulated measurements, sorted: what a measured one is compared with.
struct ReferenceDistribution {
  Eigen::VectorXd sorted;

  /// The share of simulated measurements whose statistic is at least `value`: (count + 1) / (n + 1).
  double calcPValue(double value) const;
};

/// What a refinement on the simulator made of simulated measurements.
struct RefinementReference {
  Eigen::Index tried = 0;       ///< measurements; 0 where none was refined
  Eigen::VectorXd unexplained;  ///< sorted: chi-square over its degrees of freedom, of those not explained
};

/// Where the map was trained: its inputs, each in standard deviations.
struct TrainingCloud {
  Eigen::MatrixXd inputs;  ///< k x n, scaled
  Eigen::VectorXd scale;   ///< k
  double reach = 1.0;      ///< the largest distance of a simulated measurement to its nearest neighbour

  /// Distance of inputs (k, not scaled) to the nearest training input, over `reach`.
  double calcDistance(const Eigen::Ref<const Eigen::VectorXd>& at, Eigen::VectorXd& buffer) const;
};

/// Tells whether a measurement is one that the simulator could have given. All but the level is found from
/// simulations; the reference distributions include whatever the approximations leave.
struct TrustModel {
  std::shared_ptr<const ForwardSurrogate> forward;  ///< that of the map, if it is a surrogate
  ResidualSpace space;
  std::vector<ResidualRun> runs;
  ReferenceDistribution chi_square, anomaly;  ///< of simulated measurements, judged with the surrogate
  ReferenceDistribution noise_anomaly;        ///< of noise alone: of answers that the simulator explains
  RefinementReference refinement;
  CoverageRecord coverage, refined_coverage;  ///< of the estimator's test samples, and of those refined
  RankRecord posteriors;                      ///< of posteriors under `forward`
  TrainingCloud cloud;
  Eigen::VectorXd center, half_width;  ///< m, of the sampled box
  Eigen::Index unknown = 0;            ///< leading variables of a point that a measurement leaves open
  BoxPrior prior;                      ///< of them
  double level = 0.01;                 ///< false alarms of model_mismatch

  /// The point of the sampled box that a normalised one stands for.
  Eigen::VectorXd makeSampledPoint(const Eigen::Ref<const Eigen::VectorXd>& normalised) const {
    return center + half_width.cwiseProduct(normalised);
  }
};

/// The buffers of one thread; the model must outlive them.
struct TrustWorkspace {
  explicit TrustWorkspace(const TrustModel& model) : inversion(*model.forward, model.prior) {}
  TrustWorkspace(const TrustWorkspace&) = delete;
  TrustWorkspace& operator=(const TrustWorkspace&) = delete;

  ScoreInversion inversion;
  const ScoreExplanation* explanation =
      nullptr;  ///< of the measurement judged last, as long as `explained` lives
  Eigen::VectorXd start, centered, scores, residual, distance;  // the start is normalised
};

/// Judges an estimate from features (d, finite) and known inputs (q), by the point of the box that explains
/// them best according to the surrogate: `explained`, where the map found it (Estimator::Workspace), else
/// searched from the estimate. Cost: that of one pass over the training cloud, and of the search, about 1 ms
/// for 200 features.
Trust judge(const TrustModel& model, const Eigen::Ref<const Eigen::VectorXd>& features,
            const Eigen::Ref<const Eigen::VectorXd>& known, const Estimate& estimate,
            const ScoreExplanation* explained, TrustWorkspace& workspace);

/// Sets residual, statistics and p-values of `trust` from what the surrogate leaves (ResidualSpace).
void compareWithSimulated(const TrustModel& model, const Eigen::VectorXd& residual, Trust& trust);

/// What a search on the simulator left of a measurement.
struct SimulatorResidual {
  Eigen::VectorXd residual;  ///< k, in noise standard deviations; empty where nothing could be simulated
  double reduced_chi_square = 0.0;  ///< over its degrees of freedom
  double degrees = 0.0;             ///< of freedom: k less the parameters that were determined
  bool explained = false;  ///< whether noise explains the residual, at a level far below TrustModel::level
  Eigen::VectorXd mean;    ///< p, the refined estimate where it was accepted; else empty
  Eigen::VectorXd stddev;  ///< p
};

/// Judges a measurement anew by what the simulator leaves of it, which has no error of a surrogate: replaces
/// residual, p-values and the statuses that follow. What it explains is tested against noise alone; what it
/// does not explain is as suspicious as such measurements are rare among simulated ones
/// (RefinementReference): their common level is TrustModel::level. Where too few were refined to tell, its
/// chi-square decides: what the surrogate lacks excuses nothing that the simulator was asked.
Trust judgeAnew(const TrustModel& model, const Trust& trust, const SimulatorResidual& found);

}  // namespace twinmap
