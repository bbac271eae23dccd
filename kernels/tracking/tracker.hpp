#pragma once

#include <optional>

#include "kernels/tracking/change_bank.hpp"
#include "kernels/tracking/rate_bank.hpp"

namespace twinmap::tracking {

/// So many measurements in a row that say something and are not used: all begins anew. Six in a million where
/// one in twenty is bad.
constexpr int kRunOfBad = 4;

/// All that a tracker remembers: constant in size.
struct TrackerState {
  long long count = 0;                ///< measurements so far
  long long informed = 0;             ///< of these, those that have rows
  double time = 0.0;                  ///< of the last
  double interval = 0.0;              ///< between the first two times that differ; 0: there are none yet
  Eigen::VectorXd variances;          ///< p: mean of those of the measurements so far
  Eigen::VectorXd reference, spread;  ///< conditions: the first value, the variance about it
  Eigen::VectorXd condition_counts;   ///< of values that were there
  Belief belief;
  std::vector<RateFilters> filters;  ///< of each unknown rate
  ChangeBank changes;
  int run_of_bad = 0;      ///< measurements in a row that were not used
  double surprises = 0.0;  ///< of the last 20 measurements, those that were not used
  double widening = 1.0;   ///< of known rates
};

/// What became of a measurement.
struct Step {
  bool is_used = false;     ///< else it fits neither the belief nor noise
  double chi_square = 0.0;  ///< of its innovation, `degrees` of freedom
  double degrees = 0.0;
  double statistic = 0.0;  ///< calcShiryaevRoberts(), over its threshold: 1 is an alarm
  std::optional<Change> change{};
  bool has_begun_anew = false;   ///< nothing of one parameter explains the last ones: all are unknown again
  bool is_uncalibrated = false;  ///< half of the last 20 were not used
  Measurement taken{};           ///< what it said, its modes resolved (resolveModes())
};

/// Exact filters of a linear model with normal noise. Means and covariances are Kalman's where rates are
/// known. Unknown rates are integrated out over a bank of filters. A measurement that nothing explains (bad,
/// one in twenty) does not move the belief. Sums of likelihood ratios (Shiryaev, Roberts) raise alarms;
/// after one the parameter is what the change makes it, and the walk goes on from there.
class Tracker {
 public:
  explicit Tracker(Model model);

  /// Times may not go back. O((rates unknown + changes supposed) k n^2), with four parameters some 20 us.
  Step advance(const Measurement& said);

  const Model& getModel() const { return model_; }
  const TrackerState& getState() const { return state_; }
  void setState(TrackerState state) { state_ = std::move(state); }

  /// The belief now, over all rates, with the errors that all measurements share.
  Belief calcBelief() const;
  /// p: variances of these errors.
  Eigen::VectorXd calcSharedVariances() const;
  /// Variance per unit of time of each parameter (p): the mean of what is known, and as many standard
  /// deviations of it above.
  Eigen::VectorXd calcRates(double above = 0.0) const;
  /// Variances of the priors of slopes and coefficients; 0 where their units are not known yet.
  Eigen::VectorXd calcUnits() const;

 private:
  void setUnits(const Eigen::VectorXd& before);
  void noteConditions(const Measurement& measurement);
  void noteVariances(const Measurement& measurement);
  void moveTo(double time);
  void take(const StateRows& rows, const Belief& updated);
  void confirm(const Change& change, double odds);
  void beginAnew();
  bool widenRates();
  double calcUnitRate(Eigen::Index parameter) const;
  /// p: of each walk's standard deviation in an interval over that of a measurement.
  Eigen::VectorXd calcRatios() const;

  Model model_;
  TrackerState state_;
};

}  // namespace twinmap::tracking
