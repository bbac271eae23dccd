#include "bench/simulation/report.hpp"

#include <fmt/core.h>

#include <string>

namespace twinmap::bench {
namespace {

void printCost(const std::string& name, const ProgramCost& cost) {
  fmt::print("| {} | {} | {} | {:.0f} | {:.0f} KiB | {:.1f} | {:.2f} | {:.1f} | {:.0f} |\n", name,
             cost.instructions, cost.dispatches, cost.operations, cost.memory / 1024.0, cost.time_ns,
             cost.time_ns / cost.instructions, cost.operations / cost.time_ns, cost.bytes / cost.time_ns);
}

}  // namespace

void printComparisons(const std::vector<Comparison>& comparisons) {
  fmt::print("| mechanism | side | error | us a sample | against lanes |\n|---|---|--:|--:|--:|\n");
  for (const Comparison& c : comparisons) {
    fmt::print("| {} | MuJoCo, step {:.2f} ms (a quarter: {:.0e}) | {:.1e} | {:.0f} | {:.1f} |\n", c.name,
               1e3 * c.mujoco_step, c.fine_mujoco_error, c.mujoco_error, c.mujoco_time,
               c.calcMujocoTimeAtEqualError() / c.lane_time);
    fmt::print("| | lanes | {:.1e} | {:.1f} | 1 |\n", c.lane_error, c.lane_time);
    fmt::print("| | simbody | {:.1e} | {:.0f} | {:.1f} |\n", c.simbody_error, c.simbody_time,
               c.simbody_time / c.lane_time);
  }
}

void printLanes(const std::vector<Comparison>& comparisons) {
  fmt::print(
      "\n| mechanism | values | with derivatives | ratio | steps | rejected | active lanes | derivative's "
      "share |\n"
      "|---|--:|--:|--:|--:|--:|--:|--:|\n");
  for (const Comparison& c : comparisons) {
    const LaneProfile& p = c.profile;
    fmt::print(
        "| {} | {:.1f} us | {:.1f} us, {} parameters | {:.2f} | {:.0f} | {:.1f} % | {:.2f} of {} | {:.0f} % "
        "|\n",
        c.name, c.lane_time, c.derivative_time, c.directions, c.derivative_time / c.lane_time, p.steps,
        100.0 * p.rejected_share, p.active_lanes, p.lanes,
        0.1 * p.evaluations * p.derivative.time_ns / c.lane_time);
  }
}

void printPrograms(const std::vector<Comparison>& comparisons, const ProgramCost& multiply_adds,
                   const ProgramCost& sines) {
  fmt::print(
      "\n| derivative of | instructions | dispatches | operations | values | ns a sample | ns an instruction "
      "| "
      "Gflop/s | GB/s |\n"
      "|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  for (const Comparison& c : comparisons) {
    printCost(c.name, c.profile.derivative);
  }
  printCost("independent multiply-adds", multiply_adds);
  printCost("independent sines with cosines", sines);
}

}  // namespace twinmap::bench
