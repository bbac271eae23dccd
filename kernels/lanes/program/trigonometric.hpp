#pragma once

#include "kernels/lanes/program/packet.hpp"

/// Sine, cosine and their inverses on packets. Polynomials from fdlibm (Sun Microsystems 1993). Errors in
/// units in the last place, as in exponential.hpp: sin and cos 1.5, tan 3, asin, acos and atan 1, atan2 2.
namespace twinmap::program {

constexpr double kHalfPi = 0x1.921fb54442d18p0;
constexpr double kHalfPiLow = 0x1.1a62633145c07p-54;  ///< what kHalfPi lacks

template <typename P>
struct SineCosine {
  P sine, cosine;
};

/// For |x| <= pi / 4.
template <typename P>
P calcSineKernel(P x, P z) {
  static constexpr double kSeries[] = {-1.66666666666666324348e-01, 8.33333333332248946124e-03,
                                       -1.98412698298579493134e-04, 2.75573137070700676789e-06,
                                       -2.50507602534068634195e-08, 1.58969099521155010221e-10};
  return fma(x * z, evaluatePolynomial(z, kSeries), x);
}
template <typename P>
P calcCosineKernel(P z) {
  static constexpr double kSeries[] = {4.16666666666666019037e-02, -1.38888888888741095749e-03,
                                       2.48015872894767294178e-05, -2.75573143513906633035e-07,
                                       2.08757232129817482790e-09, -1.13596475577881948265e-11};
  const P half = 0.5 * z;
  const P w = 1.0 - half;
  return w + fma(z * z, evaluatePolynomial(z, kSeries), (1.0 - w) - half);
}

/// x - n pi / 2 with pi / 2 in three parts (Cody and Waite): right to half a unit for |x| <= 2^30; the C
/// library's functions beyond.
template <typename P>
SineCosine<P> calcSineCosine(P x) {
  const P magic = broadcast<P>(0x1.8p52);  // adding it rounds to an integer, which stands in the lowest bits
  const P shifted = fma(x, broadcast<P>(0x1.45f306dc9c883p-1), magic);
  const P n = shifted - magic;
  P r = fnma(n, broadcast<P>(kHalfPi), x);  // exact
  r = fnma(n, broadcast<P>(kHalfPiLow), r);
  const Words<P> sign = asWords(r) & kSignBit;  // that of -0 too
  r = fma(n, broadcast<P>(0x1.f1976b7ed8fbcp-110), r);
  const P z = r * r;
  const P sine = fromWords<P>(asWords(calcSineKernel(r, z)) | sign);
  const P cosine = calcCosineKernel(z);
  const Words<P> quadrant = asWords(shifted);
  const Bits<P> swap = (quadrant & 1) != 0;
  const Words<P> sine_sign = (quadrant & 2) << 62;
  const Words<P> cosine_sign = ((quadrant + 1) & 2) << 62;
  const P s = fromWords<P>(asWords(select<P>(swap, cosine, sine)) ^ sine_sign);
  const P c = fromWords<P>(asWords(select<P>(swap, sine, cosine)) ^ cosine_sign);
  const Bits<P> large = abs(x) > 0x1p30;
  return {patch(s, large, x, x, [](double a, double) { return __builtin_sin(a); }),
          patch(c, large, x, x, [](double a, double) { return __builtin_cos(a); })};
}

template <typename P>
P sin(P x) {
  return calcSineCosine(x).sine;
}
template <typename P>
P cos(P x) {
  return calcSineCosine(x).cosine;
}
template <typename P>
P tan(P x) {
  const SineCosine<P> value = calcSineCosine(x);
  return value.sine / value.cosine;
}

/// asin(x) = x + x R(x^2) for |x| <= 1/2.
template <typename P>
P calcArcSineRatio(P z) {
  static constexpr double kNumerator[] = {1.66666666666666657415e-01, -3.25565818622400915405e-01,
                                          2.01212532134862925881e-01, -4.00555345006794114027e-02,
                                          7.91534994289814532176e-04, 3.47933107596021167570e-05};
  static constexpr double kDenominator[] = {1.0, -2.40339491173441421878e+00, 2.02094576023350569471e+00,
                                            -6.88283971605453293030e-01, 7.70381505559019352791e-02};
  return z * evaluatePolynomial(z, kNumerator) / evaluatePolynomial(z, kDenominator);
}

/// acos(a) / 2 = asin(sqrt((1 - a) / 2)) in two parts, a >= 1/2.
template <typename P>
struct HalfArcCosine {
  P high, low;
};
template <typename P>
HalfArcCosine<P> calcHalfArcCosine(P a) {
  const P w = 0.5 * (1.0 - a);
  const P s = sqrt(w);
  const P s_low = select<P>(s > 0.0, fnma(s, s, w) / (2.0 * s), P{});
  return {s, fma(s, calcArcSineRatio(w), s_low)};
}

template <typename P>
P asin(P x) {
  const P a = abs(x);
  const P inner = fma(a, calcArcSineRatio(a * a), a);
  const HalfArcCosine<P> half = calcHalfArcCosine(a);
  const P high = kHalfPi - 2.0 * half.high;
  const P error = (kHalfPi - high) - 2.0 * half.high;
  const P outer = high + (error - 2.0 * half.low + kHalfPiLow);
  return copySign(select<P>(a < 0.5, inner, outer), x);
}

template <typename P>
P acos(P x) {
  const P a = abs(x);
  const P high = kHalfPi - x;
  const P inner = high + (((kHalfPi - high) - x) - x * calcArcSineRatio(x * x) + kHalfPiLow);
  const HalfArcCosine<P> half = calcHalfArcCosine(a);
  const P right = 2.0 * (half.high + half.low);
  const P left_high = 2.0 * (kHalfPi - half.high);
  const P left =
      left_high + ((2.0 * kHalfPi - left_high) - 2.0 * half.high - 2.0 * half.low + 2.0 * kHalfPiLow);
  return select<P>(a < 0.5, inner, select<P>(x > 0.0, right, left));
}

/// atan(x) = atan(c) + atan((x - c) / (1 + c x)) with c = 0, 1/2, 1, 3/2 or infinity.
template <typename P>
P atan(P x) {
  static constexpr double kEven[] = {3.33333333333329318027e-01, 1.42857142725034663711e-01,
                                     9.09088713343650656196e-02, 6.66107313738753120669e-02,
                                     4.97687799461593236017e-02, 1.62858201153657823623e-02};
  static constexpr double kOdd[] = {-1.99999999998764832476e-01, -1.11111104054623557880e-01,
                                    -7.69187620504482999495e-02, -5.83357013379057348645e-02,
                                    -3.65315727442169155270e-02};
  const P a = abs(x);
  P numerator = a, denominator = broadcast<P>(1.0), high = P{}, low = P{};
  const auto use = [&](double from, P n, P d, double h, double l) {
    const Bits<P> here = a >= from;
    numerator = select<P>(here, n, numerator);
    denominator = select<P>(here, d, denominator);
    high = select<P>(here, broadcast<P>(h), high);
    low = select<P>(here, broadcast<P>(l), low);
  };
  use(7.0 / 16, 2.0 * a - 1.0, 2.0 + a, 4.63647609000806093515e-01, 2.26987774529616870924e-17);
  use(11.0 / 16, a - 1.0, a + 1.0, 7.85398163397448278999e-01, 3.06161699786838301793e-17);
  use(19.0 / 16, a - 1.5, fma(a, broadcast<P>(1.5), broadcast<P>(1.0)), 9.82793723247329054082e-01,
      1.39033110312309984516e-17);
  use(39.0 / 16, broadcast<P>(-1.0), a, kHalfPi, kHalfPiLow);
  const P t = numerator / denominator;
  const P z = t * t;
  const P w = z * z;
  const P series = fma(z, evaluatePolynomial(w, kEven), w * evaluatePolynomial(w, kOdd));
  return copySign(high - ((t * series - low) - t), x);
}

/// The C library's where an argument is zero or not finite.
template <typename P>
P atan2(P y, P x) {
  const P angle = atan(abs(y / x));
  const P value = select<P>(x > 0.0, angle, 2.0 * kHalfPi - (angle - 2.0 * kHalfPiLow));
  const Bits<P> special = (x == 0.0) | (y == 0.0) | ~isFinite(x) | ~isFinite(y);
  return patch(copySign(value, y), special, y, x, [](double a, double b) { return __builtin_atan2(a, b); });
}

}  // namespace twinmap::program
