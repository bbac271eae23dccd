#pragma once

#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace twinmap::lanes {

/// A stretch of time in which f is smooth.
struct Phase {
  double begin = 0.0;                  ///< s
  std::vector<double> inputs;          ///< phase inputs
  std::vector<double> begin_slopes{};  ///< d begin / d parameter of each direction; empty: none moves it
  bool jumps = false;                  ///< the states jump here, by Equations::jumps
};

/// The phases of a sample, their begins strictly increasing. Copies share them: a table of a thousand lines a
/// second has thousands, the same ones for most samples.
class Phases {
 public:
  Phases() : Phases(std::vector<Phase>{}) {}
  Phases(std::initializer_list<Phase> phases) : Phases(std::vector<Phase>(phases)) {}
  Phases(std::vector<Phase> phases)
      : phases_(std::make_shared<const std::vector<Phase>>(std::move(phases))) {}

  const Phase& operator[](int index) const { return (*phases_)[static_cast<std::size_t>(index)]; }
  int size() const { return static_cast<int>(phases_->size()); }
  bool empty() const { return phases_->empty(); }
  std::vector<Phase>::const_iterator begin() const { return phases_->begin(); }
  std::vector<Phase>::const_iterator end() const { return phases_->end(); }

 private:
  std::shared_ptr<const std::vector<Phase>> phases_;
};

/// One solution to find, and where its outputs go.
struct Sample {
  int index = 0;  ///< the caller's
  std::vector<double> parameters;
  std::vector<double> initial;    ///< states, then their sensitivities direction by direction
  Phases phases;                  ///< one or more
  double end = 0.0;               ///< s; of the last phase
  std::vector<double> delays{};   ///< s; values of Equations::delays
  double* outputs = nullptr;      ///< output by output, each at all times
  double* derivatives = nullptr;  ///< direction by direction, each as `outputs`; null if there are none
};

enum class Outcome {
  kDone,
  kStepLimit,
  kWallTime,      ///< the only one that depends on the machine
  kNonFinite,     ///< state or derivative
  kStepTooSmall,  ///< for the numbers to tell its end from its begin
  kSingular,      ///< a pivot was not positive
  kEventsStuck,   ///< events followed one another without progress in time
};

struct Result {
  Outcome outcome = Outcome::kDone;
  double time = 0.0;  ///< s; where it ended. At a failure the outputs of the sample are not written.
  int steps = 0;      ///< tried, including rejected ones
  int rejected = 0;
  int events = 0;  ///< whose time depends on the solution
};

struct Options {
  double relative_tolerance = 3e-7;  ///< local error per step, relative to the state
  double absolute_tolerance = 1e-9;  ///< and absolute, in the state's own units
  /// By how much more a sensitivity may err, since it need not be known as well as the state that it
  /// corrects. On the two beams 1 costs 30 % more steps for an error of 2e-6 of the range, 10 none
  /// for 2.4e-5.
  double sensitivity_factor = 10.0;
  /// For each direction, the change of its parameter that matters: the unit of its sensitivities' error.
  /// Empty: 1.
  std::vector<double> parameter_scales{};
  int max_steps = 100000;       ///< tried steps of all phases together
  double max_wall_time = 60.0;  ///< s, from the moment that the sample enters its lane
};

/// How well the lanes were used, of one integrator.
struct Statistics {
  long rounds = 0;        ///< of a step in all lanes
  long active_lanes = 0;  ///< sum over rounds of the lanes that held a sample
  long steps = 0;         ///< tried
  long rejected = 0;
};

}  // namespace twinmap::lanes
