#pragma once

#include <cstring>

#include "kernels/lanes/program/engine.hpp"
#include "kernels/lanes/program/exponential.hpp"
#include "kernels/lanes/program/trigonometric.hpp"

namespace twinmap::program {

/// Instructions on `chains` packets a slot.
template <typename P, int chains>
class InstructionLoops {
 public:
  static constexpr int kLanes = chains * PacketTraits<P>::kWidth;

  /// Nearly all runs are of sums and products: they are carried out here, without a call.
  static void run(const PlacedRun* run, const PlacedRun* end, const PlacedInstruction* next, double* slots) {
    for (; run != end; ++run) {
      const PlacedInstruction* const last = next + run->count;
      switch (run->operation) {
        case Operation::kAdd:
          binary(next, last, slots, [](P a, P b) { return a + b; });
          break;
        case Operation::kSubtract:
          binary(next, last, slots, [](P a, P b) { return a - b; });
          break;
        case Operation::kMultiply:
          binary(next, last, slots, [](P a, P b) { return a * b; });
          break;
#define TWINMAP_FUSED(kind, value)                                   \
  case Operation::k##kind:                                           \
    ternary(next, last, slots, [](P a, P b, P c) { return value; }); \
    break;
          TWINMAP_FUSED_OPERATIONS(TWINMAP_FUSED)
#undef TWINMAP_FUSED
        default:
          runRare(run->operation, next, last, slots);
      }
      next = last;
    }
  }

 private:
  using I = PlacedInstruction;

  /// The slots of an instruction; its four places are read at once.
  struct Slots {
    Slots(const I* i, double* slots) : base(reinterpret_cast<char*>(slots)) {
      static_assert(sizeof *i == sizeof places);
      std::memcpy(&places, i, sizeof places);
    }
    /// `which`: 0 target, 1 to 3 operands
    double* operator[](int which) const {
      constexpr std::uint64_t kBytes = kPlace * sizeof(double);
      return reinterpret_cast<double*>(base + kBytes * (places >> (16 * which) & 0xffff));
    }
    char* base;
    std::uint64_t places;
  };

  template <typename Function>
  static void unary(const I* i, const I* end, double* slots, const Function& function) {
    for (; i != end; ++i) {
      const Slots s(i, slots);
      for (int k = 0; k < kLanes; k += PacketTraits<P>::kWidth) {
        store<P>(s[0] + k, function(load<P>(s[1] + k)));
      }
    }
  }

  template <typename Function>
  static void binary(const I* i, const I* end, double* slots, const Function& function) {
    for (; i != end; ++i) {
      const Slots s(i, slots);
      for (int k = 0; k < kLanes; k += PacketTraits<P>::kWidth) {
        store<P>(s[0] + k, function(load<P>(s[1] + k), load<P>(s[2] + k)));
      }
    }
  }

  template <typename Function>
  static void ternary(const I* i, const I* end, double* slots, const Function& function) {
    for (; i != end; ++i) {
      const Slots s(i, slots);
      for (int k = 0; k < kLanes; k += PacketTraits<P>::kWidth) {
        store<P>(s[0] + k, function(load<P>(s[1] + k), load<P>(s[2] + k), load<P>(s[3] + k)));
      }
    }
  }

  static void sineCosine(const I* i, const I* end, double* slots) {
    for (; i != end; ++i) {
      const Slots s(i, slots);
      for (int k = 0; k < kLanes; k += PacketTraits<P>::kWidth) {
        const SineCosine<P> value = calcSineCosine(load<P>(s[1] + k));
        store<P>(s[0] + k, value.sine);
        store<P>(s[3] + k, value.cosine);
      }
    }
  }

  static P truth(Bits<P> condition) {
    return select<P>(condition, broadcast<P>(1.0), P{});
  }

  __attribute__((noinline)) static void runRare(Operation operation, const I* i, const I* end,
                                                double* slots) {
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
      TWINMAP_UNARY_OPERATIONS(TWINMAP_UNARY)
      TWINMAP_BINARY_OPERATIONS(TWINMAP_BINARY)
      TWINMAP_TERNARY_FUNCTIONS(TWINMAP_TERNARY)
#undef TWINMAP_UNARY
#undef TWINMAP_BINARY
#undef TWINMAP_TERNARY
      case Operation::kSinCos:
        return sineCosine(i, end, slots);
      default:
        __builtin_trap();
    }
  }
};

}  // namespace twinmap::program
