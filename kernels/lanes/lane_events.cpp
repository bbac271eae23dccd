// Events whose time depends on the solution: where they are within a step, and what they change.
#include <algorithm>
#include <cmath>

#include "kernels/lanes/lane_packet.hpp"

namespace twinmap::lanes {
namespace {

/// Where a step is looked at, in parts of it. A guard that dips below 0 and returns between two of them is
/// found where it does so like a parabola; the error control keeps steps well below the times in which a
/// solution bends otherwise.
constexpr int kLooks = 4;
constexpr double kLookedAt[kLooks] = {0.25, 0.5, 0.75, 1.0}, kApart = 0.25;
constexpr int kMostTries = 300;     // 100 of them halve the bracket, beyond what a double resolves
constexpr int kManyAtOnce = 100;    // far more than elements that meet at one time
constexpr int kDoublings = 40;      // of the shortest step, behind that many: a fiftieth of a second at 10 s
constexpr double kWidth = 0x1p-51;  // of a bracket, in parts of the time: two units in the last place

/// Where a parabola through three successive looks is below 0, in parts of the step: between where it gets
/// there and its smallest value. `middle`: the second look, at which it may be as far as `from` to `to` looks
/// away. -1: nowhere.
double findDip(double before, double at, double after, double middle, double from, double to) {
  const double slope = 0.5 * (after - before), bend = before - 2.0 * at + after;
  const double lowest = -slope / bend, depth = 0.5 * slope * slope / bend - at;
  if (!(bend > 0.0 && depth >= 0.0 && lowest > from && lowest <= to)) {
    return -1.0;
  }
  return std::max(middle + kApart * (lowest - 0.5 * std::sqrt(2.0 * depth / bend)),
                  0.5 * (middle + kApart * lowest));
}

}  // namespace

/// Before accepted steps are taken: those with an event end there. Returns their lanes.
unsigned LanePacket::findEvents() {
  unsigned looking = 0, found = 0;
  for (int lane = 0; lane < count_; ++lane) {
    const bool stepped = lanes_[lane].mode == Mode::kStep && arrays_.accepted[lane] != 0.0;
    looking |= stepped ? 1u << lane : 0u;
    brackets_[lane] = {};
  }
  const unsigned stepped = looking;
  dips_.resize(static_cast<std::size_t>(kLooks * events_->getDipCount() * count_));
  double* dips = dips_.data();
  for (const double fraction : kLookedAt) {
    forEach(stepped, [&](int lane) { arrays_.fraction[lane] = fraction; });
    calcGuardsWithin();
    for (int k = 0; k < events_->getDipCount(); ++k) {
      for (int lane = 0; lane < count_; ++lane) {
        *dips++ = events_->getDip(k, lane);
      }
    }
    forEach(looking, [&](int lane) {
      EventBracket& bracket = brackets_[lane];
      const double smallest = events_->calcSmallest(lane);
      found |= smallest <= 0.0 ? 1u << lane : 0u;
      (smallest <= 0.0 ? bracket.high : bracket.low) = fraction;
      (smallest <= 0.0 ? bracket.at_high : bracket.at_low) = smallest;
    });
    looking &= ~found;
    if (looking == 0 && events_->getDipCount() == 0) {
      break;
    }
  }
  found = findDips(stepped, found);
  if (found != 0) {
    narrow(found);
    forEach(found, [this](int lane) { endStepAtEvent(lane); });
  }
  return found;
}

/// Adds lanes with an event between looks to those that are found, whose events may come earlier too. Behind
/// an event the step goes on as if there were none, so that a parabola is seen as a whole.
unsigned LanePacket::findDips(unsigned looking, unsigned found) {
  const int all = events_->getDipCount() * count_;
  for (int k = 0; k < events_->getDipCount() && looking != 0; ++k) {
    unsigned dipping = 0;
    forEach(looking, [&](int lane) {
      const double* d = dips_.data() + k * count_ + lane;
      const double early = findDip(d[0], d[all], d[2 * all], kLookedAt[1], -2.0, 0.5);
      const double late = findDip(d[all], d[2 * all], d[3 * all], kLookedAt[2], -0.5, 1.0);
      arrays_.fraction[lane] = early > 0.0 ? early : late;
      dipping |= arrays_.fraction[lane] > 0.0 ? 1u << lane : 0u;
    });
    if (dipping == 0) {
      continue;
    }
    forEach(looking & ~dipping, [&](int lane) { arrays_.fraction[lane] = 1.0; });
    calcGuardsWithin();
    forEach(dipping, [&](int lane) {
      const double smallest = events_->calcSmallest(lane), fraction = arrays_.fraction[lane];
      const bool first = (found & 1u << lane) == 0 || fraction < brackets_[lane].high;
      if (smallest <= 0.0 && first) {
        found |= 1u << lane;
        brackets_[lane] = {kApart * std::floor(fraction / kApart), fraction, 0.0, smallest};
      }
    });
  }
  return found;
}

/// At each lane's fraction of its step.
void LanePacket::calcGuardsWithin() {
  engine_.interpolateAll(arrays_);
  for (int lane = 0; lane < count_; ++lane) {
    event_times_[lane] = arrays_.time[lane] + arrays_.fraction[lane] * arrays_.step[lane];
  }
  events_->calcGuards(event_times_.data(), arrays_.interpolated);
}

/// Leaves guards and states at the brackets' upper ends.
void LanePacket::narrow(unsigned lanes) {
  unsigned open = lanes;
  for (int attempt = 0; attempt < kMostTries; ++attempt) {
    forEach(open, [&](int lane) {
      const EventBracket& bracket = brackets_[lane];
      const double time = std::max(std::abs(arrays_.end[lane]), kSmallestTime);
      const bool is_narrow = (bracket.high - bracket.low) * arrays_.step[lane] <= kWidth * time;
      open &= is_narrow ? ~(1u << lane) : ~0u;
      arrays_.fraction[lane] = bracket.choose(attempt);
    });
    if (open == 0) {
      break;
    }
    calcGuardsWithin();
    forEach(open,
            [&](int lane) { brackets_[lane].update(arrays_.fraction[lane], events_->calcSmallest(lane)); });
  }
  forEach(lanes, [&](int lane) { arrays_.fraction[lane] = brackets_[lane].high; });
  calcGuardsWithin();
}

/// The next step is no longer than the time since the last event, so that flights between impacts that follow
/// ever faster are seen. Rounding may leave the speed on the wrong side of 0 where a force barely exceeds
/// what friction holds. Each such step ends with an event then, and behind many of them steps grow until the
/// speed has turned.
void LanePacket::endStepAtEvent(int lane) {
  Lane& l = lanes_[lane];
  for (int row = 0; row < arrays_.rows; ++row) {
    arrays_.stage_state[row * count_ + lane] = arrays_.interpolated[row * count_ + lane];
  }
  const double time = std::min(event_times_[lane], arrays_.end[lane]);
  const double smallest = kSmallestStep * std::max(std::abs(time), kSmallestTime);
  const double apart = time - l.event_time;
  l.events_at_once = apart > smallest ? 0 : l.events_at_once;
  const int doublings = std::max(0, l.events_at_once - kManyAtOnce);
  arrays_.proposed[lane] =
      std::min(arrays_.proposed[lane], std::max(apart, std::ldexp(smallest, 1 + doublings)));
  arrays_.end[lane] = l.event_time = time;
  std::fill(l.fired.begin(), l.fired.end(), 0);
  int due = 0;
  for (int k = events_->getCount() - 1; k >= 0; --k) {
    l.crossing[k] = events_->getGuard(k, lane) <= 0.0 ? 1 : 0;
    due = l.crossing[k] != 0 ? k : due;
  }
  startEvent(lane, due);
}

void LanePacket::startEvent(int lane, int event) {
  Lane& l = lanes_[lane];
  ++l.result.events;
  if (++l.events_at_once > kManyAtOnce + kDoublings) {
    return fail(lane, Outcome::kEventsStuck);
  }
  l.event = event;
  l.fired[event] = 1;
  l.mode = Mode::kEvent;
  firing_ |= 1u << lane;
}

/// Where steps of a phase begin: its inputs may make events due.
void LanePacket::openPhase(int lane) {
  Lane& l = lanes_[lane];
  if (!events_ || l.mode != Mode::kStep) {
    return;
  }
  if (l.phase > 0) {
    settling_ |= 1u << lane;
    return;
  }
  l.event = Lane::kStartEvent;
  l.mode = Mode::kEvent;
  firing_ |= 1u << lane;
}

void LanePacket::doEvents() {
  settle(std::exchange(settling_, 0u));
  const unsigned lanes = std::exchange(firing_, 0u);
  if (lanes == 0) {
    return;
  }
  evaluateAt(lanes);
  if (directions_ > 0) {
    events_->calcChanges(arrays_.time, arrays_.state);
    forEach(lanes, [this](int lane) { findEventSlopes(lane); });
  }
  restart(lanes, lanes, &events_->updTransitions());
  settling_ |= lanes;
}

/// Events that are due where others have been, or where a phase begins. An event that has just been waits
/// until its guard has been positive.
void LanePacket::settle(unsigned lanes) {
  if (lanes == 0) {
    return;
  }
  events_->calcGuards(arrays_.time, arrays_.state);
  forEach(lanes, [this](int lane) {
    const Lane& l = lanes_[lane];
    for (int k = 0; k < events_->getCount(); ++k) {
      if (events_->getGuard(k, lane) <= 0.0 && l.fired[k] == 0) {
        return startEvent(lane, k);
      }
    }
    if (arrays_.time[lane] == arrays_.phase_end[lane]) {
      endPhase(lane);
    }
  });
}

/// The guard stays 0 at the event's time as a parameter changes: dg/dp + dg/dt dt/dp = 0, along the solution.
/// An event that another one caused, or the begin of a phase, moves with that.
void LanePacket::findEventSlopes(int lane) {
  Lane& l = lanes_[lane];
  if (l.event == Lane::kStartEvent || l.crossing[l.event] == 0) {
    return;
  }
  l.crossing[l.event] = 0;
  l.event_slopes.resize(directions_);
  for (int j = 0; j < directions_; ++j) {
    const double change = events_->getChange(l.event, j, lane);
    l.event_slopes[j] = change == 0.0 ? 0.0 : -change / events_->getRate(l.event, lane);
  }
}

}  // namespace twinmap::lanes
