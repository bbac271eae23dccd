#include "framework/estimation/derived/derived_quantities.hpp"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>

#include "framework/estimation/draws.hpp"
#include "framework/estimation/interval_factor.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kNodeDistance = 0.05, kLastNode = 6.0;  // standard deviations: errors below 1e-3 of one
constexpr Index kNodes = 2 * static_cast<Index>(kLastNode / kNodeDistance) + 1;

VectorXd makeStandardNodes() {
  return VectorXd::LinSpaced(kNodes, -kLastNode, kLastNode);
}

bool isBoundTo(const Expression& expression, const DefinedNames& names) {
  const std::vector<std::string> used = getUsedNames(expression);
  return std::all_of(used.begin(), used.end(), [&](const std::string& name) { return names.contains(name); });
}

/// All corners of the unit box, for few parameters, and points within.
MatrixXd makeBoxPoints(Index parameters) {
  constexpr Index kMaxCorners = 12, kWithin = 1000;
  const Index corners = parameters <= kMaxCorners ? Index{1} << parameters : 0;
  const RandomStream random(1, RandomPurpose::kDesignPoints);
  return MatrixXd::NullaryExpr(parameters, corners + kWithin, [&](Index j, Index i) {
    return i < corners ? static_cast<double>((i >> j) & 1)
                       : random.calcUniform(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j));
  });
}

}  // namespace

DerivedQuantities::DerivedQuantities(const ExperimentSpec& experiment)
    : lower_(calcLowerBounds(experiment.model.parameters)),
      upper_(lower_ + calcWidths(experiment.model.parameters)) {
  if (experiment.derived.empty()) {
    return;
  }
  for (const ParameterSpec& parameter : experiment.model.parameters) {
    names_.define(parameter.name.text);
  }
  for (const ConstantSpec& constant : experiment.model.constants) {
    if (isBoundTo(constant.value, names_)) {
      constants_.push_back(names_.bind(constant.value));
      names_.define(constant.name.text);
    }
  }
  for (const CurveSpec& curve : experiment.model.system.curves) {
    const bool follows = std::all_of(curve.values.begin(), curve.values.end(),
                                     [this](const Expression& value) { return isBoundTo(value, names_); });
    if (follows) {
      defineCurves({curve}, names_);
    }
  }
  for (const DerivedSpec& derived : experiment.derived) {
    expressions_.push_back(names_.bind(derived.value));
    names_.define(derived.name.text);
    specs_.push_back({derived.name, {}, derived.unit, derived.description, RelativeTo::kValue, {}});
  }
  findRanges();
}

std::vector<BoundExpression> DerivedQuantities::listExpressions() const {
  std::vector<BoundExpression> all = constants_;
  all.insert(all.end(), expressions_.begin(), expressions_.end());
  return all;
}

void DerivedQuantities::findRanges() {
  const MatrixXd box = makeBoxPoints(lower_.size());
  const MatrixXd values = calcAll(((upper_ - lower_).asDiagonal() * box).colwise() + lower_);
  for (Index k = 0; k < count(); ++k) {
    ParameterSpec& spec = specs_[static_cast<std::size_t>(k)];
    const auto row = values.row(k).array();
    const auto finite = row.isFinite();
    spec.bounds.lower = finite.select(row, HUGE_VAL).minCoeff();
    spec.bounds.upper = finite.select(row, -HUGE_VAL).maxCoeff();
    const bool holds_zero = spec.bounds.lower <= 0.0 && spec.bounds.upper >= 0.0;
    spec.relative_to = holds_zero ? RelativeTo::kRange : RelativeTo::kValue;
  }
}

VectorXd DerivedQuantities::calc(const Eigen::Ref<const VectorXd>& point) const {
  return calcAll(point);
}

MatrixXd DerivedQuantities::calcAll(const MatrixXd& points) const {
  MatrixXd values(count(), points.cols());
  NamedValues<double> names = names_;
  for (Index i = 0; i < points.cols(); ++i) {
    int place = 0;
    for (; place < static_cast<int>(points.rows()); ++place) {
      names.upd(place) = points(place, i);
    }
    for (const BoundExpression& constant : constants_) {
      names.upd(place++) = names.calc(constant);
    }
    for (std::size_t k = 0; k < expressions_.size(); ++k) {
      values(static_cast<Index>(k), i) = names.upd(place++) = names.calc(expressions_[k]);
    }
  }
  return values;
}

MatrixXd DerivedQuantities::calcGradients(const VectorXd& point) const {
  const Index p = point.size();
  const VectorXd steps = kSameNumber * (upper_ - lower_);
  MatrixXd points(p, 2 * p);
  points << MatrixXd(steps.asDiagonal()), MatrixXd((-steps).asDiagonal());
  points.colwise() += point;
  const MatrixXd values = calcAll(points);
  return 0.5 * (values.leftCols(p) - values.rightCols(p)) * steps.cwiseInverse().asDiagonal();
}

