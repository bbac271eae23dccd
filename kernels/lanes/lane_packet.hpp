#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "kernels/lanes/event_programs.hpp"
#include "kernels/lanes/lane.hpp"
#include "kernels/lanes/problem.hpp"
#include "kernels/lanes/program/aligned_buffer.hpp"
#include "kernels/lanes/sample_stream.hpp"
#include "kernels/lanes/state_projection.hpp"
#include "kernels/lanes/step_engine.hpp"

namespace twinmap::lanes {

/// The lanes of one integrator: which samples they hold, and a step of all of them at a time.
class LanePacket {
 public:
  LanePacket(const Problem& problem, const std::vector<double>& times, const Options& options,
             const StepEngine& engine);
  void run(SampleStream& stream);
  const Statistics& getStatistics() const { return statistics_; }

 private:
  void makeTolerances(const Problem& problem);
  void placeArrays(const Problem& problem);
  double* takeRows(int count) { return std::exchange(free_, free_ + count * count_); }

  bool load(int lane, SampleStream& stream);
  void park(int lane);
  void release(int lane, SampleStream& stream);
  void beginPhase(int lane, int phase);
  void doRound();
  unsigned doStep();
  void judge(int lane);
  void doBegins();
  void restart(unsigned lanes, unsigned jumping, program::Interpreter* jumps);
  void jump(unsigned lanes, program::Interpreter& program);
  void prepareJump(int lane, program::Interpreter& program);
  void evaluateAt(unsigned lanes);
  void beginAfter(int lane);
  unsigned findMoving(unsigned lanes) const;
  void moveBy(int lane, double sign);
  unsigned findEvents();
  unsigned findDips(unsigned looking, unsigned found);
  void calcGuardsWithin();
  void narrow(unsigned lanes);
  void endStepAtEvent(int lane);
  void startEvent(int lane, int event);
  void openPhase(int lane);
  void doEvents();
  void settle(unsigned lanes);
  void findEventSlopes(int lane);
  void keepOutputs(int lane);
  void advance(int lane);
  void beginSteps(int lane);
  void endPhase(int lane);
  void checkLimits(int lane);
  void fail(int lane, Outcome outcome);
  double calcNorm(int lane, const double* rows) const;
  void setNextOutput(int lane, int index);

  template <typename Function>
  void forEach(unsigned lanes, const Function& function) {
    for (int lane = 0; lanes != 0; ++lane, lanes >>= 1) {
      if ((lanes & 1) != 0 && lanes_[lane].mode != Mode::kIdle) {
        function(lane);
      }
    }
  }

  const std::vector<double> times_;
  const Options options_;
  const StepEngine& engine_;
  const int count_;  ///< lanes
  const int states_, parameters_, phase_inputs_, directions_;
  program::Interpreter interpreter_;
  OutputRecorder outputs_;
  std::optional<program::Interpreter> jumps_;
  unsigned beginning_ = 0;  ///< lanes whose phase begins before the next step
  std::optional<EventPrograms> events_;
  unsigned firing_ = 0;    ///< lanes with an event due
  unsigned settling_ = 0;  ///< lanes in which events may be due
  std::vector<EventBracket> brackets_;
  std::vector<double> event_times_;
  std::vector<double> dips_;  ///< of the looks of a step, each of all lanes
  std::optional<StateProjection> projection_;
  std::vector<const double*> derivatives_, pivots_;
  std::vector<double> absolute_, relative_;
  program::AlignedBuffer buffer_;
  double* free_ = nullptr;
  StepArrays arrays_{};
  std::vector<Lane> lanes_;
  int active_ = 0;
  bool parameters_changed_ = true, phase_changed_ = true;
  Statistics statistics_;
};

}  // namespace twinmap::lanes
