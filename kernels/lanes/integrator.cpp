#include "kernels/lanes/integrator.hpp"

#include <algorithm>

#include "kernels/lanes/lane_packet.hpp"

namespace twinmap::lanes {
namespace {

/// Most numbers of a lane, its slots and the rows of a step. With more, 16 lanes of four leave a first cache
/// of 32 KiB. Of nine problems five were above: 8 lanes were up to 17 % faster on three, up to 4 % slower on
/// two. They were 8 to 15 % slower on the four below.
constexpr int kMostNumbers = 300;

int countNumbers(const Problem& problem) {
  constexpr int kRowsOfStep = 9;  // state, slopes and what is interpolated
  return problem.derivative.slot_count + kRowsOfStep * problem.getRowCount();
}

}  // namespace

const StepEngine& chooseEngine(int samples) {
  const bool has_wide = kSteps8.program.isSupported();
  if (samples <= 4) {
    return kSteps4;
  }
  if (has_wide) {
    return samples <= 8 ? kSteps8 : kSteps16;
  }
  return samples <= 8 ? kSteps8Of4 : kSteps16Of4;
}

const StepEngine& chooseEngine(int samples, const Problem& problem) {
  const int slots = std::max(problem.derivative.slot_count, problem.output.slot_count);
  const auto fits = [&](const StepEngine& engine) {
    return slots <= program::Interpreter::countReachable(engine.program);
  };
  const bool is_large = countNumbers(problem) > kMostNumbers;
  constexpr int kMany = 16;  // lanes take as many times of a sample where there are no states
  const StepEngine& usual = chooseEngine(problem.counts.states == 0 ? kMany : samples);
  const StepEngine& suitable = &usual == &kSteps16Of4 && is_large ? kSteps8Of4 : usual;
  if (fits(suitable)) {
    return suitable;
  }
  const StepEngine& eight = chooseEngine(8);
  return fits(eight) ? eight : kSteps4;
}

std::vector<const StepEngine*> getEngines() {
  std::vector<const StepEngine*> engines{&kSteps4, &kSteps8, &kSteps8Of4, &kSteps16, &kSteps16Of4};
  engines.erase(std::remove_if(engines.begin(), engines.end(),
                               [](const StepEngine* e) { return !e->program.isSupported(); }),
                engines.end());
  return engines;
}

Integrator::Integrator(const Problem& problem, const std::vector<double>& times, const Options& options,
                       const StepEngine& engine)
    : lanes_(std::make_unique<LanePacket>(problem, times, options, engine)) {}
Integrator::~Integrator() = default;

void Integrator::run(SampleStream& stream) {
  lanes_->run(stream);
}

const Statistics& Integrator::getStatistics() const {
  return lanes_->getStatistics();
}

namespace {

class ListedSamples : public SampleStream {
 public:
  explicit ListedSamples(const std::vector<Sample>& samples) : samples_(samples), results(samples.size()) {}
  bool next(Sample& sample) override {
    if (next_ == samples_.size()) {
      return false;
    }
    sample = samples_[next_];
    sample.index = static_cast<int>(next_++);
    return true;
  }
  void finish(const Sample& sample, const Result& result) override { results[sample.index] = result; }

 private:
  const std::vector<Sample>& samples_;
  std::size_t next_ = 0;

 public:
  std::vector<Result> results;
};

}  // namespace

std::vector<Result> integrate(Integrator& integrator, const std::vector<Sample>& samples) {
  ListedSamples stream(samples);
  integrator.run(stream);
  return stream.results;
}

}  // namespace twinmap::lanes
