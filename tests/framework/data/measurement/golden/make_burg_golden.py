"""Writes burg_golden.hpp: Burg's method as in Kay (1988), Modern Spectral Estimation, section 7.5, by loops over
samples in exact rational arithmetic, so that nothing but the formula is in the numbers."""
from fractions import Fraction

SAMPLES = [2, -1, 3, 0, -4, 1, 5, -2, -3, 4, 1, -1, -5, 2, 3, -2, 0, 4, -3, -1, 2, 1, -2, 3]
ORDER = 2  # that of least BIC


def burg(x, order):
    x = [Fraction(v) for v in x]
    forward, backward = x[:], x[:]
    a, error = [], sum(v * v for v in x) / len(x)
    for m in range(1, order + 1):
        top = 2 * sum(forward[t] * backward[t - 1] for t in range(m, len(x)))
        bottom = sum(forward[t] ** 2 + backward[t - 1] ** 2 for t in range(m, len(x)))
        k = top / bottom
        a = [a[i] - k * a[m - 2 - i] for i in range(m - 1)] + [k]
        error *= 1 - k * k
        forward, backward = (
            [forward[t] - k * backward[t - 1] if t >= m else Fraction(0) for t in range(len(x))],
            [backward[t - 1] - k * forward[t] if t >= m else Fraction(0) for t in range(len(x))],
        )
    return [float(v) for v in a], float(error)


coefficients, variance = burg(SAMPLES, ORDER)
print("// Written by make_burg_golden.py")
print("#pragma once\n\nnamespace twinmap {\n")
print(f"constexpr double kBurgSamples[] = {{{', '.join(map(str, SAMPLES))}}};")
print(f"constexpr double kBurgCoefficients[] = {{{', '.join(map(repr, coefficients))}}};")
print(f"constexpr double kBurgVariance = {variance!r};")
print("\n}  // namespace twinmap")
