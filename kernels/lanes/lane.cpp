#include "kernels/lanes/lane.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace twinmap::lanes {
namespace {

constexpr double kLargestGrowth = 10.0;
constexpr double kLargestFirstGrowth =
    100.0;  // the first size is a hundredth of the solution's own time, or less
constexpr double kSmallestFactor = 0.1;
constexpr int kStepsBetweenClocks = 64;  // reading the clock costs 25 ns

}  // namespace

void Lane::begin() {
  result = {};
  next_output = 0;
  start = std::chrono::steady_clock::now();
  beginPhase(0);
}

void Lane::beginPhase(int index) {
  phase = index;
  time = sample.phases[index].begin;
  planned = 0.0;
  mode = Mode::kBegin;
}

double Lane::getPhaseEnd() const {
  return isInLastPhase() ? sample.end : sample.phases[phase + 1].begin;
}

void Lane::plan() {
  if (mode != Mode::kFirst && mode != Mode::kStep) {
    planned = 0.0;
    is_last = false;
    return;
  }
  const double rest = getPhaseEnd() - time;
  is_last = 1.01 * proposed >= rest;
  planned = is_last ? rest : std::min(proposed, 0.5 * rest);
}

void Lane::accept(double factor) {
  const double growth = mode == Mode::kFirst ? kLargestFirstGrowth : was_rejected ? 1.0 : kLargestGrowth;
  time = getPlannedEnd();
  proposed = planned * std::max(std::min(factor, growth), kSmallestFactor);
  was_rejected = false;
  mode = Mode::kStep;
}

bool Lane::reject(double error, double factor) {
  ++result.rejected;
  was_rejected = true;
  proposed = planned * (std::isfinite(error) ? std::max(factor, kSmallestFactor) : kSmallestFactor);
  return proposed > 8.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(time), 1e-9);
}

bool Lane::isStopped(const Options& options) {
  if (result.steps >= options.max_steps) {
    fail(Outcome::kStepLimit);
  } else if (result.steps % kStepsBetweenClocks == 0) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    if (elapsed.count() > options.max_wall_time) {
      fail(Outcome::kWallTime);
    }
  }
  return result.outcome != Outcome::kDone;
}

void Lane::fail(Outcome outcome) {
  result.outcome = outcome;
}

}  // namespace twinmap::lanes
