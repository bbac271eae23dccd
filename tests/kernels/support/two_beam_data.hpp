#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

/// The two-beam reference case (its closed-form equations of motion), as data for tests and benchmarks of the
/// kernels, which know no simulator: 200 features (100 samples of y, then of theta, every 0.05 s) with noise,
/// and the four updating parameters d_y, d_theta, k_y, k_theta.
namespace twinmap::test {

struct TwoBeamData {
  Eigen::MatrixXd features;    ///< 200 x n, divided by the noise's stddev
  Eigen::MatrixXd parameters;  ///< 4 x n
};

using TwoBeamParameters = std::array<double, 4>;
constexpr TwoBeamParameters kTwoBeamLower{0.9, 1.75e-4, 5.0, 0.027};
constexpr TwoBeamParameters kTwoBeamUpper{1.1, 2.25e-4, 15.0, 0.045};

/// The state (y, theta, y', theta') and its derivative.
using TwoBeamState = std::array<double, 4>;

inline TwoBeamState twoBeamDerivative(const TwoBeamState& state, const TwoBeamParameters& p, bool pulse) {
  constexpr double m1 = 3.3, m2 = 0.13, y_com = 0.034, z_com = 0.022, inertia = 1.3e-4, g = 9.81;
  const double c = std::cos(state[1]), s = std::sin(state[1]);
  const double a = y_com * s + z_com * c, b = y_com * c - z_com * s;
  const double force = (pulse ? 5.0 : 0.0) + m2 * b * state[3] * state[3] - p[0] * state[2] - p[2] * state[0];
  const double moment = (pulse ? 0.075 : 0.0) - p[1] * state[3] - p[3] * state[1] - m2 * g * b;
  const double m11 = m1 + m2, m12 = -m2 * a, m22 = inertia + m2 * (y_com * y_com + z_com * z_com);
  const double determinant = m11 * m22 - m12 * m12;
  return {state[2], state[3], (m22 * force - m12 * moment) / determinant,
          (m11 * moment - m12 * force) / determinant};
}

inline TwoBeamState twoBeamStep(const TwoBeamState& x, const TwoBeamParameters& p, bool pulse, double h) {
  const auto shifted = [&](const TwoBeamState& k, double factor) {
    TwoBeamState result;
    for (int i = 0; i < 4; ++i) {
      result[i] = x[i] + factor * k[i];
    }
    return result;
  };
  const TwoBeamState k1 = twoBeamDerivative(x, p, pulse);
  const TwoBeamState k2 = twoBeamDerivative(shifted(k1, h / 2), p, pulse);
  const TwoBeamState k3 = twoBeamDerivative(shifted(k2, h / 2), p, pulse);
  const TwoBeamState k4 = twoBeamDerivative(shifted(k3, h), p, pulse);
  TwoBeamState next;
  for (int i = 0; i < 4; ++i) {
    next[i] = x[i] + h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  }
  return next;
}

/// theta at rest for the centre of the bounds.
inline double twoBeamEquilibrium() {
  double theta = 0.0;
  for (int i = 0; i < 20; ++i) {
    const double c = std::cos(theta), s = std::sin(theta), weight = 0.13 * 9.81;
    theta -= (0.036 * theta + weight * (0.034 * c - 0.022 * s)) / (0.036 - weight * (0.034 * s + 0.022 * c));
  }
  return theta;
}

/// n samples of the box: a Latin hypercube if `stratified`, else uniform. Noise: 5e-5 m and 0.015 rad.
inline TwoBeamData makeTwoBeamData(int n, std::uint64_t seed, bool stratified = true) {
  std::mt19937_64 engine(seed);
  const auto uniform = [&] { return (static_cast<double>(engine() >> 11) + 0.5) * 0x1p-53; };
  const auto normal = [&] { return std::sqrt(-2 * std::log(uniform())) * std::cos(2 * M_PI * uniform()); };
  TwoBeamData data{Eigen::MatrixXd(200, n), Eigen::MatrixXd(4, n)};
  for (int k = 0; k < 4; ++k) {
    std::vector<int> cells(n);
    std::iota(cells.begin(), cells.end(), 0);
    for (int i = n - 1; i > 0; --i) {
      std::swap(cells[i], cells[static_cast<int>(uniform() * (i + 1))]);
    }
    for (int i = 0; i < n; ++i) {
      const double u = stratified ? (cells[i] + uniform()) / n : uniform();
      data.parameters(k, i) = kTwoBeamLower[k] + u * (kTwoBeamUpper[k] - kTwoBeamLower[k]);
    }
  }
  const double rest = twoBeamEquilibrium();
  constexpr int kSteps = 16;  // of 3.1 ms between samples: errors far below the noise
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector4d column = data.parameters.col(i);
    const TwoBeamParameters p{column(0), column(1), column(2), column(3)};
    TwoBeamState state{0.0, rest, 0.0, 0.0};
    for (int sample = 0; sample < 100; ++sample) {
      const bool pulse = sample == 4;  // 0.2 s <= t < 0.25 s
      for (int step = 0; step < kSteps; ++step) {
        state = twoBeamStep(state, p, pulse, 0.05 / kSteps);
      }
      data.features(sample, i) = state[0] / 5e-5 + normal();
      data.features(100 + sample, i) = state[1] / 0.015 + normal();
    }
  }
  return data;
}

/// Every feature to zero mean and unit variance.
inline Eigen::MatrixXd zScored(const Eigen::MatrixXd& features) {
  Eigen::MatrixXd scored = features.colwise() - features.rowwise().mean();
  for (Eigen::Index f = 0; f < scored.rows(); ++f) {
    scored.row(f) /= std::sqrt(scored.row(f).squaredNorm() / static_cast<double>(scored.cols()));
  }
  return scored;
}

}  // namespace twinmap::test
