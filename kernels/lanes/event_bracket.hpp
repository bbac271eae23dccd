#pragma once

namespace twinmap::lanes {

/// Parts of a step between which a function stops being positive; narrowed by regula falsi with halved values
/// (Illinois) and every third time by bisection, which bounds the number of tries whatever the function.
struct EventBracket {
  double low = 0.0, high = 1.0;
  double at_low = 0.0;   ///< positive; 0: not known, where an event has just been
  double at_high = 0.0;  ///< not positive
  int side = 0;          ///< of the last try: -1 low, 1 high

  double choose(int attempt) const {
    const double middle = 0.5 * (low + high);
    if (!(at_low > 0.0) || attempt % 3 == 2) {
      return middle;
    }
    const double secant = high - at_high * (high - low) / (at_high - at_low);
    return secant > low && secant < high ? secant : middle;
  }

  void update(double fraction, double value) {
    const int now = value > 0.0 ? -1 : 1;
    (now < 0 ? low : high) = fraction;
    (now < 0 ? at_low : at_high) = value;
    if (now == side) {
      (now < 0 ? at_high : at_low) *= 0.5;
    }
    side = now;
  }
};

}  // namespace twinmap::lanes
