#pragma once

#include <cmath>
#include <limits>
#include <random>

#include "framework/tracking/tracked_twin.hpp"

namespace twinmap::testing {

/// Two parameters: one walks at an unknown rate, the other follows a condition.
inline tracking::Model makeModel() {
  tracking::Model model;
  model.drifts = {{std::numeric_limits<double>::quiet_NaN()}, {0.0}};
  model.follows = {{1, 0, 0.0}};
  model.conditions = 1;
  model.mean = Eigen::VectorXd::Zero(2);
  model.covariance = Eigen::MatrixXd::Identity(2, 2) / 3.0;
  return model;
}

/// Measurements of a machine whose first parameter steps by 20 standard deviations of one at the 40th.
inline std::vector<TrackRecord> makeRecords(int count) {
  constexpr double kMeasured = 0.01;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::vector<TrackRecord> records;
  for (int i = 0; i < count; ++i) {
    TrackRecord record{"m" + std::to_string(i), std::string(32, static_cast<char>('a' + i % 26)), "ok"};
    record.estimate = Eigen::Vector2d(i < 40 ? 0.1 : 0.3, -0.2) +
                      kMeasured * Eigen::Vector2d(normal(random), normal(random));
    record.covariates = {{"the amplitude of x", 0.1 * normal(random)}};
    tracking::Measurement& measurement = record.measurement;
    measurement.time = 10.0 * i;
    measurement.rows = Eigen::MatrixXd::Identity(2, 2) / kMeasured;
    measurement.values = record.estimate / kMeasured;
    measurement.variances = Eigen::VectorXd::Constant(2, kMeasured * kMeasured);
    measurement.conditions = Eigen::VectorXd::Constant(1, i == 7 ? std::nan("") : 20.0 + normal(random));
    records.push_back(record);
  }
  return records;
}

}  // namespace twinmap::testing
