#pragma once

#include <algorithm>
#include <cmath>

/// The functions of Symbol that doubles lack, and those of std under one name with them: a template over the
/// scalar says `using namespace twinmap::program::real;` and calls sin(x), less(a, b), select(c, a, b) for
/// either.
namespace twinmap::program::real {

using std::abs;
using std::acos;
using std::acosh;
using std::asin;
using std::asinh;
using std::atan;
using std::atan2;
using std::atanh;
using std::cos;
using std::cosh;
using std::exp;
using std::floor;
using std::log;
using std::log10;
using std::log2;
using std::pow;
using std::rint;
using std::sin;
using std::sinh;
using std::sqrt;
using std::tan;
using std::tanh;

inline double min(double a, double b) {
  return std::fmin(a, b);
}
inline double max(double a, double b) {
  return std::fmax(a, b);
}
inline double sign(double x) {
  return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : x;
}
inline double less(double a, double b) {
  return a < b ? 1.0 : 0.0;
}
inline double lessOrEqual(double a, double b) {
  return a <= b ? 1.0 : 0.0;
}
inline double equal(double a, double b) {
  return a == b ? 1.0 : 0.0;
}
inline double notEqual(double a, double b) {
  return a != b ? 1.0 : 0.0;
}
inline double both(double a, double b) {
  return a != 0.0 && b != 0.0 ? 1.0 : 0.0;
}
inline double either(double a, double b) {
  return a != 0.0 || b != 0.0 ? 1.0 : 0.0;
}
inline double select(double condition, double a, double b) {
  return condition != 0.0 ? a : b;
}

}  // namespace twinmap::program::real
