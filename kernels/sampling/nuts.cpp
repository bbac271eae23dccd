#include "kernels/sampling/nuts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace twinmap::markov {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

double addLogarithms(double a, double b) {
  const double larger = std::max(a, b);
  return larger == -kInfinite ? larger : larger + std::log1p(std::exp(std::min(a, b) - larger));
}

/// A point of a trajectory.
struct State {
  VectorXd position, momentum, gradient;
  double log_density = -kInfinite;
};

/// The Hamiltonian -log density + p' M^-1 p / 2, and steps along it.
class Hamiltonian {
 public:
  Hamiltonian(const LogDensity& density, Index dimensions)
      : density_(density), inverse_masses(VectorXd::Ones(dimensions)) {}

  void evaluate(State& state) {
    state.gradient.resize(state.position.size());
    state.log_density = density_(state.position, state.gradient);
    if (!std::isfinite(state.log_density) || !state.gradient.allFinite()) {
      state.log_density = -kInfinite;
    }
    ++evaluations;
  }

  double calcEnergy(const State& state) const {
    return 0.5 * state.momentum.dot(calcVelocity(state.momentum)) - state.log_density;
  }

  VectorXd calcVelocity(const VectorXd& momentum) const { return inverse_masses.cwiseProduct(momentum); }

  /// A leapfrog step, backwards where `step` is negative.
  State move(const State& from, double step) {
    State to;
    to.momentum = from.momentum + 0.5 * step * from.gradient;
    to.position = from.position + step * calcVelocity(to.momentum);
    evaluate(to);
    if (to.log_density > -kInfinite) {
      to.momentum += 0.5 * step * to.gradient;
    }
    return to;
  }

 private:
  const LogDensity& density_;

 public:
  VectorXd inverse_masses;
  Index evaluations = 0;
};

/// A part of a trajectory, and a draw from it.
struct Segment {
  State first, last;  // in time
  VectorXd momenta;   // their sum
  State draw;
  double log_weight = -kInfinite;  // of all its points
  bool complete = true;            // neither turned back nor diverged
  bool diverged = false;
};

struct Acceptance {
  double sum = 0.0;
  Index count = 0;
};

/// Grows the trajectory of one step of the chain.
class Trajectory {
 public:
  Trajectory(Hamiltonian& hamiltonian, double step_size, double energy,
             const std::function<double()>& uniform)
      : hamiltonian_(hamiltonian), step_size_(step_size), energy_(energy), uniform_(uniform) {}

  Acceptance acceptance;

  /// 2^depth points beyond `from`, later or earlier.
  Segment extend(const State& from, int depth, bool forwards) {
    if (depth == 0) {
      return makePoint(hamiltonian_.move(from, forwards ? step_size_ : -step_size_));
    }
    Segment near = extend(from, depth - 1, forwards);
    if (!near.complete) {
      return near;
    }
    Segment far = extend(forwards ? near.last : near.first, depth - 1, forwards);
    const double share = std::exp(far.log_weight - addLogarithms(near.log_weight, far.log_weight));
    const bool take_far = far.complete && uniform_() < share;
    return forwards ? join(std::move(near), std::move(far), take_far)
                    : join(std::move(far), std::move(near), !take_far);
  }

  /// Of two segments, the second later; the draw of the second if `take_later`.
  Segment join(Segment earlier, Segment later, bool take_later) const {
    Segment joined;
    joined.diverged = earlier.diverged || later.diverged;
    joined.complete = earlier.complete && later.complete;
    joined.momenta = earlier.momenta + later.momenta;
    joined.log_weight = addLogarithms(earlier.log_weight, later.log_weight);
    // The halves' own ends do not show that a trajectory turned back between them.
    joined.complete = joined.complete && goesOn(earlier.first, later.last, joined.momenta) &&
                      goesOn(earlier.first, later.first, earlier.momenta + later.first.momentum) &&
                      goesOn(earlier.last, later.last, later.momenta + earlier.last.momentum);
    joined.draw = std::move(take_later ? later.draw : earlier.draw);
    joined.first = std::move(earlier.first);
    joined.last = std::move(later.last);
    return joined;
  }

