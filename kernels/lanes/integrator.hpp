#pragma once

#include <memory>
#include <vector>

#include "kernels/lanes/problem.hpp"
#include "kernels/lanes/sample.hpp"
#include "kernels/lanes/sample_stream.hpp"
#include "kernels/lanes/step_engine.hpp"

namespace twinmap::lanes {

/// The engine of this processor that is fastest for so many samples. All engines give the same bits: many
/// lanes hide the latency of instructions and share their decoding, but cost as much when they are empty.
const StepEngine& chooseEngine(int samples);
/// The same for a problem that may be too large for many lanes: for the places of its programs
/// (Interpreter::countReachable), or for the first cache.
const StepEngine& chooseEngine(int samples, const Problem& problem);
/// All engines of this processor.
std::vector<const StepEngine*> getEngines();

class LanePacket;

/// Integrates samples, one a lane, by Dormand and Prince's 5(4) pair with its dense output of order 4
/// (Hairer, Norsett, Wanner: Solving Ordinary Differential Equations I, II.4 to II.6). Every lane has its own
/// parameters, time, step and phase, and takes the next sample when it is done: what a sample gives depends
/// on nothing but itself (bit for bit, also on no engine), and its failure on no other. The integration
/// restarts at every phase. A step's error is the largest of all rows, each in its tolerance (with the larger
/// of the step's two states), sensitivities included; a step with a state or derivative that is not finite is
/// tried again with a tenth of its size. Cost: 6 evaluations of f a step, and as many where a phase begins.
class Integrator {
 public:
  /// `times`: increasing, when outputs are wanted; from the first phase's begin to the samples' end.
  /// `problem` is copied as far as it is needed.
  Integrator(const Problem& problem, const std::vector<double>& times, const Options& options,
             const StepEngine& engine);
  ~Integrator();

  /// Until the stream has no samples left.
  void run(SampleStream& stream);

  const Statistics& getStatistics() const;

 private:
  std::unique_ptr<LanePacket> lanes_;
};

/// Integrates samples in their order; results[i] is that of samples[i].
std::vector<Result> integrate(Integrator& integrator, const std::vector<Sample>& samples);

}  // namespace twinmap::lanes
