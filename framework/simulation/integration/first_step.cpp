#include "framework/simulation/integration/first_step.hpp"

#include <algorithm>
#include <cmath>

namespace twinmap {
namespace {

using State = OdeProblem::State;

/// Root mean square of values / (absolute + relative |x|).
double calcScaledNorm(const State& values, const State& x, const IntegrationOptions& options) {
  double sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double scale = options.absolute_tolerance + options.relative_tolerance * std::abs(x[i]);
    sum += values[i] * values[i] / (scale * scale);
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(values.size(), 1)));
}

State addScaled(const State& x, double factor, const State& direction) {
  State sum(x);
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum[i] += factor * direction[i];
  }
  return sum;
}

}  // namespace

bool isFinite(const State& x) {
  return std::all_of(x.begin(), x.end(), [](double value) { return std::isfinite(value); });
}

double calcFirstStep(OdeProblem& problem, double t, const State& x, const State& dxdt, double length,
                     const IntegrationOptions& options) {
  const double d0 = calcScaledNorm(x, x, options);
  const double d1 = calcScaledNorm(dxdt, x, options);
  const double h0 = std::min(d0 < 1e-5 || d1 < 1e-5 ? 1e-6 : 0.01 * d0 / d1, length);
  State dxdt_next(x.size());
  problem.calcDerivative(t + h0, addScaled(x, h0, dxdt), dxdt_next);
  const double d2 = calcScaledNorm(addScaled(dxdt_next, -1.0, dxdt), x, options) / h0;
  const double largest = std::max(d1, d2);
  const double h1 = largest <= 1e-15 ? std::max(1e-6, 1e-3 * h0) : std::pow(0.01 / largest, 0.2);
  const double h = std::min(100.0 * h0, h1);
  return std::isfinite(h) ? h : h0;
}

}  // namespace twinmap
