// Written by make_burg_golden.py
#pragma once

namespace twinmap {

constexpr double kBurgSamples[] = {2,  -1, 3, 0,  -4, 1, 5,  -2, -3, 4, 1,  -1,
                                   -5, 2,  3, -2, 0,  4, -3, -1, 2,  1, -2, 3};
constexpr double kBurgCoefficients[] = {-0.4014191523284395, -0.7137509964791071};
constexpr double kBurgVariance = 3.3421050800016365;

}  // namespace twinmap
