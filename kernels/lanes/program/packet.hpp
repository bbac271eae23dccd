#pragma once

#ifdef __x86_64__
#include <immintrin.h>
#endif

/// Registers of 4 and 8 doubles (vector types of GCC and clang: + - * / < & ?: act on every lane).
/// This header and those of the functions on packets are included by units compiled for different instruction
/// sets. So that the linker cannot take a function of one set for another, everything in them is static or
/// has a packet in its signature.
namespace twinmap::program {

using Packet4 = double __attribute__((vector_size(32)));
using Packet8 = double __attribute__((vector_size(64)));

template <typename P>
struct PacketTraits;
template <>
struct PacketTraits<Packet4> {
  static constexpr int kWidth = 4;
  using Bits = long long __attribute__((vector_size(32)));
  using Words = unsigned long long __attribute__((vector_size(32)));
};
template <>
struct PacketTraits<Packet8> {
  static constexpr int kWidth = 8;
  using Bits = long long __attribute__((vector_size(64)));
  using Words = unsigned long long __attribute__((vector_size(64)));
};

/// What a comparison gives: -1 or 0 in each lane.
template <typename P>
using Bits = typename PacketTraits<P>::Bits;
/// As many integers of 64 bits; their arithmetic wraps round.
template <typename P>
using Words = typename PacketTraits<P>::Words;

template <typename P>
P broadcast(double value) {
  return P{} + value;
}
template <typename P>
P load(const double* source) {
  return *reinterpret_cast<const P*>(source);
}
template <typename P>
void store(double* target, P value) {
  *reinterpret_cast<P*>(target) = value;
}

/// The bits of each double.
template <typename P>
Words<P> asWords(P x) {
  return reinterpret_cast<Words<P>>(x);
}
template <typename P>
P fromWords(Words<P> x) {
  return reinterpret_cast<P>(x);
}

template <typename P>
P select(Bits<P> condition, P a, P b) {
  return condition ? a : b;
}

#ifdef __AVX512F__
static inline Packet8 fma(Packet8 a, Packet8 b, Packet8 c) {
  return _mm512_fmadd_pd(a, b, c);
}
static inline Packet8 fms(Packet8 a, Packet8 b, Packet8 c) {
  return _mm512_fmsub_pd(a, b, c);
}
static inline Packet8 fnma(Packet8 a, Packet8 b, Packet8 c) {
  return _mm512_fnmadd_pd(a, b, c);
}
static inline Packet8 sqrt(Packet8 x) {
  return _mm512_sqrt_pd(x);
}
static inline Packet8 rint(Packet8 x) {
  return _mm512_roundscale_pd(x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
static inline Packet8 floor(Packet8 x) {
  return _mm512_roundscale_pd(x, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
}
static inline bool any(Bits<Packet8> x) {
  return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(x), reinterpret_cast<__m512i>(x)) != 0;
}
/// One bit a lane, from a comparison's result.
static inline unsigned toMask(Bits<Packet8> x) {
  return _mm512_movepi64_mask(reinterpret_cast<__m512i>(x));
}
#endif

#if defined(__AVX2__) && defined(__FMA__)
static inline Packet4 fma(Packet4 a, Packet4 b, Packet4 c) {
  return _mm256_fmadd_pd(a, b, c);
}
static inline Packet4 fms(Packet4 a, Packet4 b, Packet4 c) {
  return _mm256_fmsub_pd(a, b, c);
}
static inline Packet4 fnma(Packet4 a, Packet4 b, Packet4 c) {
  return _mm256_fnmadd_pd(a, b, c);
}
static inline Packet4 sqrt(Packet4 x) {
  return _mm256_sqrt_pd(x);
}
static inline Packet4 rint(Packet4 x) {
  return _mm256_round_pd(x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
static inline Packet4 floor(Packet4 x) {
  return _mm256_round_pd(x, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
}
static inline bool any(Bits<Packet4> x) {
  return _mm256_movemask_pd(reinterpret_cast<__m256d>(x)) != 0;
}
static inline unsigned toMask(Bits<Packet4> x) {
  return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(x)));
}
#else
static inline Packet4 fma(Packet4 a, Packet4 b, Packet4 c) {
  for (int i = 0; i < 4; ++i) {
    a[i] = __builtin_fma(a[i], b[i], c[i]);
  }
  return a;
}
static inline Packet4 fms(Packet4 a, Packet4 b, Packet4 c) {
  return fma(a, b, -c);
}
static inline Packet4 fnma(Packet4 a, Packet4 b, Packet4 c) {
  return fma(-a, b, c);
}
static inline Packet4 sqrt(Packet4 x) {
  for (int i = 0; i < 4; ++i) {
    x[i] = __builtin_sqrt(x[i]);
  }
  return x;
}
static inline Packet4 rint(Packet4 x) {
  for (int i = 0; i < 4; ++i) {
    x[i] = __builtin_rint(x[i]);
  }
  return x;
}
static inline Packet4 floor(Packet4 x) {
  for (int i = 0; i < 4; ++i) {
    x[i] = __builtin_floor(x[i]);
  }
  return x;
}
static inline bool any(Bits<Packet4> x) {
  return (x[0] | x[1] | x[2] | x[3]) != 0;
}
static inline unsigned toMask(Bits<Packet4> x) {
  return static_cast<unsigned>((x[0] & 1) | (x[1] & 2) | (x[2] & 4) | (x[3] & 8));
}
#endif

constexpr unsigned long long kSignBit = 0x8000000000000000ULL;

template <typename P>
P abs(P x) {
  return fromWords<P>(asWords(x) & ~kSignBit);
}
template <typename P>
P copySign(P magnitude, P sign) {
  return fromWords<P>((asWords(magnitude) & ~kSignBit) | (asWords(sign) & kSignBit));
}
/// Also of a NaN: false.
template <typename P>
Bits<P> isFinite(P x) {
  return abs(x) < broadcast<P>(__builtin_inf());
}

/// `value` with the lanes where `special` recomputed by a function of doubles: for rare arguments.
template <typename P, typename Function>
P patch(P value, Bits<P> special, P a, P b, Function function) {
  if (__builtin_expect(any(special), false)) {
    for (int i = 0; i < PacketTraits<P>::kWidth; ++i) {
      value[i] = special[i] ? function(a[i], b[i]) : value[i];
    }
  }
  return value;
}

/// c[0] + c[1] x + ... + c[n-1] x^(n-1), by Horner's rule.
template <typename P, int n>
P evaluatePolynomial(P x, const double (&c)[n]) {
  P sum = broadcast<P>(c[n - 1]);
  for (int i = n - 2; i >= 0; --i) {
    sum = fma(sum, x, broadcast<P>(c[i]));
  }
  return sum;
}

}  // namespace twinmap::program
