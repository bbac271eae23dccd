"""Writes peaks_golden.hpp: prominences of random values by scipy.signal. Run with scipy 1.10 or later."""
from pathlib import Path

import numpy as np
import scipy.signal

values = np.round(np.cumsum(np.random.default_rng(1).normal(size=60)), 2)
tops, _ = scipy.signal.find_peaks(values)
prominences = scipy.signal.peak_prominences(values, tops)[0]


def braces(numbers):
    return "{" + ", ".join(f"{x:g}" for x in numbers) + "}"


Path(__file__).with_name("peaks_golden.hpp").write_text(
    f"""#pragma once

#include <vector>

// Made by make_peaks_golden.py with scipy {scipy.__version__}.
namespace twinmap::peaks_golden {{

// clang-format off
inline const std::vector<double> kValues{braces(values)};
inline const std::vector<int> kTops{braces(tops)};
inline const std::vector<double> kProminences{braces(prominences)};
// clang-format on

}}  // namespace twinmap::peaks_golden
"""
)
