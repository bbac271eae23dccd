#include "kernels/tracking/modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/linalg/decompositions.hpp"
#include "kernels/tracking/box_site.hpp"

namespace twinmap::tracking {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// The information that is left of the belief after a measurement, by eigenvectors, and how far each pulls.
/// In coordinates in which the belief before is of mean 0 and unit variance.
struct Gained {
  VectorXd information, pulls;  // p
  MatrixXd vectors;             // p x p
};

Gained calcGained(const linalg::SymmetricEigen& after, const VectorXd& mean) {
  const VectorXd along = after.vectors.transpose() * mean, values = after.values.cwiseMax(1e-300);
  return {values.cwiseInverse().array() - 1.0, along.cwiseQuotient(values), after.vectors};
}

/// The same where factors of some coordinates are taken out, not the belief before.
Gained calcGained(const linalg::SymmetricEigen& after, const VectorXd& mean, const Belief& before,
                  const VectorXd& scale, const std::vector<BoxSite>& sites) {
  const Gained normal = calcGained(after, mean);
  MatrixXd information = normal.vectors * normal.information.asDiagonal() * normal.vectors.transpose();
  VectorXd pull = normal.vectors * normal.pulls;
  for (const BoxSite& site : sites) {
    const Index j = site.parameter;
    information(j, j) += 1.0 - scale[j] * scale[j] * site.precision;
    pull[j] -= scale[j] * (site.shift - site.precision * before.mean[j]);
  }
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(information);
  return {eigen.values, eigen.vectors.transpose() * pull, eigen.vectors};
}

std::vector<BoxSite> listSites(const Belief& after, const std::vector<Index>& uniform) {
  std::vector<BoxSite> sites;
  for (const Index j : uniform) {
    sites.push_back(calcBoxSite(j, after.mean[j], after.covariance(j, j)));
  }
  return sites;
}

}  // namespace

Measurement makeLikelihood(const Belief& before, const Belief& after, const std::vector<Index>& uniform) {
  constexpr double kHardlyMore = 0.9;  // of the standard deviation
  constexpr double kHardly = 1.0 / (kHardlyMore * kHardlyMore) - 1.0;
  constexpr double kNothing = 1e12, kSaysNothing = 1e4;  // variances of the belief before
  const Index p = before.mean.size();
  const linalg::Cholesky unit = linalg::calcCholesky(before.covariance);
  const MatrixXd half = linalg::solveLower(unit.lower, after.covariance);
  const MatrixXd whitened = linalg::solveLower(unit.lower, half.transpose());
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(0.5 * (whitened + whitened.transpose()));
  const VectorXd mean = linalg::solveLower(unit.lower, after.mean - before.mean);
  const Gained gained =
      uniform.empty() ? calcGained(eigen, mean)
                      : calcGained(eigen, mean, before, unit.lower.diagonal(), listSites(after, uniform));
  const MatrixXd directions =
      linalg::solveLower(unit.lower, MatrixXd::Identity(p, p)).transpose() * gained.vectors;
  Measurement measurement;
  measurement.rows.resize(p, p);
  measurement.values.resize(p);
  MatrixXd covariance = MatrixXd::Zero(p, p);
  Index k = 0;
  for (Index i = 0; i < p; ++i) {
    const double information = gained.information[i];
    const VectorXd axis = unit.lower * gained.vectors.col(i);  // of the parameters
    if (!(information > kHardly)) {
      covariance += kNothing * axis * axis.transpose();
      continue;
    }
    const double root = std::sqrt(information);
    measurement.rows.row(k) = root * directions.col(i).transpose();
    measurement.values[k] = measurement.rows.row(k).dot(before.mean) + gained.pulls[i] / root;
    covariance += axis * axis.transpose() / information;
    ++k;
  }
  measurement.rows.conservativeResize(k, p);
  measurement.values.conservativeResize(k);
  measurement.variances = covariance.diagonal().cwiseQuotient(before.covariance.diagonal());
  for (Index j = 0; j < p; ++j) {
    measurement.variances[j] = measurement.variances[j] < kSaysNothing
                                   ? measurement.variances[j] * before.covariance(j, j)
                                   : std::numeric_limits<double>::infinity();
  }
  return measurement;
}

