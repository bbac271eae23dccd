#pragma once

#include "kernels/lanes/program/packet.hpp"

/// Exponential, logarithm and what follows from them, on packets. Errors in units in the last place, over the
/// whole range, are the largest seen by tests/kernels/lanes/program/elementary_test.cpp, rounded up: exp 1,
/// log, log2 and log10 0.6, pow 1.5, sinh, cosh and tanh 2.5, asinh and atanh 2, acosh 3.
namespace twinmap::program {

/// A number as the unevaluated sum of two, |low| <= ulp(high) / 2: about 106 bits.
template <typename P>
struct Extended {
  P high, low;
};

/// exp(high + low), |low| < 1e-3. 2^n from n = rint(x / ln 2), the rest by Taylor's series: |r| <= 0.347, and
/// r^14 / 14! < 4e-18. The factor 2^n is applied in two halves, so that results below 2^-1022 are rounded
/// right.
template <typename P>
P expExtended(P high, P low) {
  static constexpr double kSeries[] = {1.0 / 2,       1.0 / 6,        1.0 / 24,        1.0 / 120,
                                       1.0 / 720,     1.0 / 5040,     1.0 / 40320,     1.0 / 362880,
                                       1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800.0};
  const P magic = broadcast<P>(0x1.8p52);  // adding it rounds to an integer, which stands in the lowest bits
  P x = select<P>(high > 710.0, broadcast<P>(710.0), high);
  x = select<P>(x < -746.0, broadcast<P>(-746.0), x);
  const P shifted = fma(x, broadcast<P>(0x1.71547652b82fep0), magic);
  const P n = shifted - magic;
  P r = fnma(n, broadcast<P>(0x1.62e42fefa39efp-1), x);  // exact
  r = fnma(n, broadcast<P>(0x1.abc9e3b39803fp-56), r) + low;
  const P value = 1.0 + fma(r * r, evaluatePolynomial(r, kSeries), r);
  const P half = fma(n, broadcast<P>(0.5), magic);
  const P other = (n - (half - magic)) + magic;
  const auto calcPower = [](P k) { return fromWords<P>((asWords(k) + 1023) << 52); };
  return value * calcPower(half) * calcPower(other);
}

template <typename P>
P exp(P x) {
  return expExtended(x, P{});
}

/// log(x) to about 2^-66 of its value for finite x > 0: x = 2^k m with m in [sqrt(1/2), sqrt(2)), and
/// log(m) = 2 (s + s^3 / 3 + s^5 / 5 + ...) with s = (m - 1) / (m + 1), |s| < 0.172; the first two terms are
/// carried in extended precision, and what follows s^27 is below 1e-22 of the sum.
template <typename P>
Extended<P> calcLogExtended(P x) {
  static constexpr double kSeries[] = {2.0 / 5,  2.0 / 7,  2.0 / 9,  2.0 / 11, 2.0 / 13, 2.0 / 15,
                                       2.0 / 17, 2.0 / 19, 2.0 / 21, 2.0 / 23, 2.0 / 25, 2.0 / 27};
  const Bits<P> subnormal = x < 0x1p-1022;
  const P scaled = select<P>(subnormal, x * 0x1p54, x);
  const Words<P> shifted = asWords(scaled) + (0x3FF0000000000000ULL - 0x3FE6A09E667F3BCDULL);
  const Words<P> exponent = (shifted >> 52) & 0x7FF;
  const P biased = fromWords<P>(exponent | 0x4330000000000000ULL) - 0x1p52;
  const P k = biased - select<P>(subnormal, broadcast<P>(1077.0), broadcast<P>(1023.0));
  const P m = fromWords<P>((shifted & 0x000FFFFFFFFFFFFFULL) + 0x3FE6A09E667F3BCDULL);

  const P f = m - 1.0;
  const P sum = 2.0 + f;
  const P sum_low = (2.0 - sum) + f;
  const P inverse = 1.0 / sum;
  const P s = f * inverse;
  const P s_low = (fnma(s, sum, f) - s * sum_low) * inverse;
  const P z = s * s;
  const P z_low = fms(s, s, z) + 2.0 * s * s_low;
  const P cube = s * z;
  const P cube_low = fms(s, z, cube) + fma(s, z_low, s_low * z);
  const P third = cube * 0x1.5555555555555p-1;
  const P third_low = fms(cube, broadcast<P>(0x1.5555555555555p-1), third) +
                      fma(cube_low, broadcast<P>(0x1.5555555555555p-1), cube * 0x1.5555555555555p-55);
  const P rest = cube * z * evaluatePolynomial(z, kSeries);

  const P whole = k * 0x1.62e42fefa38p-1;  // exact: the factor has 43 bits
  const P sum1 = whole + 2.0 * s;
  const P error1 = (whole - sum1) + 2.0 * s;
  const P sum2 = sum1 + third;
  const P error2 = (sum1 - sum2) + third;
  const P low =
      error1 + (error2 + (fma(k, broadcast<P>(0x1.ef35793c7673p-45), 2.0 * s_low) + (third_low + rest)));
  const P high = sum2 + low;
  return {high, (sum2 - high) + low};
}

/// The limits of a logarithm's value: -inf at 0, NaN below, inf at inf.
template <typename P>
P limitLog(P x, P value) {
  value = select<P>(isFinite(x), value, x);
  value = select<P>(x == 0.0, broadcast<P>(-__builtin_inf()), value);
  return select<P>(x < 0.0, broadcast<P>(__builtin_nan("")), value);
}

template <typename P>
P log(P x) {
  return limitLog(x, calcLogExtended(x).high);
}

/// log(x) times a factor given in two parts; exact powers of the base give integers.
template <typename P>
P calcScaledLog(P x, double factor, double factor_low) {
  const Extended<P> value = calcLogExtended(x);
  const P high = value.high * factor;
  const P low = fms(value.high, broadcast<P>(factor), high) +
                fma(value.high, broadcast<P>(factor_low), value.low * factor);
  return limitLog(x, high + low);
}
template <typename P>
P log2(P x) {
  return calcScaledLog(x, 0x1.71547652b82fep0, 0x1.777d0ffda0d24p-56);
}
template <typename P>
P log10(P x) {
  return calcScaledLog(x, 0x1.bcb7b1526e50ep-2, 0x1.95355baaafad3p-57);
}

/// |x|^y by the extended logarithm, with the sign for an odd integer y; the C library's where x is zero or x
/// or y is not finite.
template <typename P>
P power(P x, P y) {
  const Extended<P> logarithm = calcLogExtended(abs(x));
  const P high = y * logarithm.high;
  const Bits<P> in_range = abs(high) < 800.0;
  const P low = fma(y, logarithm.low, fms(y, logarithm.high, high));
  P value = expExtended(high, select<P>(in_range, low, P{}));
  const Bits<P> integer = rint(y) == y;
  const Bits<P> odd = integer & (rint(0.5 * y) != 0.5 * y);
  value = select<P>((x < 0.0) & odd, -value, value);
  value = select<P>((x < 0.0) & ~integer, broadcast<P>(__builtin_nan("")), value);
  const Bits<P> special = (x == 0.0) | ~isFinite(x) | ~isFinite(y);
  return patch(value, special, x, y, [](double a, double b) { return __builtin_pow(a, b); });
}

/// log(1 + x), x >= -1: the rounding error of 1 + x is made good to first order.
template <typename P>
P log1p(P x) {
  const P w = 1.0 + x;
  const P error = select<P>(x < 1.0, x - (w - 1.0), 1.0 - (w - x));
  const Extended<P> value = calcLogExtended(w);
  return limitLog(w, value.high + (value.low + error / w));
}

/// x + x^3 / 3! + ... for |x| < 1; the next term is below 1e-17 of the sum.
template <typename P>
P calcSinhSeries(P x) {
  static constexpr double kSeries[] = {
      1.0 / 6,        1.0 / 120,          1.0 / 5040,         1.0 / 362880,
      1.0 / 39916800, 1.0 / 6227020800.0, 1.0 / 1307674368e3, 1.0 / 355687428096e3};
  const P z = x * x;
  return fma(x * z, evaluatePolynomial(z, kSeries), x);
}

/// (exp(a) + sign exp(-a)) / 2, a >= 0; finite as long as its value is.
template <typename P>
P calcHyperbolic(P a, double sign) {
  const Bits<P> large = a > 700.0;
  const P e = exp(select<P>(large, 0.5 * a, a));
  return select<P>(large, (0.5 * e) * e, 0.5 * e + sign * 0.5 / e);
}
template <typename P>
P sinh(P x) {
  const P a = abs(x);
  return copySign(select<P>(a < 1.0, calcSinhSeries(a), calcHyperbolic(a, -1.0)), x);
}
template <typename P>
P cosh(P x) {
  return calcHyperbolic(abs(x), 1.0);
}
template <typename P>
P tanh(P x) {
  const P a = abs(x);
  const P series = calcSinhSeries(a);
  const P small = series / sqrt(fma(series, series, broadcast<P>(1.0)));
  return copySign(select<P>(a < 1.0, small, 1.0 - 2.0 / (exp(2.0 * a) + 1.0)), x);
}

constexpr double kLargeArgument = 0x1p28;  // beyond it 1 + x^2 is x^2
constexpr double kLn2 = 0x1.62e42fefa39efp-1;

template <typename P>
P asinh(P x) {
  const P a = abs(x);
  const P moderate = log1p(a + a * a / (1.0 + sqrt(fma(a, a, broadcast<P>(1.0)))));
  return copySign(select<P>(a > kLargeArgument, log(a) + kLn2, moderate), x);
}
template <typename P>
P acosh(P x) {
  const P t = x - 1.0;
  return select<P>(x > kLargeArgument, log(x) + kLn2, log1p(t + sqrt(t * (x + 1.0))));
}
template <typename P>
P atanh(P x) {
  const P a = abs(x);
  return copySign(0.5 * log1p(2.0 * a / (1.0 - a)), x);
}

}  // namespace twinmap::program
