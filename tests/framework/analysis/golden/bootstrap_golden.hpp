#pragma once

#include <array>

// Made by make_bootstrap_golden.py with scipy 1.10.1: 95 % BCa intervals of sd(b) - sd(a), 400000 resamples.
namespace twinmap::bootstrap_golden {

// clang-format off
inline constexpr std::array<double, 12> kA{0.3, -1.1, 0.8, 2.9, -0.4, 0.1, -0.7, 1.6, -2.2, 0.5, 0.9, -0.2};
inline constexpr std::array<double, 12> kB{0.5, -0.6, 0.2, 1.4, -0.5, 0.3, -0.1, 0.7, -1, 0.6, 0.4, -0.3};
inline constexpr std::array<double, 2> kPaired{-1.032, -0.367};
inline constexpr std::array<double, 2> kUnpaired{-1.347, -0.126};
// clang-format on

}  // namespace twinmap::bootstrap_golden
