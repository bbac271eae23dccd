#include "kernels/tracking/smoother.hpp"

#include <cmath>

namespace twinmap::tracking {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Before and after the values of one measurement.
struct Passed {
  Belief predicted;
  std::vector<Innovation> innovations;
};

void moveTo(const Model& model, const SmoothedStep& step, const VectorXd& rates, Belief& belief) {
  if (step.units.size() > 0) {
    belief.covariance.diagonal() += step.units;
  }
  predict(model, step.dt, step.dt * rates, belief);
  if (step.forgotten.size() > 0) {
    belief.covariance.diagonal().head(model.countParameters()) += step.forgotten;
  }
}

/// The adjoint of a step of time: that of levels moved by slopes.
void moveBack(const Model& model, double dt, VectorXd& descent, MatrixXd& information) {
  Index slope = model.countParameters();
  for (Index j = 0; j < model.countParameters(); ++j) {
    if (model.drifts[static_cast<std::size_t>(j)].has_slope) {
      descent[slope] += dt * descent[j];
      information.row(slope) += dt * information.row(j);
      information.col(slope) += dt * information.col(j);
      ++slope;
    }
  }
}

/// The adjoint of one value. With A = 1 - gain h' it is
/// r = h v / s + A' r. Likewise N = h h' / s + A' N A.
void addValue(const VectorXd& h, const Innovation& innovation, VectorXd& descent, MatrixXd& information) {
  descent += (innovation.value / innovation.variance - innovation.gain.dot(descent)) * h;
  const VectorXd along = information * innovation.gain;
  const double square = innovation.gain.dot(along) + 1.0 / innovation.variance;
  information -= along * h.transpose() + h * along.transpose();
  information += square * h * h.transpose();
}

}  // namespace

Smoothed smooth(const Model& model, const std::vector<SmoothedStep>& steps, const VectorXd& rates) {
  const Index n = model.countStates(), p = model.countParameters(), count = static_cast<Index>(steps.size());
  std::vector<Passed> passed(steps.size());
  Smoothed smoothed{{MatrixXd(p, count), MatrixXd(p, count)}, 0.0};
  Belief belief = makePrior(model);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    moveTo(model, steps[i], rates, belief);
    passed[i].predicted = belief;
    passed[i].innovations.resize(static_cast<std::size_t>(steps[i].rows.values.size()));
    smoothed.log_likelihood += update(steps[i].rows, belief, &passed[i].innovations);
  }
  VectorXd descent = VectorXd::Zero(n);
  MatrixXd information = MatrixXd::Zero(n, n);
  for (std::size_t i = steps.size(); i-- > 0;) {
    for (std::size_t v = passed[i].innovations.size(); v-- > 0;) {
      addValue(steps[i].rows.rows.col(static_cast<Index>(v)), passed[i].innovations[v], descent, information);
    }
    const Belief& before = passed[i].predicted;
    const VectorXd means = before.mean + before.covariance * descent;
    const MatrixXd along = information * before.covariance;
    for (Index j = 0; j < p; ++j) {
      const double variance = before.covariance(j, j) - before.covariance.row(j).dot(along.col(j));
      smoothed.course.means(j, static_cast<Index>(i)) = means[j];
      smoothed.course.stddevs(j, static_cast<Index>(i)) = std::sqrt(std::max(variance, 0.0));
    }
    moveBack(model, steps[i].dt, descent, information);
  }
  return smoothed;
}

}  // namespace twinmap::tracking
