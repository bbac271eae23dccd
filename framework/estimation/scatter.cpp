#include "framework/estimation/scatter.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>

namespace twinmap {

using Eigen::VectorXd;

namespace {

IntervalFactor calcStudentFactor(double degrees) {
  const boost::math::students_t_distribution<> few(degrees);
  return {boost::math::quantile(few, 0.75), boost::math::quantile(few, 0.975)};
}

}  // namespace

double ScatterEstimate::calcStddevOfNext() const {
  return std::hypot(stddev, scatter);
}

IntervalFactor ScatterEstimate::calcFactor() const {
  return calcStudentFactor(degrees);
}

double ScatterEstimate::widen(double own) const {
  return std::hypot(own, scatter);
}

IntervalFactor ScatterEstimate::calcFactor(double own) const {
  const double share = scatter / widen(own);
  return share > 0.0 ? calcStudentFactor(degrees / std::pow(share, 4)) : IntervalFactor();
}

ScatterEstimate combineScattered(const VectorXd& values, const VectorXd& stddevs) {
  const auto degrees = static_cast<double>(values.size() - 1);
  ScatterEstimate estimate;
  estimate.degrees = static_cast<int>(values.size() - 1);
  VectorXd weights;
  const auto calcSpread = [&](double variance) {  // about the weighted mean: Cochran's Q
    weights = (stddevs.array().square() + variance).inverse();
    estimate.mean = weights.dot(values) / weights.sum();
    return weights.dot((values.array() - estimate.mean).square().matrix());
  };
  const double stated = calcSpread(0.0);
  estimate.ratio = std::sqrt(stated / degrees);
  if (stated > degrees) {
    const auto excess = [&](double variance) { return calcSpread(variance) - degrees; };
    const double all = (values.array() - values.mean()).square().sum();
    const auto [low, high] =
        boost::math::tools::bisect(excess, 0.0, all, boost::math::tools::eps_tolerance<double>());
    estimate.scatter = std::sqrt(0.5 * (low + high));
  }
  const double spread = calcSpread(estimate.scatter * estimate.scatter) / degrees;
  // never narrower than the stated standard deviations allow (Röver, Knapp and Friede 2015)
  estimate.stddev = std::sqrt(std::max(1.0, spread) / weights.sum());
  return estimate;
}

double calcScatterPValue(const ScatterEstimate& scatter) {
  const boost::math::chi_squared distribution(scatter.degrees);
  return boost::math::cdf(
      boost::math::complement(distribution, scatter.degrees * scatter.ratio * scatter.ratio));
}

}  // namespace twinmap
