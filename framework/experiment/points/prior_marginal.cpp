#include "framework/experiment/points/prior_marginal.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "framework/base/text/number_text.hpp"

namespace twinmap {

namespace {

/// s of a beta distribution; its derivatives are infinite at the bounds themselves.
double calcShare(const Bounds& bounds, double x) {
  constexpr double kNearest = 1e-9;
  return std::clamp((x - bounds.lower) / (bounds.upper - bounds.lower), kNearest, 1.0 - kNearest);
}

/// The quantile of a continuous distribution that is cut off at the bounds.
template <class Distribution>
double calcTruncatedQuantile(const Distribution& distribution, double lower, double upper,
                             double probability) {
  const double below = boost::math::cdf(distribution, lower), until = boost::math::cdf(distribution, upper);
  if (below > 0.5) {  // its upper tail keeps its digits by its complement
    const double above = boost::math::cdf(boost::math::complement(distribution, lower));
    const double beyond = boost::math::cdf(boost::math::complement(distribution, upper));
    const double tail = above - probability * (above - beyond);
    return tail > 0.0
               ? std::clamp(boost::math::quantile(boost::math::complement(distribution, tail)), lower, upper)
               : upper;
  }
  const double share = below + probability * (until - below);
  return share > 0.0 ? std::clamp(boost::math::quantile(distribution, share), lower, upper) : lower;
}

}  // namespace

double calcNormalShare(double lower, double upper) {
  const boost::math::normal_distribution<> standard;
  return lower > 0.0 ? boost::math::cdf(boost::math::complement(standard, lower)) -
                           boost::math::cdf(boost::math::complement(standard, upper))
                     : boost::math::cdf(standard, upper) - boost::math::cdf(standard, lower);
}

double calcNormalQuantile(double lower, double upper, double probability) {
  return calcTruncatedQuantile(boost::math::normal_distribution<>(), lower, upper, probability);
}

MarginalMisfit calcMarginalMisfit(const PriorSpec& prior, const Bounds& bounds, double x) {
  if (const auto* beta = std::get_if<BetaPrior>(&prior.kind)) {
    const double s = calcShare(bounds, x), width = bounds.upper - bounds.lower;
    const double a = beta->alpha - 1.0, b = beta->beta - 1.0;
    return {-2.0 * (a * std::log(s) + b * std::log1p(-s)), (a / s - b / (1.0 - s)) / width,
            (std::max(a, 0.0) / (s * s) + std::max(b, 0.0) / ((1.0 - s) * (1.0 - s))) / (width * width)};
  }
  if (const auto* student = std::get_if<StudentPrior>(&prior.kind)) {
    const double t = (x - student->location) / student->scale, n = student->degrees;
    const double weight = (n + 1.0) / (n + t * t);  // that of the same distance from a normal distribution
    return {(n + 1.0) * std::log1p(t * t / n), -weight * t / student->scale,
            weight / (student->scale * student->scale)};
  }
  return {0.0, 0.0, 0.0};
}

double calcLogMarginal(const PriorSpec& prior, const Bounds& bounds, double x) {
  const double log_jacobian =
      std::holds_alternative<LogUniformPrior>(prior.kind) ? -std::log(std::abs(x)) : 0.0;
  return -0.5 * calcMarginalMisfit(prior, bounds, x).misfit + log_jacobian;
}

double calcMarginalQuantile(const PriorSpec& prior, const Bounds& bounds, double probability) {
  if (const auto* beta = std::get_if<BetaPrior>(&prior.kind)) {
    const boost::math::beta_distribution<> distribution(beta->alpha, beta->beta);
    return bounds.lower + (bounds.upper - bounds.lower) * boost::math::quantile(distribution, probability);
  }
  if (const auto* student = std::get_if<StudentPrior>(&prior.kind)) {
    const boost::math::students_t_distribution<> distribution(student->degrees);
    const auto standardize = [&](double x) { return (x - student->location) / student->scale; };
    return student->location + student->scale * calcTruncatedQuantile(distribution, standardize(bounds.lower),
                                                                      standardize(bounds.upper), probability);
  }
  return bounds.lower * std::pow(bounds.upper / bounds.lower, probability);
}

Bounds calcPriorRange(const PriorSpec& prior) {
  constexpr double kTail = 0.5e-4, kNormal = 3.8905918864131;  // of the standard normal distribution
  if (const auto* normal = std::get_if<NormalPrior>(&prior.kind)) {
    return {normal->mean - kNormal * normal->stddev, normal->mean + kNormal * normal->stddev, {}};
  }
  if (const auto* lognormal = std::get_if<LognormalPrior>(&prior.kind)) {
    const double factor = std::pow(lognormal->factor, kNormal);
    return {lognormal->median / factor, lognormal->median * factor, {}};
  }
  const StudentPrior& student = std::get<StudentPrior>(prior.kind);
  const double reach = boost::math::quantile(
      boost::math::complement(boost::math::students_t_distribution<>(student.degrees), kTail));
  return {student.location - reach * student.scale, student.location + reach * student.scale, {}};
}

std::string shortenOfPrior(double value) {
  constexpr int kDigits = 6;
  return toShortText(value, kDigits);
}

std::string describeMarginal(const PriorSpec& prior, const Bounds& bounds) {
  if (const auto* normal = std::get_if<NormalPrior>(&prior.kind)) {
    return fmt::format("normal {} +- {}", shortenOfPrior(normal->mean), shortenOfPrior(normal->stddev));
  }
  if (const auto* lognormal = std::get_if<LognormalPrior>(&prior.kind)) {
    return fmt::format("lognormal {} within a factor of {}", shortenOfPrior(lognormal->median),
                       shortenOfPrior(lognormal->factor));
  }
  if (const auto* student = std::get_if<StudentPrior>(&prior.kind)) {
    return fmt::format("Student's t {} +- {}", shortenOfPrior(student->location),
                       shortenOfPrior(student->scale));
  }
  const std::string range =
      fmt::format("from {} to {}", shortenOfPrior(bounds.lower), shortenOfPrior(bounds.upper));
  if (const auto* beta = std::get_if<BetaPrior>(&prior.kind)) {
    return fmt::format("beta({}, {}) {}", shortenOfPrior(beta->alpha), shortenOfPrior(beta->beta), range);
  }
  return "log-uniform " + range;
}

}  // namespace twinmap
