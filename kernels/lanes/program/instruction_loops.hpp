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
#define TWINMAP_UNARY(kind, function, rule, value, slope) \
  case Operation::k##kind:                                \
    return unary(i, end, slots, [](P a) { return value; });
#define TWINMAP_BINARY(kind, function, commutes, rule, value, tangent) \
  case Operation::k##kind:                                             \
    return binary(i, end, slots, [](P a, P b) { return value; });
#define TWINMAP_TERNARY(kind, function, rule, value, tangent) \
  case Operation::k##kind:                                    \
    return ternary(i, end, slots, [](P a, P b, P c) { return value; });
#define TWINMAP_FUSED(kind, value) \
  case Operation::k##kind:         \
    return ternary(i, end, slots, [](P a, P b, P c) { return value; });
      TWINMAP_UNARY_OPERATIONS(TWINMAP_UNARY)
      TWINMAP_BINARY_OPERATIONS(TWINMAP_BINARY)
      TWINMAP_TERNARY_FUNCTIONS(TWINMAP_TERNARY)
      TWINMAP_FUSED_OPERATIONS(TWINMAP_FUSED)
#undef TWINMAP_UNARY
#undef TWINMAP_BINARY
#undef TWINMAP_TERNARY
#undef TWINMAP_FUSED
      case Operation::kSinCos:
        return sineCosine(i, end, slots);
      default:
        __builtin_trap();
    }
  }
};

}  // namespace twinmap::program
