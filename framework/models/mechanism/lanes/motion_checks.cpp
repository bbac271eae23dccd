#include "framework/models/mechanism/lanes/motion_checks.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/mechanism/sampled_keys.hpp"

namespace twinmap {
namespace {

struct SignalJump {
  double time = 0.0, size = 0.0;
};

/// The largest jump of one signal between two phases, but for rounding; size 0: none.
class JumpFinder {
 public:
  JumpFinder(ModelContext& context, std::size_t signal)
      : excitation_(context.excitation), signal_(signal), values_(context.model.excitation.size()) {
    times_ = excitation_.calcEventTimes(context.model.simulation.duration);
    times_.push_back(context.model.simulation.duration);
  }

  SignalJump find() {
    constexpr double kNoJump = 1e-9;  // of the largest value, left by rounding
    excitation_.mute();
    excitation_.beginPhase(0.0);
    SignalJump worst;
    double begin = 0.0, largest = 0.0;
    for (const double end : times_) {
      for (const double part : {0.0, 0.11, 0.23, 0.38, 0.5, 0.64, 0.79, 1.0}) {
        largest = std::max(largest, std::abs(calc(begin + part * (end - begin))));
      }
      const double before = calc(end);
      if (end < times_.back()) {
        excitation_.beginPhase(end);
        const double size = std::abs(calc(end) - before);
        worst = size > worst.size ? SignalJump{end, size} : worst;
      }
      begin = end;
    }
    excitation_.mute();
    return worst.size > kNoJump * largest ? worst : SignalJump{};
  }

 private:
  double calc(double t) {
    excitation_.calcValues(t, values_);
    return values_[signal_];
  }

  Excitation& excitation_;
  std::size_t signal_;
  std::vector<double> times_, values_;
};

}  // namespace

void requireSteadyMotions(ModelContext& context) {
  if (context.model.system.motions.empty()) {
    return;
  }
  context.numbers.update(calcBoxCenter(collectSampled(context.model)));
  context.excitation.update(context.numbers);
  for (const MotionSpec& motion : context.model.system.motions) {
    const auto signal = static_cast<std::size_t>(findSignal(context.model, motion.follows));
    const SignalJump jump = JumpFinder(context, signal).find();
    if (jump.size > 0.0) {
      throw ExperimentError(
          motion.follows.where, motion.follows.text,
          fmt::format("cannot prescribe a motion: it jumps by {:.3g} at {:.6g} s; let what it "
                      "is made of begin and end at 0, or hold on to the end",
                      jump.size, jump.time));
    }
  }
}

}  // namespace twinmap
