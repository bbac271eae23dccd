#pragma once

#include <vector>

// Made by make_peaks_golden.py with scipy 1.10.1.
namespace twinmap::peaks_golden {

// clang-format off
inline const std::vector<double> kValues{0.35, 1.17, 1.5, 0.19, 1.1, 1.55, 1.01, 1.59, 1.95, 2.25, 2.28, 2.82, 2.09, 1.92, 1.44, 2.04, 2.08, 1.79, 1.01, 0.75, 0.76, 0.48, 1.78, 2.78, 0.07, -1.82, -1.99, -2.41, -2.2, -1.98, 0.13, -0.98, -1.35, 0.69, 1.33, 2, 1.48, -0.16, 0, 0.11, -1.12, -1.8, -1.87, -2.82, -2.91, -2.82, -2.78, -3.29, -2.7, -1.8, -1.48, -2.3, -1.57, -2.07, -1.19, -2.26, -1.35, -1.37, -2.62, -2.93};
inline const std::vector<int> kTops{2, 5, 11, 16, 20, 23, 30, 35, 39, 46, 50, 52, 54, 56};
inline const std::vector<double> kProminences{1.15, 0.54, 2.63, 0.64, 0.01, 2.3, 1.48, 4.41, 0.27, 0.13, 0.82, 0.5, 1.74, 0.91};
// clang-format on

}  // namespace twinmap::peaks_golden
