// Where a phase begins, or an event happens: solutions bend or jump.
#include <algorithm>
#include <cmath>

#include "kernels/lanes/lane_packet.hpp"

namespace twinmap::lanes {

void LanePacket::doBegins() {
  const unsigned lanes = std::exchange(beginning_, 0u);
  unsigned jumping = 0;
  forEach(lanes, [&](int lane) { jumping |= lanes_[lane].getPhase().jumps ? 1u << lane : 0u; });
  restart(lanes, jumping, jumps_ ? &*jumps_ : nullptr);
  forEach(lanes, [this](int lane) { openPhase(lane); });
}

/// Where the time of what happens moves with a parameter, the states before it go on by f- dt, and those
/// behind it came by f+ dt less (saltation): s+ = dh/dy (s- + f- dt) + dh/dt dt + dh/dp - f+ dt, where
/// nothing jumps s+ = s- + f- dt - f+ dt. It costs one evaluation of f, two where the time moves. Steps keep
/// their size: a table of a thousand lines a second takes one a line. jumping: those of the lanes whose
/// states `jumps` gives.
void LanePacket::restart(unsigned lanes, unsigned jumping, program::Interpreter* jumps) {
  const unsigned moving = findMoving(lanes);
  forEach(moving, [this](int lane) { moveBy(lane, 1.0); });
  if (jumping != 0) {
    jump(jumping, *jumps);
  }
  evaluateAt(lanes);
  if (moving != 0) {
    forEach(moving, [this](int lane) { moveBy(lane, -1.0); });
    evaluateAt(moving);
  }
  forEach(lanes, [this](int lane) { beginAfter(lane); });
}

void LanePacket::jump(unsigned lanes, program::Interpreter& program) {
  forEach(lanes, [&](int lane) { prepareJump(lane, program); });
  program.calcParameters();
  program.calcPhase();
  program.calcOutputs();
  forEach(lanes, [&](int lane) {
    for (int row = 0; row < arrays_.rows; ++row) {
      arrays_.state[row * count_ + lane] = program.getOutput(row)[lane];
    }
  });
}

/// The lanes in which the time of what happens moves with a direction.
unsigned LanePacket::findMoving(unsigned lanes) const {
  unsigned moving = 0;
  for (int lane = 0; lane < count_ && directions_ > 0; ++lane) {
    const bool moves = (lanes & 1u << lane) != 0 && lanes_[lane].findJumpSlopes() != nullptr;
    moving |= moves ? 1u << lane : 0u;
  }
  return moving;
}

void LanePacket::prepareJump(int lane, program::Interpreter& program) {
  const Lane& l = lanes_[lane];
  const std::vector<double>& inputs = l.getPhase().inputs;
  const std::vector<double>* const slopes = l.findJumpSlopes();
  program.updTime()[lane] = arrays_.time[lane];
  for (int i = 0; i < parameters_; ++i) {
    program.updParameter(i)[lane] = l.sample.parameters[i];
  }
  for (int i = 0; i < phase_inputs_; ++i) {
    program.updPhaseInput(i)[lane] = inputs[i];
  }
  if (l.mode == Mode::kEvent) {
    program.updPhaseInput(events_->getEventInput())[lane] = 1.0 + l.event;
  }
  for (int row = 0; row < arrays_.rows; ++row) {
    program.updState(row)[lane] = arrays_.state[row * count_ + lane];
  }
  for (int j = 0; j < directions_; ++j) {
    program.updPhaseInput(phase_inputs_ + j)[lane] = slopes != nullptr ? (*slopes)[j] : 0.0;
  }
}

/// The slopes of some lanes at their states.
void LanePacket::evaluateAt(unsigned lanes) {
  forEach(lanes, [this](int lane) {
    arrays_.stage_time[lane] = arrays_.time[lane];
    for (int row = 0; row < arrays_.rows; ++row) {
      arrays_.stage_state[row * count_ + lane] = arrays_.state[row * count_ + lane];
    }
  });
  if (parameters_changed_) {
    interpreter_.calcParameters();
  }
  if (parameters_changed_ || phase_changed_) {
    interpreter_.calcPhase();
  }
  parameters_changed_ = phase_changed_ = false;
  interpreter_.calcOutputs();
  forEach(lanes, [this](int lane) {
    for (int row = 0; row < arrays_.rows; ++row) {
      arrays_.slopes[1][row * count_ + lane] = arrays_.derivatives[row][lane];
    }
  });
}

/// The sensitivities, along the slopes.
void LanePacket::moveBy(int lane, double sign) {
  const std::vector<double>& slopes = *lanes_[lane].findJumpSlopes();
  for (int j = 0; j < directions_; ++j) {
    for (int i = 0; i < states_; ++i) {
      const int at = i * count_ + lane;
      arrays_.state[(1 + j) * states_ * count_ + at] += sign * slopes[j] * arrays_.slopes[1][at];
    }
  }
}

void LanePacket::beginAfter(int lane) {
  Lane& l = lanes_[lane];
  double sum = 0.0;
  for (int row = 0; row < arrays_.rows; ++row) {
    const double state = arrays_.state[row * count_ + lane], slope = arrays_.slopes[1][row * count_ + lane];
    sum += (state - state) + (slope - slope);  // 0 or NaN
  }
  for (int i = 0; i < arrays_.pivots; ++i) {
    if (arrays_.pivot_values[i][lane] <= 0.0) {
      return fail(lane, Outcome::kSingular);
    }
  }
  if (std::isnan(sum)) {
    return fail(lane, Outcome::kNonFinite);
  }
  const bool is_event = l.mode == Mode::kEvent;
  if (arrays_.proposed[lane] > 0.0 && (l.phase > 0 || is_event)) {
    if (!is_event) {  // where the phase is so short that it cuts this step, the next may be as long
      const double length = arrays_.phase_end[lane] - arrays_.time[lane];
      arrays_.growth[lane] = kLargestGrowth * std::max(1.0, arrays_.proposed[lane] / length);
    }
    l.mode = Mode::kStep;
  } else {
    beginSteps(lane);
    checkLimits(lane);
  }
}

}  // namespace twinmap::lanes
