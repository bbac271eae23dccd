#include "framework/experiment/points/prior.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/experiment/points/prior_marginal.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Of values in columns, each row by itself.
VectorXd calcRowStddevs(const MatrixXd& values) {
  const VectorXd mean = values.rowwise().mean();
  return ((values.colwise() - mean).rowwise().squaredNorm() / static_cast<double>(values.cols())).cwiseSqrt();
}

Index findParameter(const std::vector<ParameterSpec>& unknown, const Name& name) {
  const auto found = std::find_if(unknown.begin(), unknown.end(),
                                  [&](const ParameterSpec& p) { return p.name.text == name.text; });
  return found == unknown.end() ? -1 : found - unknown.begin();
}

}  // namespace

Prior::Prior(const std::vector<ParameterSpec>& unknown, const std::vector<PriorGroupSpec>& groups) {
  for (std::size_t j = 0; j < unknown.size(); ++j) {
    bounds_.push_back(unknown[j].bounds);
    addMarginal(static_cast<Index>(j), unknown[j].prior);
  }
  correlation_ = MatrixXd::Identity(static_cast<Index>(normals_.size()), static_cast<Index>(normals_.size()));
  for (const PriorGroupSpec& group : groups) {
    join(unknown, group);
  }
  const linalg::Cholesky cholesky = linalg::calcCholesky(correlation_);
  if (!normals_.empty() && !cholesky.positive_definite) {
    throw ExperimentError(groups.empty() ? SourceLocation{} : groups.front().where, "",
                          "must have a covariance that is positive definite, together with the other priors");
  }
  lower_ = normals_.empty() ? correlation_ : cholesky.lower;
}

void Prior::addMarginal(Index parameter, const std::optional<PriorSpec>& prior) {
  if (!prior) {
    return;
  }
  if (const auto* normal = std::get_if<NormalPrior>(&prior->kind)) {
    normals_.push_back({parameter, false, normal->mean, normal->stddev});
  } else if (const auto* lognormal = std::get_if<LognormalPrior>(&prior->kind)) {
    normals_.push_back({parameter, true, std::log(lognormal->median), std::log(lognormal->factor)});
  } else {
    others_.push_back({parameter, *prior});
  }
}

void Prior::join(const std::vector<ParameterSpec>& unknown, const PriorGroupSpec& group) {
  const auto find_normal = [&](const Name& name) {
    const Index parameter = findParameter(unknown, name);
    const auto found = std::find_if(normals_.begin(), normals_.end(),
                                    [&](const Normal& normal) { return normal.parameter == parameter; });
    if (found == normals_.end()) {
      throw ExperimentError(name.where, name.text,
                            "must be an unknown parameter with a normal or lognormal prior to be correlated");
    }
    return static_cast<Index>(found - normals_.begin());
  };
  if (const auto* pair = std::get_if<CorrelatedPriors>(&group.kind)) {
    const Index a = find_normal(pair->names[0]), b = find_normal(pair->names[1]);
    correlation_(a, b) = correlation_(b, a) = pair->correlation;
  }
  if (const auto* joint = std::get_if<JointNormalPrior>(&group.kind)) {
    const auto n = static_cast<Index>(joint->names.size()), before = static_cast<Index>(normals_.size());
    const MatrixXd covariance = Eigen::Map<const MatrixXd>(joint->covariance.data(), n, n);
    for (Index k = 0; k < n; ++k) {
      const Name& name = joint->names[static_cast<std::size_t>(k)];
      const Index parameter = findParameter(unknown, name);
      if (parameter < 0 || unknown[static_cast<std::size_t>(parameter)].prior || !(covariance(k, k) > 0.0)) {
        throw ExperimentError(
            name.where, name.text,
            "must be an unknown parameter without a prior of its own, with a variance above 0");
      }
      normals_.push_back(
          {parameter, false, joint->mean[static_cast<std::size_t>(k)], std::sqrt(covariance(k, k))});
    }
    MatrixXd larger = MatrixXd::Identity(before + n, before + n);
    larger.topLeftCorner(before, before) = correlation_;
    const VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
    larger.bottomRightCorner(n, n) = scale.asDiagonal() * covariance * scale.asDiagonal();
    correlation_ = larger;
  }
}

VectorXd Prior::standardize(const VectorXd& x) const {
  VectorXd z(static_cast<Index>(normals_.size()));
  for (Index k = 0; k < z.size(); ++k) {
    const Normal& normal = normals_[static_cast<std::size_t>(k)];
    z[k] = normal.standardize(x[normal.parameter]);
  }
  return z;
}

