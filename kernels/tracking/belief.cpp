#include "kernels/tracking/belief.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/tracking/log_product.hpp"

namespace twinmap::tracking {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Belief makePrior(const Model& model) {
  const Index n = model.countStates(), p = model.countParameters();
  Belief belief{VectorXd::Zero(n), MatrixXd::Zero(n, n)};
  belief.mean.head(p) = model.mean;
  belief.covariance.topLeftCorner(p, p) = model.covariance;
  return belief;
}

namespace {

/// How far a walk may take a level's variance: to that of its prior, or of a parameter that may be anywhere
/// within its bounds.
double calcLargestVariance(const Model& model, Index parameter) {
  constexpr double kWithinBounds = 1.0 / 3.0;
  return std::max(model.covariance(parameter, parameter), kWithinBounds);
}

}  // namespace

void predict(const Model& model, double dt, const VectorXd& growth, Belief& belief) {
  const Index p = model.countParameters();
  MatrixXd& covariance = belief.covariance;
  Index slope = p;
  for (Index j = 0; j < p; ++j) {
    if (model.drifts[static_cast<std::size_t>(j)].has_slope) {
      belief.mean[j] += dt * belief.mean[slope];
      covariance.row(j) += dt * covariance.row(slope);
      covariance.col(j) += dt * covariance.col(slope);
      ++slope;
      covariance(j, j) += growth[j];
      continue;
    }
    const double room = calcLargestVariance(model, j) - covariance(j, j);
    covariance(j, j) += std::min(growth[j], std::max(room, 0.0));
  }
}

namespace {

/// Adds noise of variance v along a column (k) to rows of unit variance and makes them of unit variance
/// again. (1 + v c c')^(-1/2) = 1 - (1 - 1/sqrt(1 + v c'c)) c c' / c'c.
void addNoise(VectorXd column, double variance, StateRows& rows) {
  const double length = column.squaredNorm();
  if (!(length > 0.0)) {
    return;
  }
  const double share = (1.0 - 1.0 / std::sqrt(1.0 + variance * length)) / length;
  rows.values -= share * column.dot(rows.values) * column;
  const VectorXd along = rows.rows * column;
  rows.rows.noalias() -= share * along * column.transpose();
}

}  // namespace

StateRows makeStateRows(const Model& model, const Measurement& measurement, const VectorXd& reference,
                        const VectorXd& spread, const Belief& belief) {
  const Index p = model.countParameters(), first = p + model.countSlopes();
  StateRows rows{MatrixXd::Zero(model.countStates(), measurement.rows.rows()), measurement.values};
  rows.rows.topRows(p) = measurement.rows.transpose();
  for (std::size_t f = 0; f < model.follows.size(); ++f) {
    const Follow& follow = model.follows[f];
    const Index coefficient = first + static_cast<Index>(f);
    const double condition = measurement.conditions[follow.condition] - reference[follow.condition];
    if (std::isfinite(condition)) {
      rows.rows.row(coefficient) = condition * rows.rows.row(follow.parameter);
    }
  }
  for (std::size_t f = 0; f < model.follows.size(); ++f) {
    const Follow& follow = model.follows[f];
    if (!std::isfinite(measurement.conditions[follow.condition])) {
      const Index coefficient = first + static_cast<Index>(f);
      const double square =
          belief.mean[coefficient] * belief.mean[coefficient] + belief.covariance(coefficient, coefficient);
      addNoise(rows.rows.row(follow.parameter).transpose(), square * spread[follow.condition], rows);
    }
  }
  return rows;
}

double update(const StateRows& rows, Belief& belief, std::vector<Innovation>* innovations) {
  constexpr double kLogTwoPi = 1.8378770664093453;
  const Index n = belief.mean.size(), k = rows.values.size();
  VectorXd gain(n);
  double loss = kLogTwoPi * static_cast<double>(k);
  LogProduct variances;
  for (Index i = 0; i < k; ++i) {
    const auto h = rows.rows.col(i);
    gain.noalias() = belief.covariance * h;
    const double variance = h.dot(gain) + 1.0, value = rows.values[i] - h.dot(belief.mean);
    belief.mean += (value / variance) * gain;
    for (Index c = 0; c < n; ++c) {
      belief.covariance.col(c) -= (gain[c] / variance) * gain;
    }
    loss += value * value / variance;
    variances.multiply(variance);
    if (innovations != nullptr) {
      Innovation& innovation = (*innovations)[static_cast<std::size_t>(i)];
      innovation.value = value;
      innovation.variance = variance;
      innovation.gain = gain / variance;
    }
  }
  return -0.5 * (loss + variances.calc());
}

}  // namespace twinmap::tracking