namespace {

/// What rows over the parameters make of a belief of them; log of the density that it gave them.
double apply(const MatrixXd& rows, const VectorXd& values, Belief& belief) {
  return update({rows.transpose(), values}, belief);
}

/// Mean and covariance of a mixture.
Belief match(const std::vector<Belief>& beliefs, const VectorXd& weights) {
  const Index p = beliefs.front().mean.size();
  Belief matched{VectorXd::Zero(p), MatrixXd::Zero(p, p)};
  for (std::size_t c = 0; c < beliefs.size(); ++c) {
    matched.mean += weights[static_cast<Index>(c)] * beliefs[c].mean;
  }
  for (std::size_t c = 0; c < beliefs.size(); ++c) {
    const VectorXd off = beliefs[c].mean - matched.mean;
    matched.covariance += weights[static_cast<Index>(c)] * (beliefs[c].covariance + off * off.transpose());
  }
  return matched;
}

/// The parameters as a measurement sees them, under its conditions.
Belief see(const Model& model, const Measurement& measurement, const VectorXd& reference,
           const Belief& belief) {
  const Index p = model.countParameters(), first = p + model.countSlopes();
  MatrixXd seen = MatrixXd::Zero(p, model.countStates());
  seen.leftCols(p).setIdentity();
  for (std::size_t f = 0; f < model.follows.size(); ++f) {
    const Follow& follow = model.follows[f];
    const double condition = measurement.conditions[follow.condition] - reference[follow.condition];
    if (std::isfinite(condition)) {
      seen(follow.parameter, first + static_cast<Index>(f)) = condition;
    }
  }
  return {seen * belief.mean, seen * belief.covariance * seen.transpose()};
}

}  // namespace

Measurement makeLikelihood(const Belief& before, const std::vector<Belief>& after, const VectorXd& weights,
                           const std::vector<Index>& uniform) {
  Measurement measurement = makeLikelihood(before, match(after, weights), uniform);
  for (std::size_t c = 0; after.size() > 1 && c < after.size(); ++c) {
    const Measurement one = makeLikelihood(before, after[c], uniform);
    Belief belief = before;
    const double log_density = apply(one.rows, one.values, belief);
    measurement.modes.push_back(
        {one.rows, one.values, one.variances, std::log(weights[static_cast<Index>(c)]) - log_density});
  }
  return measurement;
}

Measurement resolveModes(const Model& model, const Measurement& measurement, const VectorXd& reference,
                         const Belief& belief) {
  if (measurement.modes.empty()) {
    return measurement;
  }
  constexpr double kSure = 0.999;
  const Belief seen = see(model, measurement, reference, belief);
  const auto count = static_cast<Index>(measurement.modes.size());
  std::vector<Belief> after(measurement.modes.size(), seen);
  VectorXd weights(count);
  for (Index c = 0; c < count; ++c) {
    const Mode& mode = measurement.modes[static_cast<std::size_t>(c)];
    weights[c] = mode.log_weight + apply(mode.rows, mode.values, after[static_cast<std::size_t>(c)]);
  }
  Index best = 0;
  weights = (weights.array() - weights.maxCoeff(&best)).exp();
  weights /= weights.sum();
  Measurement resolved;
  if (weights[best] > kSure) {
    const Mode& mode = measurement.modes[static_cast<std::size_t>(best)];
    resolved.rows = mode.rows;
    resolved.values = mode.values;
    resolved.variances = mode.variances;
  } else {
    resolved = makeLikelihood(seen, match(after, weights));
  }
  resolved.time = measurement.time;
  resolved.conditions = measurement.conditions;
  return resolved;
}

}  // namespace twinmap::tracking
