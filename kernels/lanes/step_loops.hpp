#pragma once

#include "kernels/lanes/program/exponential.hpp"
#include "kernels/lanes/step_engine.hpp"

namespace twinmap::lanes {

/// Hairer, Norsett, Wanner: Solving Ordinary Differential Equations I, table II.5.2, and d of the dense
/// output in section II.6. The weights of a stage are those of its row; those of stage 7 are the solution's.
constexpr double kTimes[8] = {0, 0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1};
constexpr double kWeights[8][7] = {
    {},
    {},
    {0, 1.0 / 5},
    {0, 3.0 / 40, 9.0 / 40},
    {0, 44.0 / 45, -56.0 / 15, 32.0 / 9},
    {0, 19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
    {0, 9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
    {0, 35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84},
};
constexpr double kErrorWeights[8] = {0,           71.0 / 57600,      0,          -71.0 / 16695,
                                     71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
constexpr double kDenseWeights[8] = {0,
                                     -12715105075.0 / 11282082432.0,
                                     0,
                                     87487479700.0 / 32700410799.0,
                                     -10690763975.0 / 1880347072.0,
                                     701980252875.0 / 199316789632.0,
                                     -1453857185.0 / 822651844.0,
                                     69997945.0 / 29380423.0};
/// The second slopes enter neither; the last ones of the error come first.
constexpr int kErrorStages[] = {1, 3, 4, 5, 6}, kDenseStages[] = {1, 3, 4, 5, 6, 7};
/// Of 0.75, 0.8, 0.85, 0.9 and 0.95 on nine mechanisms (beams, crane, oscillators, chains with and without
/// dry friction, pendula, a spatial arm), 0.85 tried fewest steps on seven; 0.9 tried 3 and 4 % fewer on the
/// other two and 2 to 8 % more on most, 0.8 up to 6 % more. It rejects 0.2 % (silverbox) to 9 % (dry
/// friction).
constexpr double kSafety = 0.85;
constexpr double kSmallestFactor = 0.1;

template <typename P, int chains>
class StepLoops {
  static constexpr int kLanes = chains * program::PacketTraits<P>::kWidth;

 public:
  static constexpr int kWidth = program::PacketTraits<P>::kWidth;

  static void prepareStage(int stage, const StepArrays& a) {
    switch (stage) {
      case 2:
        return prepare<2>(a);
      case 3:
        return prepare<3>(a);
      case 4:
        return prepare<4>(a);
      case 5:
        return prepare<5>(a);
      case 6:
        return prepare<6>(a);
      default:
        return prepare<7>(a);
    }
  }

  static void plan(const StepArrays& a) {
    for (int k = 0; k < kLanes; k += kWidth) {
      const P time = load(a.time + k), proposed = load(a.proposed + k), phase_end = load(a.phase_end + k);
      const P rest = phase_end - time;
      const program::Bits<P> is_last = 1.01 * proposed >= rest;
      const P half = 0.5 * rest;
      const P within = program::select<P>(proposed < half, proposed, half);
      const P step = program::select<P>(is_last, rest, within);
      store(a.step + k, step);
      store(a.end + k, program::select<P>(is_last, phase_end, time + step));
    }
  }

  static unsigned finish(const StepArrays& a) {
    takePivots(a, false);
    unsigned attention = 0;
    for (int k = 0; k < kLanes; k += kWidth) {
      const P error = calcError(a, k);
      store(a.error + k, error);
      attention |= program::toMask(control(a, k, error)) << k;
    }
    return attention;
  }

  static void accept(const StepArrays& a) {
    for (int k = 0; k < kLanes; k += kWidth) {
      const program::Bits<P> take = load(a.accepted + k) != 0.0;
      store(a.time + k, program::select<P>(take, load(a.end + k), load(a.time + k)));
      for (int at = k; at < a.rows * kLanes; at += kLanes) {
        store(a.state + at, program::select<P>(take, load(a.stage_state + at), load(a.state + at)));
        store(a.slopes[1] + at, program::select<P>(take, load(a.slopes[7] + at), load(a.slopes[1] + at)));
      }
    }
  }

  static void interpolate(int lane, const StepArrays& a) {
    P weights[8];
    calcDenseWeights((load(a.wanted) - broadcast(a.time[lane])) / broadcast(a.step[lane]), weights);
    for (const int j : kDenseStages) {
      weights[j] *= broadcast(a.step[lane]);
    }
    for (int row = 0; row < a.rows; ++row) {
      const int at = row * kLanes + lane;
      P sum = broadcast(a.state[at]);
      for (const int j : kDenseStages) {
        sum = program::fma(broadcast(a.slopes[j][at]), weights[j], sum);
      }
      store(a.interpolated + row * kWidth, sum);
    }
  }

  static void interpolateAll(const StepArrays& a) {
    for (int k = 0; k < kLanes; k += kWidth) {
      P weights[8];
      calcDenseWeights(load(a.fraction + k), weights);
      for (const int j : kDenseStages) {
        weights[j] *= load(a.step + k);
      }
      for (int at = k; at < a.rows * kLanes; at += kLanes) {
        P sum = load(a.state + at);
        for (const int j : kDenseStages) {
          sum = program::fma(load(a.slopes[j] + at), weights[j], sum);
        }
        store(a.interpolated + at, sum);
      }
    }
  }

 private:
  static P load(const double* source) { return program::load<P>(source); }
  static void store(double* target, P value) { program::store<P>(target, value); }
  static P broadcast(double value) { return program::broadcast<P>(value); }

  /// All slopes are taken before any state is written: where a state's rate is another state, the program
  /// leaves it in that state's own place.
  template <int stage>
  static void prepare(const StepArrays& a) {
    if (stage > 2) {
      takePivots(a, stage == 3);
      takeSlopes(a, a.slopes[stage - 1]);
    }
    for (int k = 0; k < kLanes; k += kWidth) {
      const P step = load(a.step + k);
      store(a.stage_time + k, program::fma(step, broadcast(kTimes[stage]), load(a.time + k)));
      for (int row = 0; row < a.rows; ++row) {
        const int at = row * kLanes + k;
        P sum = load(a.slopes[1] + at) * kWeights[stage][1];
        for (int j = 2; j < stage; ++j) {
          if (kWeights[stage][j] != 0.0) {
            sum = program::fma(load(a.slopes[j] + at), broadcast(kWeights[stage][j]), sum);
          }
        }
        store(a.stage_state + at, program::fma(step, sum, load(a.state + at)));
      }
    }
  }

  static void takeSlopes(const StepArrays& a, double* slopes) {
    for (int row = 0; row < a.rows; ++row) {
      for (int k = 0; k < kLanes; k += kWidth) {
        store(slopes + row * kLanes + k, load(a.derivatives[row] + k));
      }
    }
  }

  static P calcError(const StepArrays& a, int k) {
    const P step = load(a.step + k);
    P largest{}, nonfinite{};
    for (int row = 0; row < a.rows; ++row) {
      const int at = row * kLanes + k;
      const P last = load(a.derivatives[row] + k);
      store(a.slopes[7] + at, last);
      P sum = last * kErrorWeights[7];
      for (const int j : kErrorStages) {
        sum = program::fma(load(a.slopes[j] + at), broadcast(kErrorWeights[j]), sum);
      }
      const P size = program::abs(load(a.state + at)) + program::abs(step * load(a.slopes[1] + at));
      const P scale =
          program::fma(size, broadcast(a.relative_tolerance[row]), broadcast(a.absolute_tolerance[row]));
      const P error = program::abs(step * sum) / scale;
      largest = program::select<P>(error > largest, error, largest);
      const P state = load(a.stage_state + at);
      nonfinite += (state - state) + (last - last);  // 0 or NaN
    }
    return largest + nonfinite;
  }

  /// The next step from this one's error, which is of order 5; returns where attention is needed.
  static program::Bits<P> control(const StepArrays& a, int k, P error) {
    const P step = load(a.step + k), end = load(a.end + k), growth = load(a.growth + k);
    const P limited = program::select<P>(error > 1e-30, error, broadcast(1e-30));
    P factor = kSafety * program::exp(-0.2 * program::log(limited));
    factor = program::select<P>(factor > growth, growth, factor);
    factor = program::select<P>(factor > kSmallestFactor, factor, broadcast(kSmallestFactor));
    factor = program::select<P>(error == error, factor, broadcast(kSmallestFactor));
    const program::Bits<P> accepted = error <= 1.0;
    store(a.accepted + k, program::select<P>(accepted, broadcast(1.0), P{}));
    const P proposed = step * factor;
    store(a.proposed + k, proposed);
    store(a.growth + k, program::select<P>(accepted, broadcast(kLargestGrowth), broadcast(1.0)));
    const P steps = load(a.steps + k) + program::select<P>(step > 0.0, broadcast(1.0), P{});
    store(a.steps + k, steps);
    const P time = program::abs(load(a.time + k));
    const P smallest =
        kSmallestStep * program::select<P>(time > kSmallestTime, time, broadcast(kSmallestTime));
    return ~accepted | (proposed <= smallest) | (end >= load(a.phase_end + k)) |
           (end > load(a.next_output + k)) | (load(a.smallest_pivot + k) <= 0.0) |
           (steps >= load(a.next_check + k));
  }

  /// Of the stage just evaluated. A NaN is not a small pivot: it shows in the error.
  static void takePivots(const StepArrays& a, bool first) {
    for (int k = 0; k < kLanes; k += kWidth) {
      P smallest = first ? broadcast(__builtin_inf()) : load(a.smallest_pivot + k);
      for (int i = 0; i < a.pivots; ++i) {
        const P pivot = load(a.pivot_values[i] + k);
        smallest = program::select<P>(pivot < smallest, pivot, smallest);
      }
      store(a.smallest_pivot + k, smallest);
    }
  }

  /// The polynomials with which the slopes enter, fourth order; 0 at fraction 0 and the solution's weights
  /// at 1.
  static void calcDenseWeights(P fraction, P* weights) {
    const P rest = 1.0 - fraction;
    for (int j = 1; j < 8; ++j) {
      const P solution = broadcast(j < 7 ? kWeights[7][j] : 0.0);
      const P at_begin = broadcast(j == 1 ? 1.0 : 0.0) - solution;
      const P at_end = solution - broadcast(j == 7 ? 1.0 : 0.0);
      const P bent = program::fma(rest, broadcast(kDenseWeights[j]), at_end - at_begin);
      weights[j] = fraction * program::fma(rest, program::fma(fraction, bent, at_begin), solution);
    }
  }
};

}  // namespace twinmap::lanes