 private:
  Segment makePoint(State state) {
    constexpr double kRunaway =
        1000.0;  // energy beyond which a trajectory has left the density; Stan's bound
    Segment point;
    const double gain = energy_ - hamiltonian_.calcEnergy(state);
    point.log_weight = std::isfinite(gain) ? gain : -kInfinite;
    point.diverged = !(point.log_weight > -kRunaway);
    point.complete = !point.diverged;
    acceptance.sum += std::min(1.0, std::exp(point.log_weight));
    ++acceptance.count;
    point.momenta = state.momentum;
    point.first = state;
    point.last = state;
    point.draw = std::move(state);
    return point;
  }

  bool goesOn(const State& first, const State& last, const VectorXd& momenta) const {
    return hamiltonian_.calcVelocity(first.momentum).dot(momenta) > 0.0 &&
           hamiltonian_.calcVelocity(last.momentum).dot(momenta) > 0.0;
  }

  Hamiltonian& hamiltonian_;
  double step_size_, energy_;
  const std::function<double()>& uniform_;
};

/// The step size by dual averaging (Hoffman and Gelman 2014, section 3.2, with its constants).
class StepSize {
 public:
  StepSize(double first, double target) : target_(target), center_(std::log(10.0 * first)), step_(first) {}

  void update(double acceptance) {
    constexpr double kShrinkage = 0.05, kDelay = 10.0, kForgetting = 0.75;
    ++count_;
    error_ += (target_ - acceptance - error_) / (count_ + kDelay);
    const double logarithm = center_ - std::sqrt(count_) / kShrinkage * error_;
    const double share = std::pow(count_, -kForgetting);
    mean_ += share * (logarithm - mean_);
    step_ = std::exp(logarithm);
  }

  double get() const { return step_; }
  double getMean() const { return count_ > 0.0 ? std::exp(mean_) : step_; }

 private:
  double target_, center_, step_;
  double count_ = 0.0, error_ = 0.0, mean_ = 0.0;
};

/// Variances of the points of a window (Welford).
class Variances {
 public:
  explicit Variances(Index dimensions) : mean_(VectorXd::Zero(dimensions)), squares_(mean_) {}

  void add(const VectorXd& point) {
    count_ += 1.0;
    const VectorXd apart = point - mean_;
    mean_ += apart / count_;
    squares_ += apart.cwiseProduct(point - mean_);
  }

  /// Drawn towards 1e-3 as five further points would: few points know little.
  VectorXd calculate() const {
    constexpr double kPoints = 5.0, kSmall = 1e-3;
    const VectorXd variances = squares_ / std::max(1.0, count_ - 1.0);
    return ((count_ * variances).array() + kPoints * kSmall) / (count_ + kPoints);
  }

 private:
  VectorXd mean_, squares_;
  double count_ = 0.0;
};

/// The steps of the warm-up after which masses are set anew: windows double from 25 between a beginning and
/// an end in which the step size alone is adapted.
std::vector<int> listWindowEnds(int warm_up) {
  constexpr int kFirst = 25;
  const int begin = static_cast<int>(0.15 * warm_up), end = static_cast<int>(0.9 * warm_up);
  std::vector<int> ends;
  int window = kFirst;
  for (int at = begin + window; at <= end; at += window) {
    const bool is_last = at + 2 * window > end;
    ends.push_back(is_last ? end : at);
    if (is_last) {
      break;
    }
    window *= 2;
  }
  return ends;
}

class Sampler {
 public:
  Sampler(const LogDensity& density, const VectorXd& start, const ChainNumbers& numbers,
          const NutsOptions& options)
      : options_(options),
        numbers_(numbers),
        hamiltonian_(density, start.size()),
        uniform_([this] { return numbers_.uniform(uniforms_++); }) {
    state_.position = start;
    hamiltonian_.evaluate(state_);
    if (state_.log_density == -kInfinite) {
      throw std::invalid_argument("the density is 0 where the chain begins");
    }
  }

  Chain run() {
    warmUp();
    for (int i = 0; i < options_.draws; ++i) {
      const Acceptance accepted = step(step_size_, &chain_);
      chain_.draws.col(i) = state_.position;
      chain_.mean_acceptance += calcMean(accepted) / options_.draws;
    }
    chain_.step_size = step_size_;
    chain_.inverse_masses = hamiltonian_.inverse_masses;
    chain_.evaluations = hamiltonian_.evaluations;
    return std::move(chain_);
  }

