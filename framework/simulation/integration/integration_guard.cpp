#include <cstdio>

#include "framework/simulation/integration/integration.hpp"

namespace twinmap {

std::string describeAt(const std::string& what, double t) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", t);
  return what + " at t = " + text + " s";
}

std::string describeStepLimit(int max_steps, double t) {
  return describeAt("step limit of " + std::to_string(max_steps) + " reached", t);
}

std::string describeWallTime(double max_wall_time, double t) {
  char limit[32];
  std::snprintf(limit, sizeof limit, "%g", max_wall_time);
  return describeAt("wall-time limit of " + std::string(limit) + " s reached", t);
}

IntegrationGuard::IntegrationGuard(const IntegrationOptions& options)
    : options_(options), start_(std::chrono::steady_clock::now()) {}

std::string IntegrationGuard::check(int steps, double t) const {
  if (steps >= options_.max_steps) {
    return describeStepLimit(options_.max_steps, t);
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
  if (elapsed.count() > options_.max_wall_time) {
    throw WallTimeReached(describeWallTime(options_.max_wall_time, t));
  }
  return "";
}

}  // namespace twinmap
