#pragma once

#include "kernels/lanes/program/engine.hpp"
#include "kernels/lanes/program/exponential.hpp"
#include "kernels/lanes/program/trigonometric.hpp"

namespace twinmap::program {

/// Instructions on `chains` packets a slot.
template <typename P, int chains>
class InstructionLoops {
 public:
  static constexpr int kLanes = chains * PacketTraits<P>::kWidth;

  static void run(const PlacedRun* run, const PlacedRun* end, const PlacedInstruction* next, double* slots) {
    for (; run != end; ++run) {
      const PlacedInstruction* const last = next + run->count;
      runOne(run->operation, next, last, slots);
      next = last;
    }
  }

 private:
  using I = PlacedInstruction;

  template <typename Function>
  static void unary(const I* i, const I* end, double* slots, const Function& function) {
    for (; i != end; ++i) {
      for (int k = 0; k < kLanes; k += PacketTraits<P>::kWidth) {
        store<P>(at(slots, i->target) + k, function(load<P>(at(slots, i->a) + k)));
      }
    }
  }

  template <typename Function>
  static void binary(const I* i, const I* end, double* slots, const Function& function) {
    for (; i != end; ++i) {
      for (int k = 0; k < kLanes; k += PacketTraits<P>::kWidth) {
        store<P>(at(slots, i->target) + k,
                 function(load<P>(at(slots, i->a) + k), load<P>(at(slots, i->b) + k)));
      }
    }
  }

  template <typename Function>
  static void ternary(const I* i, const I* end, double* slots, const Function& function) {
    for (; i != end; ++i) {
      for (int k = 0; k < kLanes; k += PacketTraits<P>::kWidth) {
        store<P>(at(slots, i->target) + k,
                 function(load<P>(at(slots, i->a) + k), load<P>(at(slots, i->b) + k),
                          load<P>(at(slots, i->c) + k)));
      }
    }
  }

  static void sineCosine(const I* i, const I* end, double* slots) {
    for (; i != end; ++i) {
      for (int k = 0; k < kLanes; k += PacketTraits<P>::kWidth) {
        const SineCosine<P> value = calcSineCosine(load<P>(at(slots, i->a) + k));
        store<P>(at(slots, i->target) + k, value.sine);
        store<P>(at(slots, i->c) + k, value.cosine);
      }
    }
  }

  static double* at(double* slots, int place) { return slots + kPlace * place; }
  static P truth(Bits<P> condition) { return select<P>(condition, broadcast<P>(1.0), P{}); }

  static void runOne(Operation operation, const I* i, const I* end, double* slots) {
    switch (operation) {
      case Operation::kAdd:
        return binary(i, end, slots, [](P a, P b) { return a + b; });
      case Operation::kSubtract:
        return binary(i, end, slots, [](P a, P b) { return a - b; });
      case Operation::kMultiply:
        return binary(i, end, slots, [](P a, P b) { return a * b; });
      case Operation::kDivide:
        return binary(i, end, slots, [](P a, P b) { return a / b; });
      case Operation::kNegate:
        return unary(i, end, slots, [](P a) { return -a; });
      case Operation::kMultiplyAdd:
        return ternary(i, end, slots, [](P a, P b, P c) { return fma(a, b, c); });
      case Operation::kMultiplySubtract:
        return ternary(i, end, slots, [](P a, P b, P c) { return fms(a, b, c); });
      case Operation::kNegativeMultiplyAdd:
        return ternary(i, end, slots, [](P a, P b, P c) { return fnma(a, b, c); });
      case Operation::kSinCos:
        return sineCosine(i, end, slots);
      case Operation::kSqrt:
        return unary(i, end, slots, [](P a) { return sqrt(a); });
      default:
        return callFunction(operation, i, end, slots);
    }
  }

  static void callFunction(Operation operation, const I* i, const I* end, double* slots) {
    switch (operation) {
      case Operation::kAbs:
        return unary(i, end, slots, [](P a) { return abs(a); });
      case Operation::kFloor:
        return unary(i, end, slots, [](P a) { return floor(a); });
      case Operation::kRint:
        return unary(i, end, slots, [](P a) { return rint(a); });
      case Operation::kSin:
        return unary(i, end, slots, [](P a) { return sin(a); });
      case Operation::kCos:
        return unary(i, end, slots, [](P a) { return cos(a); });
      case Operation::kTan:
        return unary(i, end, slots, [](P a) { return tan(a); });
      case Operation::kAsin:
        return unary(i, end, slots, [](P a) { return asin(a); });
      case Operation::kAcos:
        return unary(i, end, slots, [](P a) { return acos(a); });
      case Operation::kAtan:
        return unary(i, end, slots, [](P a) { return atan(a); });
      case Operation::kAtan2:
        return binary(i, end, slots, [](P a, P b) { return atan2(a, b); });
      case Operation::kExp:
        return unary(i, end, slots, [](P a) { return exp(a); });
      case Operation::kLog:
        return unary(i, end, slots, [](P a) { return log(a); });
      case Operation::kLog2:
        return unary(i, end, slots, [](P a) { return log2(a); });
      case Operation::kLog10:
        return unary(i, end, slots, [](P a) { return log10(a); });
      case Operation::kPow:
        return binary(i, end, slots, [](P a, P b) { return power(a, b); });
      case Operation::kSinh:
        return unary(i, end, slots, [](P a) { return sinh(a); });
      case Operation::kCosh:
        return unary(i, end, slots, [](P a) { return cosh(a); });
      case Operation::kTanh:
        return unary(i, end, slots, [](P a) { return tanh(a); });
      case Operation::kAsinh:
        return unary(i, end, slots, [](P a) { return asinh(a); });
      case Operation::kAcosh:
        return unary(i, end, slots, [](P a) { return acosh(a); });
      case Operation::kAtanh:
        return unary(i, end, slots, [](P a) { return atanh(a); });
      default:
        return decide(operation, i, end, slots);
    }
  }

  static void decide(Operation operation, const I* i, const I* end, double* slots) {
    switch (operation) {
      case Operation::kSign:
        return unary(i, end, slots,
                     [](P a) { return select<P>((a > 0.0) | (a < 0.0), copySign(broadcast<P>(1.0), a), a); });
      case Operation::kMin:  // a number rather than a NaN
        return binary(i, end, slots, [](P a, P b) { return select<P>((b < a) | (a != a), b, a); });
      case Operation::kMax:
        return binary(i, end, slots, [](P a, P b) { return select<P>((a < b) | (a != a), b, a); });
      case Operation::kLess:
        return binary(i, end, slots, [](P a, P b) { return truth(a < b); });
      case Operation::kLessOrEqual:
        return binary(i, end, slots, [](P a, P b) { return truth(a <= b); });
      case Operation::kEqual:
        return binary(i, end, slots, [](P a, P b) { return truth(a == b); });
      case Operation::kNotEqual:
        return binary(i, end, slots, [](P a, P b) { return truth(a != b); });
      case Operation::kAnd:
        return binary(i, end, slots, [](P a, P b) { return truth((a != 0.0) & (b != 0.0)); });
      case Operation::kOr:
        return binary(i, end, slots, [](P a, P b) { return truth((a != 0.0) | (b != 0.0)); });
      case Operation::kSelect:
        return ternary(i, end, slots, [](P a, P b, P c) { return select<P>(a != 0.0, b, c); });
      default:
        __builtin_trap();
    }
  }
};

}  // namespace twinmap::program
