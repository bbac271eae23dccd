#pragma once

#include <vector>

#include "kernels/lanes/problem.hpp"
#include "kernels/lanes/program/real.hpp"
#include "kernels/lanes/program/recorder.hpp"

/// A chain of equal point masses on massless rods in a plane, each angle from the vertical; parameters are
/// mass, length and gravity. Without damping, so that its energy stays.
namespace twinmap::lanes::pendulum {

/// Factor of the mass matrix's entry (i, j).
inline double countCarried(int masses, int i, int j) {
  return masses - (i > j ? i : j);
}

/// Solves A x = b by the factors L D L' of a symmetric A; pivots are D.
template <typename T>
std::vector<T> solve(std::vector<std::vector<T>> a, std::vector<T> b, std::vector<T>& pivots) {
  const std::size_t n = b.size();
  for (std::size_t j = 0; j < n; ++j) {
    const T inverse = 1.0 / a[j][j];
    pivots.push_back(a[j][j]);
    for (std::size_t i = j + 1; i < n; ++i) {
      const T factor = a[i][j] * inverse;
      for (std::size_t k = j + 1; k <= i; ++k) {
        a[i][k] -= factor * a[k][j];
      }
      b[i] -= factor * b[j];
    }
  }
  for (std::size_t j = n; j-- > 0;) {
    T sum = b[j];
    for (std::size_t i = j + 1; i < n; ++i) {
      sum -= a[i][j] * b[i];
    }
    b[j] = sum / a[j][j];
  }
  return b;
}

/// Derivatives of angles and speeds.
template <typename T>
std::vector<T> calcDerivatives(const std::vector<T>& x, const std::vector<T>& p, std::vector<T>& pivots) {
  using namespace program::real;
  const int n = static_cast<int>(x.size()) / 2;
  std::vector<std::vector<T>> matrix(n, std::vector<T>(n));
  std::vector<T> force(n);
  for (int i = 0; i < n; ++i) {
    force[i] = -countCarried(n, i, i) * p[0] * p[2] * p[1] * sin(x[i]);
    for (int j = 0; j < n; ++j) {
      const T inertia = countCarried(n, i, j) * p[0] * p[1] * p[1];
      if (j < i) {
        matrix[i][j] = inertia * cos(x[i] - x[j]);
      }
      if (j != i) {
        force[i] -= inertia * sin(x[i] - x[j]) * x[n + j] * x[n + j];
      }
    }
    matrix[i][i] = countCarried(n, i, i) * p[0] * p[1] * p[1];
  }
  const std::vector<T> acceleration = solve(matrix, force, pivots);
  std::vector<T> rates(x.begin() + n, x.end());
  rates.insert(rates.end(), acceleration.begin(), acceleration.end());
  return rates;
}

template <typename T>
T calcEnergy(const std::vector<T>& x, const std::vector<T>& p) {
  using namespace program::real;
  const int n = static_cast<int>(x.size()) / 2;
  T energy = 0.0;
  for (int i = 0; i < n; ++i) {
    energy -= countCarried(n, i, i) * p[0] * p[2] * p[1] * cos(x[i]);
    for (int j = 0; j < n; ++j) {
      energy += 0.5 * countCarried(n, i, j) * p[0] * p[1] * p[1] * cos(x[i] - x[j]) * x[n + i] * x[n + j];
    }
  }
  return energy;
}

/// Outputs are the angles and the energy.
inline Problem makeProblem(int masses, const std::vector<int>& directions = {}) {
  using program::Symbol;
  program::Recorder r;
  std::vector<Symbol> x;
  for (int i = 0; i < 2 * masses; ++i) {
    x.push_back(r.state(i));
  }
  const std::vector<Symbol> p{r.parameter(0), r.parameter(1), r.parameter(2)};
  Equations equations;
  equations.counts = {2 * masses, 3, 0};
  equations.derivatives = calcDerivatives<Symbol>(x, p, equations.pivots);
  equations.outputs.assign(x.begin(), x.begin() + masses);
  equations.outputs.push_back(calcEnergy<Symbol>(x, p));
  return lanes::makeProblem(r, equations, directions);
}

}  // namespace twinmap::lanes::pendulum
