#pragma once

#include <vector>

#include "kernels/lanes/integrator.hpp"
#include "kernels/lanes/program/real.hpp"
#include "kernels/lanes/program/recorder.hpp"

/// The reference case of Kessels et al. (2022), its equations of motion written down by hand. Parameters d_y,
/// d_theta, k_y, k_theta; states y, theta and their speeds.
namespace twinmap::lanes::two_beam {

constexpr double kForce = 5.0, kMoment = 0.075;        // N, N m
constexpr double kPulseBegin = 0.2, kPulseEnd = 0.25;  // s
constexpr double kDuration = 5.0;                      // s
constexpr double kLower[4] = {0.9, 1.75e-4, 5.0, 0.027};
constexpr double kUpper[4] = {1.1, 2.25e-4, 15.0, 0.045};

/// Derivatives of y, theta, y', theta'; `pulse` is 1 while the pulse is on.
template <typename T>
std::vector<T> calcDerivatives(const std::vector<T>& x, const std::vector<T>& p, T pulse) {
  using namespace program::real;
  const double m1 = 3.3, m2 = 0.13, y_com = 0.034, z_com = 0.022, inertia = 1.3e-4, g = 9.81;
  const T c = cos(x[1]), s = sin(x[1]);
  const T a = y_com * s + z_com * c, b = y_com * c - z_com * s;
  const double m11 = m1 + m2, m22 = inertia + m2 * (y_com * y_com + z_com * z_com);
  const T m12 = -m2 * a;
  const T r1 = kForce * pulse + m2 * b * x[3] * x[3] - p[0] * x[2] - p[2] * x[0];
  const T r2 = kMoment * pulse - p[1] * x[3] - p[3] * x[1] - m2 * g * b;
  const T inverse = 1.0 / (m11 * m22 - m12 * m12);
  return {x[2], x[3], (m22 * r1 - m12 * r2) * inverse, (m11 * r2 - m12 * r1) * inverse};
}

/// t = 0.05 i, i = 1 ... 100.
inline std::vector<double> makeTimes() {
  std::vector<double> times;
  for (int i = 1; i <= 100; ++i) {
    times.push_back(0.05 * i);
  }
  return times;
}

/// The angle of static equilibrium at the centre of the box.
inline double calcEquilibrium() {
  const double k = 0.036, m2g = 0.13 * 9.81, y_com = 0.034, z_com = 0.022;
  double theta = 0.0;
  for (int i = 0; i < 100; ++i) {
    const double f = k * theta + m2g * (y_com * std::cos(theta) - z_com * std::sin(theta));
    theta -= f / (k - m2g * (y_com * std::sin(theta) + z_com * std::cos(theta)));
  }
  return theta;
}

/// Outputs are the coordinates y and theta.
inline Problem makeProblem(const std::vector<int>& directions = {}) {
  program::Recorder r;
  const std::vector<program::Symbol> x{r.state(0), r.state(1), r.state(2), r.state(3)};
  const std::vector<program::Symbol> p{r.parameter(0), r.parameter(1), r.parameter(2), r.parameter(3)};
  Equations equations;
  equations.counts = {4, 4, 1};
  equations.derivatives = calcDerivatives<program::Symbol>(x, p, r.phaseInput(0));
  equations.outputs = {x[0], x[1]};
  return lanes::makeProblem(r, equations, directions);
}

/// A point of the box from its coordinates in [0, 1].
inline std::vector<double> makePoint(const double (&u)[4]) {
  std::vector<double> point;
  for (int j = 0; j < 4; ++j) {
    point.push_back(kLower[j] + u[j] * (kUpper[j] - kLower[j]));
  }
  return point;
}

/// The sample at a parameter point. `outputs` takes 200 values, `derivatives` 200 a direction.
inline Sample makeSample(const std::vector<double>& point, int directions, double* outputs,
                         double* derivatives) {
  Sample sample;
  sample.parameters = point;
  sample.initial.assign(4 * (1 + directions), 0.0);
  sample.initial[1] = calcEquilibrium();
  sample.phases = {{0.0, {0.0}}, {kPulseBegin, {1.0}}, {kPulseEnd, {0.0}}};
  sample.end = kDuration;
  sample.outputs = outputs;
  sample.derivatives = derivatives;
  return sample;
}

}  // namespace twinmap::lanes::two_beam
