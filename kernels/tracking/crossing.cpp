#include "kernels/tracking/crossing.hpp"

#include <array>
#include <cmath>

namespace twinmap::tracking {
namespace {

/// Of a standard normal variable: five places, exact to the ninth power.
constexpr std::array<double, 5> kPlaces{-2.8569700138728056, -1.3556261799742659, 0.0, 1.3556261799742659,
                                        2.8569700138728056};
constexpr std::array<double, 5> kWeights{0.011257411327720689, 0.22207592200561266, 0.53333333333333333,
                                         0.22207592200561266, 0.011257411327720689};

double calcNormal(double x) {
  constexpr double kRootHalf = 0.70710678118654752;
  return 0.5 * std::erfc(-x * kRootHalf);
}

/// What passes and comes back: the second term of the passage. b: distance, m: speed towards the limit.
double calcReturned(double b, double m, double q, double time) {
  const double spread = std::sqrt(q * time);
  if (b <= 0.0) {
    return calcNormal((b - m * time) / spread);
  }
  const double tail = calcNormal(-(b + m * time) / spread);
  return tail > 0.0 ? std::fmin(1.0, std::exp(2.0 * m * b / q) * tail) : 0.0;
}

}  // namespace

double calcPassed(const Outlook& outlook, double limit, bool is_below, double time) {
  const double sign = is_below ? 1.0 : -1.0;
  const double distance = sign * (outlook.mean - limit), speed = -sign * outlook.slope;
  double passed = 0.0;
  for (std::size_t g = 0; g < kPlaces.size(); ++g) {
    const double q = outlook.rate * std::exp(kPlaces[g] * outlook.rate_log_stddev);
    const double of_slope = outlook.slope_stddev * time;
    const double variance = outlook.stddev * outlook.stddev + of_slope * of_slope + q * time;
    double one = variance > 0.0 ? calcNormal((speed * time - distance) / std::sqrt(variance))
                                : (speed * time >= distance ? 1.0 : 0.0);
    for (std::size_t i = 0; q * time > 0.0 && i < kPlaces.size(); ++i) {
      for (std::size_t k = 0; k < kPlaces.size(); ++k) {
        one += kWeights[i] * kWeights[k] *
               calcReturned(distance + kPlaces[i] * outlook.stddev, speed + kPlaces[k] * outlook.slope_stddev,
                            q, time);
      }
    }
    passed += kWeights[g] * std::fmin(one, 1.0);
  }
  return passed;
}

namespace {

double findQuantile(const Outlook& outlook, double limit, bool is_below, double longest, double probability) {
  constexpr int kHalvings = 40;
  if (calcPassed(outlook, limit, is_below, longest) < probability) {
    return Crossing::kNever;
  }
  double before = 0.0, after = longest;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (before + after);
    (calcPassed(outlook, limit, is_below, middle) < probability ? before : after) = middle;
  }
  return after;
}

}  // namespace

Crossing findCrossing(const Outlook& outlook, double limit, bool is_below, double longest) {
  constexpr double kTail = 0.025;
  const auto find = [&](double probability) {
    return findQuantile(outlook, limit, is_below, longest, probability);
  };
  return {find(0.5), find(kTail), find(1.0 - kTail)};
}

}  // namespace twinmap::tracking