VectorXd DerivedQuantities::calcAlong(Index quantity, const VectorXd& mean, const VectorXd& way) const {
  const VectorXd lowest = lower_.cwiseMin(mean), highest = upper_.cwiseMax(mean);
  MatrixXd points = way * makeStandardNodes().transpose();
  points.colwise() += mean;
  for (Index i = 0; i < points.cols(); ++i) {
    points.col(i) = points.col(i).cwiseMax(lowest).cwiseMin(highest);
  }
  return calcAll(points).row(quantity).transpose();
}

VectorXd DerivedQuantities::calcDrawn(Index quantity, const VectorXd& mean,
                                      const MatrixXd& covariance) const {
  const MatrixXd draws = drawNormal(mean, covariance.diagonal().cwiseSqrt(), calcCorrelation(covariance),
                                    kManyErrors, RandomStream(1, RandomPurpose::kEnsemble));
  VectorXd values = calcAll(draws).row(quantity).transpose();
  std::sort(values.begin(), values.end());
  // at the probabilities of the nodes
  return VectorXd::NullaryExpr(kNodes, [&, z = makeStandardNodes()](Index i) {
    const double probability = 0.5 * boost::math::erfc(-z[i] / std::sqrt(2.0));
    return values[std::min<Index>(static_cast<Index>(probability * kManyErrors), kManyErrors - 1)];
  });
}

DerivedQuantities::Nodes DerivedQuantities::calcNodes(const VectorXd& mean,
                                                      const MatrixXd& covariance) const {
  const MatrixXd gradients = calcGradients(mean);
  Nodes nodes{MatrixXd(count(), kNodes), (-0.5 * makeStandardNodes().array().square()).exp()};
  for (Index k = 0; k < count(); ++k) {
    const VectorXd carried = covariance * gradients.row(k).transpose();
    const double stddev = std::sqrt(gradients.row(k).dot(carried));
    nodes.values.row(k) = (stddev > 0.0 && std::isfinite(stddev) ? calcAlong(k, mean, carried / stddev)
                                                                 : calcDrawn(k, mean, covariance))
                              .transpose();
  }
  return nodes;
}

std::vector<ValueDistribution> DerivedQuantities::propagate(const VectorXd& mean,
                                                            const MatrixXd& covariance) const {
  const Nodes nodes = calcNodes(mean, covariance);
  std::vector<ValueDistribution> distributions;
  for (Index k = 0; k < count(); ++k) {
    distributions.emplace_back(nodes.values.row(k).transpose(), nodes.weights);
  }
  return distributions;
}

std::vector<ValueDistribution> DerivedQuantities::propagate(const Mixture& mixture) const {
  MatrixXd values(count(), mixture.countComponents() * kNodes);
  VectorXd weights(values.cols());
  for (Index c = 0; c < mixture.countComponents(); ++c) {
    const VectorXd stddev = mixture.stddevs.col(c);
    const Nodes nodes = calcNodes(
        mixture.means.col(c),
        stddev.asDiagonal() * mixture.correlations[static_cast<std::size_t>(c)] * stddev.asDiagonal());
    values.middleCols(c * kNodes, kNodes) = nodes.values;
    weights.segment(c * kNodes, kNodes) = mixture.weights[c] * nodes.weights;
  }
  std::vector<ValueDistribution> distributions;
  for (Index k = 0; k < count(); ++k) {
    distributions.emplace_back(values.row(k).transpose(), weights);
  }
  return distributions;
}

std::vector<ValueDistribution> DerivedQuantities::propagate(const Estimate& estimate) const {
  if (estimate.mixture.isGiven() || estimate.ridge.isGiven()) {
    return propagate(estimate.ridge.isGiven() ? estimate.ridge : estimate.mixture);
  }
  return propagate(estimate.mean, estimate.calcCovariance());
}

DerivedEstimate summarize(const std::vector<ValueDistribution>& distributions, double factor) {
  const auto q = static_cast<Index>(distributions.size());
  const double tail = 0.5 * boost::math::erfc(factor / std::sqrt(2.0));
  DerivedEstimate estimate{VectorXd(q), VectorXd(q), VectorXd(q), VectorXd(q)};
  for (Index k = 0; k < q; ++k) {
    const ValueDistribution& one = distributions[static_cast<std::size_t>(k)];
    estimate.mean[k] = one.getMean();
    estimate.stddev[k] = one.getStddev();
    estimate.lower95[k] = one.calcQuantile(tail);
    estimate.upper95[k] = one.calcQuantile(1.0 - tail);
  }
  return estimate;
}

IntervalFactor findLargestFactor(const Estimate& estimate) {
  IntervalFactor largest;
  for (Index p = 0; p < estimate.interval_factors.of95.rows() && !estimate.ridge.isGiven(); ++p) {
    const IntervalFactor one = estimate.interval_factors.get(p);
    largest = one.of95 > largest.of95 ? one : largest;
  }
  return largest;
}

}  // namespace twinmap
