#pragma once

#include <string>

#include "framework/experiment/model/parameter_spec.hpp"

namespace twinmap {

/// How much of a standard normal distribution lies between two values.
double calcNormalShare(double lower, double upper);
/// The quantile of a standard normal distribution that is cut off at both.
double calcNormalQuantile(double lower, double upper, double probability);

/// misfit, half its negative slope, half its curvature where that is positive.
struct MarginalMisfit {
  double misfit, descent, information;
};

/// Of one parameter with a log-uniform, beta or Student prior: -2 log density in the parameter; log-uniform
/// in the logarithm, where it is level.
MarginalMisfit calcMarginalMisfit(const PriorSpec& prior, const Bounds& bounds, double x);
/// log of the density in the parameter, but for a summand.
double calcLogMarginal(const PriorSpec& prior, const Bounds& bounds, double x);
double calcMarginalQuantile(const PriorSpec& prior, const Bounds& bounds, double probability);

/// The central interval of probability .9999: the bounds of a parameter that states none. Of a normal,
/// lognormal or Student prior, which have a range of their own (PriorSpec::hasRange).
Bounds calcPriorRange(const PriorSpec& prior);

/// A number as texts about priors give it, with six digits.
std::string shortenOfPrior(double value);
/// "normal 2 +- 0.1", "log-uniform from 1 to 4": a prior of any kind in words, numbers in the parameter's
/// unit.
std::string describeMarginal(const PriorSpec& prior, const Bounds& bounds);

}  // namespace twinmap