double Prior::calcLogDensity(const VectorXd& x) const {
  double log_density = 0.0;
  if (!normals_.empty()) {
    log_density -= 0.5 * linalg::solveLower(lower_, standardize(x)).squaredNorm();
  }
  for (const Normal& normal : normals_) {
    log_density -= normal.of_logarithm ? std::log(x[normal.parameter]) : 0.0;
  }
  for (const Other& other : others_) {
    log_density +=
        calcLogMarginal(other.prior, bounds_[static_cast<std::size_t>(other.parameter)], x[other.parameter]);
  }
  return log_density;
}

PriorMisfit Prior::calcMisfit(const VectorXd& x) const {
  PriorMisfit prior{0.0, VectorXd::Zero(x.size()), MatrixXd::Zero(x.size(), x.size())};
  if (!normals_.empty()) {
    const auto n = static_cast<Index>(normals_.size());
    MatrixXd slopes = MatrixXd::Zero(n, x.size());
    for (Index k = 0; k < n; ++k) {
      const Normal& normal = normals_[static_cast<std::size_t>(k)];
      slopes(k, normal.parameter) = normal.calcSlope(x[normal.parameter]);
    }
    const VectorXd residual = linalg::solveLower(lower_, standardize(x));
    slopes = linalg::solveLower(lower_, slopes);
    prior.misfit = residual.squaredNorm();
    prior.descent = -slopes.transpose() * residual;
    prior.information = slopes.transpose() * slopes;
  }
  for (const Other& other : others_) {
    const Index j = other.parameter;
    const MarginalMisfit marginal =
        calcMarginalMisfit(other.prior, bounds_[static_cast<std::size_t>(j)], x[j]);
    prior.misfit += marginal.misfit;
    prior.descent[j] += marginal.descent;
    prior.information(j, j) += marginal.information;
  }
  return prior;
}

Prior::Conditional Prior::condition(Index k, const VectorXd& independent) const {
  const Normal& normal = normals_[static_cast<std::size_t>(k)];
  const Bounds& bounds = bounds_[static_cast<std::size_t>(normal.parameter)];
  const double mean = lower_.row(k).head(k).dot(independent.head(k)), spread = lower_(k, k);
  return {(normal.standardize(bounds.lower) - mean) / spread,
          (normal.standardize(bounds.upper) - mean) / spread, mean, spread};
}

VectorXd Prior::drawIndependent(const VectorXd& unit) const {
  VectorXd independent(static_cast<Index>(normals_.size()));
  for (Index k = 0; k < independent.size(); ++k) {
    const Conditional given = condition(k, independent);
    independent[k] =
        calcNormalQuantile(given.lower, given.upper, unit[normals_[static_cast<std::size_t>(k)].parameter]);
  }
  return independent;
}

VectorXd Prior::calcPoint(const VectorXd& unit) const {
  VectorXd x(unit.size());
  for (Index j = 0; j < unit.size(); ++j) {
    const Bounds& bounds = bounds_[static_cast<std::size_t>(j)];
    x[j] = bounds.lower + unit[j] * (bounds.upper - bounds.lower);
  }
  for (const Other& other : others_) {
    x[other.parameter] = calcMarginalQuantile(other.prior, bounds_[static_cast<std::size_t>(other.parameter)],
                                              unit[other.parameter]);
  }
  const VectorXd independent = drawIndependent(unit);
  for (Index k = 0; k < independent.size(); ++k) {
    const Normal& normal = normals_[static_cast<std::size_t>(k)];
    const Bounds& bounds = bounds_[static_cast<std::size_t>(normal.parameter)];
    const Conditional given = condition(k, independent);
    const double value = normal.mean + normal.stddev * (given.mean + given.spread * independent[k]);
    x[normal.parameter] =
        std::clamp(normal.of_logarithm ? std::exp(value) : value, bounds.lower, bounds.upper);
  }
  return x;
}

double Prior::calcShareWithin(const VectorXd& unit) const {
  const VectorXd independent = drawIndependent(unit);
  double share = 1.0;
  for (Index k = 0; k < independent.size(); ++k) {
    if (lower_.row(k).head(k).any()) {
      const Conditional given = condition(k, independent);
      share *= calcNormalShare(given.lower, given.upper);
    }
  }
  return share;
}

