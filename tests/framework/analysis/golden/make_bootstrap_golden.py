"""Writes bootstrap_golden.hpp: BCa intervals by scipy.stats.bootstrap. Run with scipy 1.10 or later."""
from pathlib import Path

import numpy as np
import scipy.stats

a = np.array([0.3, -1.1, 0.8, 2.9, -0.4, 0.1, -0.7, 1.6, -2.2, 0.5, 0.9, -0.2])
b = np.array([0.5, -0.6, 0.2, 1.4, -0.5, 0.3, -0.1, 0.7, -1.0, 0.6, 0.4, -0.3])


def difference(a, b, axis=-1):
    return b.std(axis=axis, ddof=1) - a.std(axis=axis, ddof=1)


def interval(paired):
    result = scipy.stats.bootstrap(
        (a, b),
        difference,
        n_resamples=400000,
        paired=paired,
        vectorized=True,
        method="BCa",
        random_state=1,
        batch=20000,
    )
    return "{%.3f, %.3f}" % (result.confidence_interval.low, result.confidence_interval.high)


def braces(numbers):
    return "{" + ", ".join(f"{x:g}" for x in numbers) + "}"


Path(__file__).with_name("bootstrap_golden.hpp").write_text(
    f"""#pragma once

#include <array>

// Made by make_bootstrap_golden.py with scipy {scipy.__version__}: 95 % BCa intervals of sd(b) - sd(a), 400000 resamples.
namespace twinmap::bootstrap_golden {{

// clang-format off
inline constexpr std::array<double, {len(a)}> kA{braces(a)};
inline constexpr std::array<double, {len(b)}> kB{braces(b)};
inline constexpr std::array<double, 2> kPaired{interval(True)};
inline constexpr std::array<double, 2> kUnpaired{interval(False)};
// clang-format on

}}  // namespace twinmap::bootstrap_golden
"""
)
