#include "framework/models/mechanism/lanes/phases.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "framework/simulation/simulation_failure.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Times closer than this part of a clock's period are one.
constexpr double kRounding = 1e-9;

/// Something that begins a phase.
struct Mark {
  double time;
  double of_excitation;                  ///< its time there
  const RecordedClock* clock = nullptr;  ///< null: an event of the excitation
  int slot = 0;
  const std::vector<double>* slopes = nullptr;  ///< of its time; null: nothing moves it
};

/// In time; of those at one time the ones that move first, so that what falls on an output time stays there.
bool isBefore(const Mark& a, const Mark& b) {
  return a.time < b.time || (a.time == b.time && a.slopes != nullptr && b.slopes == nullptr);
}

/// Marks of all kinds, in their order.
class PhaseMaker {
 public:
  PhaseMaker(const LaneModel& model, const SampleTimes& times, double duration, const VectorXd& output_times)
      : model_(model),
        times_(times),
        clocks_(model.sampling.clocks),
        duration_(duration),
        output_times_(output_times) {
    if (times.events.rows() > 0) {
      events_.assign(times.events.col(0).begin(), times.events.col(0).end());
    }
    for (const RecordedClock& clock : clocks_) {
      rounding_ = std::min(rounding_ == 0.0 ? clock.period : rounding_, kRounding * clock.period);
    }
  }

  void fill(lanes::Sample& sample) {
    addEvents();
    for (const RecordedClock& clock : clocks_) {
      const auto before = static_cast<std::ptrdiff_t>(marks_.size());
      addInstants(clock);
      std::inplace_merge(marks_.begin(), marks_.begin() + before, marks_.end(), isBefore);
    }
    phases_.reserve(marks_.size());
    for (const Mark& mark : marks_) {
      addMark(mark);
    }
    sample.end = duration_;
    if (!phases_.empty()) {  // else nothing is integrated: modes alone
      if (const int start = model_.sampling.start_input; start >= 0) {
        phases_.front().inputs[start] = 1.0;
        phases_.front().jumps = true;
      }
      if (phases_.back().begin >= duration_) {  // outputs at the end are those behind it
        sample.end = phases_.back().begin * (1.0 + 0x1p-48);
      }
    }
    sample.phases = std::move(phases_);
  }

 private:
  void addEvents() {
    const double origin = times_.origin, slack = origin == 0.0 ? 0.0 : kRounding * duration_;
    std::vector<Boundary> boundaries =
        calcBoundaries(model_.excitation, events_, origin, origin + duration_ - slack);
    if (boundaries.size() > 2 && boundaries[1].time <= origin + slack) {
      boundaries.erase(boundaries.begin());
    }
    for (std::size_t i = 0; i + 1 < boundaries.size(); ++i) {
      marks_.push_back({i == 0 ? 0.0 : boundaries[i].time - origin, boundaries[i].time});
      if (boundaries[i].event >= 0) {
        marks_.back().slopes = findSlopes(times_.events, boundaries[i].event, 1.0);
      }
    }
  }

  /// Where instants join events, those that nothing moves have no slopes.
  const std::vector<double>* findSlopes(const Eigen::MatrixXd& of, Index row, double sign) {
    const VectorXd slopes = sign * of.row(row).tail(model_.countDirections());
    if (slopes.size() == 0 || (!clocks_.empty() && !(slopes.array() != 0.0).any())) {
      return nullptr;
    }
    return &slopes_.emplace_back(slopes.begin(), slopes.end());
  }

  void addInstants(const RecordedClock& clock) {
    const double delay = clock.delay < 0 ? 0.0 : times_.delays(clock.delay, 0);
    const std::vector<double>* const slopes =
        clock.delay < 0 ? nullptr : findSlopes(times_.delays, clock.delay, clock.sign);
    for (long k = 0;; ++k) {
      const double time = snap(static_cast<double>(k) * clock.period + clock.sign * delay);
      if (time > duration_) {
        return;
      }
      if (time > 0.0 || (clock.sign > 0.0 && time == 0.0)) {
        marks_.push_back({time, times_.origin + time, &clock, static_cast<int>(k % clock.slots), slopes});
      }
    }
  }

  double snap(double time) const {
    const auto after = std::lower_bound(output_times_.begin(), output_times_.end(), time - rounding_);
    const bool near = after != output_times_.end() && *after <= time + rounding_;
    return near ? *after : std::abs(time - duration_) <= rounding_ ? duration_ : time;
  }

  /// To the phase that it falls on, or as a phase of its own.
  void addMark(const Mark& mark) {
    const bool joins = !phases_.empty() && mark.slopes == nullptr && phases_.back().begin_slopes.empty() &&
                       mark.time - phases_.back().begin <= rounding_;
    if (!joins) {
      phases_.push_back({mark.time, std::vector<double>(model_.counts.phase_inputs), {}});
      makeRoom();
    }
    lanes::Phase& phase = phases_.back();
    if (mark.slopes != nullptr) {
      phase.begin_slopes = *mark.slopes;
    }
    if (!joins || mark.clock == nullptr) {
      fillPhaseInputs(model_.excitation, events_, mark.of_excitation, phase.inputs.data(), times_.origin);
    }
    if (mark.clock != nullptr) {
      phase.inputs[mark.clock->input] = 1.0 + mark.slot;
      phase.jumps = true;
    }
  }

  /// What comes at one time but moves otherwise: the earlier ones come a number before, but not before the
  /// start.
  void makeRoom() {
    for (std::size_t i = phases_.size() - 1; i > 1 && phases_[i].begin <= phases_[i - 1].begin; --i) {
      phases_[i - 1].begin = std::nextafter(phases_[i].begin, 0.0);
    }
    for (std::size_t i = 1; i < phases_.size() && phases_[i].begin <= phases_[i - 1].begin; ++i) {
      phases_[i].begin = std::nextafter(phases_[i - 1].begin, duration_);
    }
  }

  const LaneModel& model_;
  const SampleTimes& times_;
  const std::vector<RecordedClock>& clocks_;
  const double duration_;
  double rounding_ = 0.0;
  const VectorXd& output_times_;
  std::vector<double> events_;
  std::deque<std::vector<double>> slopes_;
  std::vector<Mark> marks_;
  std::vector<lanes::Phase> phases_;
};

void requireUsable(const RecordedSampling& sampling, const Eigen::MatrixXd& delays) {
  for (const RecordedClock& clock : sampling.clocks) {
    const double longest = (clock.slots - 1) * clock.period;
    if (clock.delay >= 0 && delays(clock.delay, 0) > longest) {
      throw SimulationFailure(
          fmt::format("a controller's delay is {:.6g} s, above {:.6g} s, the longest "
                      "within the parameters' bounds",
                      delays(clock.delay, 0), longest));
    }
  }
}

}  // namespace

void fillPhases(const LaneModel& model, const SampleTimes& times, double duration,
                const VectorXd& output_times, lanes::Sample& sample) {
  requireUsable(model.sampling, times.delays);
  const Eigen::MatrixXd delays = times.delays.topRows(model.sampling.output_delay_count);
  sample.delays.clear();
  if (delays.rows() > 0) {
    sample.delays.assign(delays.col(0).begin(), delays.col(0).end());
  }
  PhaseMaker(model, times, duration, output_times).fill(sample);
}

}  // namespace twinmap