 private:
  static double calcMean(const Acceptance& acceptance) {
    return acceptance.sum / static_cast<double>(std::max<Index>(1, acceptance.count));
  }

  void drawMomentum(State& state) {
    state.momentum.resize(state.position.size());
    for (double& momentum : state.momentum) {
      momentum = numbers_.normal(normals_++);
    }
    state.momentum.array() /= hamiltonian_.inverse_masses.array().sqrt();
  }

  /// Doubled or halved from `step` until one step is accepted about as often as wanted.
  double findStepSize(double step) {
    constexpr int kMax = 60;
    State from = state_;
    drawMomentum(from);
    const double energy = hamiltonian_.calcEnergy(from);
    const auto calcGain = [&](double size) {
      const double gain = energy - hamiltonian_.calcEnergy(hamiltonian_.move(from, size));
      return std::isfinite(gain) ? gain : -kInfinite;
    };
    const double wanted = std::log(options_.acceptance);
    const bool grows = calcGain(step) > wanted;
    for (int i = 0; i < kMax; ++i) {
      step *= grows ? 2.0 : 0.5;
      if ((calcGain(step) > wanted) != grows) {
        break;
      }
    }
    return step;
  }

  void warmUp() {
    step_size_ = findStepSize(1.0);
    StepSize adapted(step_size_, options_.acceptance);
    Variances variances(state_.position.size());
    const std::vector<int> ends = listWindowEnds(options_.warm_up);
    const int begin = static_cast<int>(0.15 * options_.warm_up);
    std::size_t window = 0;
    for (int i = 0; i < options_.warm_up; ++i) {
      adapted.update(calcMean(step(adapted.get(), nullptr)));
      if (i >= begin && window < ends.size()) {
        variances.add(state_.position);
      }
      if (window < ends.size() && i + 1 == ends[window]) {
        hamiltonian_.inverse_masses = variances.calculate();
        variances = Variances(state_.position.size());
        adapted = StepSize(findStepSize(adapted.getMean()), options_.acceptance);
        ++window;
      }
    }
    step_size_ = adapted.getMean();
    chain_.draws.resize(state_.position.size(), options_.draws);
  }

  /// One step of the chain; counts in `chain` if it is kept.
  Acceptance step(double step_size, Chain* chain) {
    gp::throwIfStopped(options_.stop);
    drawMomentum(state_);
    Trajectory trajectory(hamiltonian_, step_size, hamiltonian_.calcEnergy(state_), uniform_);
    Segment all{state_, state_, state_.momentum, state_, 0.0, true, false};
    int depth = 0;
    for (; depth < options_.deepest && all.complete; ++depth) {
      const bool forwards = uniform_() < 0.5;
      Segment more = trajectory.extend(forwards ? all.last : all.first, depth, forwards);
      if (!more.complete) {
        all.diverged = more.diverged;
        break;
      }
      // in favour of the new half, which is farther from where the chain is
      const bool take_new = std::log(uniform_()) < more.log_weight - all.log_weight;
      all = forwards ? trajectory.join(std::move(all), std::move(more), take_new)
                     : trajectory.join(std::move(more), std::move(all), !take_new);
    }
    if (chain != nullptr) {
      chain->divergences += all.diverged ? 1 : 0;
      chain->cut += depth == options_.deepest && all.complete ? 1 : 0;
    }
    state_ = std::move(all.draw);
    return trajectory.acceptance;
  }

  const NutsOptions& options_;
  const ChainNumbers& numbers_;
  Hamiltonian hamiltonian_;
  Index normals_ = 0, uniforms_ = 0;
  const std::function<double()> uniform_;
  State state_;
  double step_size_ = 1.0;
  Chain chain_;
};

}  // namespace

Chain sampleNuts(const LogDensity& density, const VectorXd& start, const ChainNumbers& numbers,
                 const NutsOptions& options) {
  return Sampler(density, start, numbers, options).run();
}

}  // namespace twinmap::markov