MatrixXd Prior::listQuantiles() const {
  constexpr Index kPoints = 512;  // those of a normal distribution have 0.2 % less spread
  Prior alone = *this;
  alone.lower_.setIdentity();
  MatrixXd points(static_cast<Index>(bounds_.size()), kPoints);
  for (Index i = 0; i < kPoints; ++i) {
    points.col(i) =
        alone.calcPoint(VectorXd::Constant(points.rows(), (static_cast<double>(i) + 0.5) / kPoints));
  }
  return points;
}

VectorXd Prior::calcMeans() const {
  return listQuantiles().rowwise().mean();
}

VectorXd Prior::calcStddevs() const {
  return calcRowStddevs(listQuantiles());
}

bool Prior::isOfLogarithm(Index parameter) const {
  const auto is_normal = [&](const Normal& one) { return one.parameter == parameter && one.of_logarithm; };
  const auto is_other = [&](const Other& one) {
    return one.parameter == parameter && std::holds_alternative<LogUniformPrior>(one.prior.kind);
  };
  return std::any_of(normals_.begin(), normals_.end(), is_normal) ||
         std::any_of(others_.begin(), others_.end(), is_other);
}

bool Prior::hasRange(Index parameter) const {
  return std::any_of(normals_.begin(), normals_.end(),
                     [&](const Normal& one) { return one.parameter == parameter; }) ||
         std::any_of(others_.begin(), others_.end(),
                     [&](const Other& one) { return one.parameter == parameter && one.prior.hasRange(); });
}

NormalForm Prior::calcNormalForm() const {
  const MatrixXd quantiles = listQuantiles();
  const VectorXd mean = quantiles.rowwise().mean(), stddev = calcRowStddevs(quantiles);
  const auto n = static_cast<Index>(normals_.size()), all = n + static_cast<Index>(others_.size());
  NormalForm form{{}, VectorXd(all), VectorXd(all), MatrixXd::Identity(all, all)};
  form.correlation.topLeftCorner(n, n) = correlation_;
  for (const Normal& normal : normals_) {
    const auto k = static_cast<Index>(form.parameters.size());
    form.mean[k] = normal.of_logarithm ? mean[normal.parameter] : normal.mean;
    form.stddev[k] = normal.of_logarithm ? stddev[normal.parameter] : normal.stddev;
    form.parameters.push_back(normal.parameter);
  }
  for (const Other& other : others_) {
    const auto k = static_cast<Index>(form.parameters.size());
    form.mean[k] = mean[other.parameter];
    form.stddev[k] = stddev[other.parameter];
    form.parameters.push_back(other.parameter);
  }
  return form;
}

std::vector<MatrixXd> Prior::calcInformation(const MatrixXd& points) const {
  std::vector<MatrixXd> informations;
  if (isUniform()) {
    return informations;
  }
  constexpr double kUniform = 12.0;  // 1 / variance over a unit width
  const Index u = points.rows(), n = static_cast<Index>(normals_.size());
  Eigen::Array<bool, Eigen::Dynamic, 1> of_logarithm(u);
  MatrixXd quantiles = listQuantiles();
  VectorXd widths(u);
  for (Index j = 0; j < u; ++j) {
    const Bounds& bounds = bounds_[static_cast<std::size_t>(j)];
    widths[j] = bounds.upper - bounds.lower;
    of_logarithm[j] = isOfLogarithm(j);
    if (of_logarithm[j]) {
      quantiles.row(j) = quantiles.row(j).array().log();
    }
  }
  const VectorXd scales = widths.cwiseQuotient(calcRowStddevs(quantiles));
  const MatrixXd inverse = linalg::solveCholesky(lower_, MatrixXd::Identity(n, n));
  for (const auto& x : points.colwise()) {
    const VectorXd slopes = of_logarithm.select(scales.array() / x.array(), scales.array());
    MatrixXd information = kUniform * MatrixXd::Identity(u, u);
    for (Index k = 0; k < n; ++k) {
      const Index a = normals_[static_cast<std::size_t>(k)].parameter;
      for (Index l = 0; l < n; ++l) {
        const Index b = normals_[static_cast<std::size_t>(l)].parameter;
        information(a, b) = slopes[a] * inverse(k, l) * slopes[b];
      }
    }
    for (const Other& other : others_) {
      information(other.parameter, other.parameter) = slopes[other.parameter] * slopes[other.parameter];
    }
    informations.push_back(std::move(information));
  }
  return informations;
}

}  // namespace twinmap
