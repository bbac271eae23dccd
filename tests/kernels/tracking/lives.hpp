#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "kernels/tracking/tracker.hpp"

namespace twinmap::tracking::testing {

/// A machine whose p parameters walk, measured once a unit of time with a standard deviation of .01 each.
struct Life {
  double walk_ratio = 0.0;  ///< standard deviation of a step of the walk over that of a measurement
  double slope = 0.0;       ///< per measurement, in its standard deviations
  double step = 0.0;        ///< of the first parameter, likewise
  int step_at = -1;
  double bad = 0.0;  ///< share of measurements that say anything
};

constexpr double kMeasured = 0.01;

inline Model makeModel(Eigen::Index p, double rate) {
  Model model;
  model.drifts.resize(static_cast<std::size_t>(p));
  for (Drift& drift : model.drifts) {
    drift.rate = rate;
  }
  model.mean = Eigen::VectorXd::Zero(p);
  model.covariance = Eigen::MatrixXd::Identity(p, p) / 3.0;
  return model;
}

inline double calcRate(double walk_ratio) {
  return std::pow(walk_ratio * kMeasured, 2);
}

/// Draws a life, one measurement after another.
class LivingMachine {
 public:
  LivingMachine(Eigen::Index p, Life life, unsigned seed) : life_(life), random_(seed), truth_(p) {
    constexpr double kStart = 0.3;
    for (double& value : truth_) {
      value = kStart * normal_(random_);
    }
  }

  Measurement measure() {
    const Eigen::Index p = truth_.size();
    for (double& value : truth_) {
      value += kMeasured * (life_.walk_ratio * normal_(random_) + life_.slope);
    }
    if (count_ == life_.step_at) {
      truth_[0] += life_.step * kMeasured;
    }
    constexpr double kFar = 50.0;
    const double noise = std::uniform_real_distribution<double>()(random_) < life_.bad ? kFar : 1.0;
    Measurement measurement{static_cast<double>(count_++),
                            Eigen::MatrixXd::Identity(p, p) / kMeasured,
                            truth_ / kMeasured,
                            Eigen::VectorXd::Constant(p, kMeasured * kMeasured),
                            {}};
    for (double& value : measurement.values) {
      value += noise * normal_(random_);
    }
    return measurement;
  }

  const Eigen::VectorXd& getTruth() const { return truth_; }

 private:
  Life life_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  Eigen::VectorXd truth_;
  int count_ = 0;
};

}  // namespace twinmap::tracking::testing
