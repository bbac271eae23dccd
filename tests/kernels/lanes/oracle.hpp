#pragma once

#include <algorithm>
#include <boost/numeric/odeint/integrate/integrate_n_steps.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>
#include <functional>
#include <vector>

namespace twinmap::lanes::testing {

using State = std::vector<double>;
/// (t, x) -> x'
using Derivative = std::function<State(double, const State&)>;

/// The state at each of `times`, from x at `begin`, by Boost.Odeint's Fehlberg pair of order 8 in steps of 2
/// ms at most: for frequencies of a few Hz its error is that of rounding. The derivative may jump at the
/// events; it is told the middle of the stretch between two of them, in which it must not depend on time
/// otherwise.
inline std::vector<State> integrateTightly(const Derivative& f, State x, double begin,
                                           const std::vector<double>& times,
                                           const std::vector<double>& events) {
  namespace odeint = boost::numeric::odeint;
  std::vector<State> result;
  double t = begin;
  const auto advance = [&](double end) {
    if (end > t) {
      const double middle = 0.5 * (t + end);
      const auto system = [&](const State& at, State& rate, double) { rate = f(middle, at); };
      const int steps = static_cast<int>(std::ceil((end - t) / 2e-3));
      odeint::integrate_n_steps(odeint::runge_kutta_fehlberg78<State>(), system, x, t, (end - t) / steps,
                                steps);
      t = end;
    }
  };
  for (const double time : times) {
    for (const double event : events) {
      advance(std::min(event, time));
    }
    advance(time);
    result.push_back(x);
  }
  return result;
}

}  // namespace twinmap::lanes::testing
