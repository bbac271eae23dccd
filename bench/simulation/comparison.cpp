#include "bench/simulation/comparison.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "bench/simulation/compared_case.hpp"
#include "bench/simulation/measure.hpp"
#include "bench/simulation/mujoco_simulation.hpp"

namespace twinmap::bench {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr int kLanePoints = 256;     // two batches in lanes
constexpr int kSinglePoints = 4;     // of a side that simulates one after the other: some 20 ms
constexpr int kFinestSteps = 4096;   // of MuJoCo between two output times
constexpr double kAgreement = 0.05;  // of its error is left with a quarter of the step; order 4: 0.004

void simulateWithDerivatives(MultibodySimulator& simulator, const MatrixXd& points) {
  MatrixXd responses(simulator.getLayout().getRowCount(), points.cols()), derivatives;
  std::vector<SampleStatus> statuses(points.cols());
  for (Index i = 0; i < points.cols(); i += simulator.getBatchSize()) {
    const Index count = std::min<Index>(simulator.getBatchSize(), points.cols() - i);
    simulator.simulateWithDerivatives(points.middleCols(i, count), responses.middleCols(i, count),
                                      derivatives, &statuses[i]);
  }
  requireSuccess(statuses);
}

/// A mechanism with its simulators.
class Measured {
 public:
  explicit Measured(const Mechanism& mechanism)
      : mechanism_(mechanism),
        case_(mechanism, kLanePoints),
        points_(case_.getPoints()),
        lanes_(make(Engine::kLanes)),
        simbody_(make(Engine::kSimbody)),
        mujoco_(mechanism, case_.calcStart(), case_.getTimes()) {}

  Comparison compare(int rounds) {
    Comparison c;
    c.name = mechanism_.name;
    c.directions = static_cast<int>(points_.rows());
    c.lane_error = case_.calcError([&](Index i) { return simulateAll(*lanes_, points_.col(i)); });
    c.simbody_error = case_.calcError([&](Index i) { return simulateAll(*simbody_, points_.col(i)); });
    const int steps = chooseSteps(c.lane_error);
    c.mujoco_error = calcMujocoError(steps);
    c.mujoco_step = mujoco_.getInterval() / steps;
    c.fine_mujoco_error = calcMujocoError(4 * steps);
    checkAgreement(c);
    measure(steps, rounds, c);
    c.profile =
        measureLanes(case_.getExperiment().model, case_.getTimes(), points_.leftCols(lanes_->getBatchSize()));
    return c;
  }

 private:
  std::unique_ptr<MultibodySimulator> make(Engine engine) const {
    ModelSpec model = case_.getExperiment().model;
    model.simulation.engine = engine;
    return std::make_unique<MultibodySimulator>(model, case_.getTimes());
  }

  double calcMujocoError(int steps) {
    return case_.calcError([&](Index i) { return mujoco_.simulate(points_.col(i), steps); });
  }

  /// The fewest steps between output times with which MuJoCo's error is not above `error`.
  int chooseSteps(double error) {
    int enough = 1;
    while (enough < kFinestSteps && !(calcMujocoError(enough) <= error)) {
      enough *= 2;
    }
    int too_few = enough / 2;
    while (enough - too_few > 1) {
      const int middle = (enough + too_few) / 2;
      (calcMujocoError(middle) <= error ? enough : too_few) = middle;
    }
    return enough;
  }

  void checkAgreement(const Comparison& c) const {
    if (!(c.mujoco_error <= c.lane_error) || !(c.fine_mujoco_error <= kAgreement * c.mujoco_error)) {
      throw std::runtime_error(fmt::format(
          "{}: MuJoCo simulates another mechanism: its responses differ by {:.1e} of the range with steps of "
          "{:.2e} s, by {:.1e} with a quarter",
          c.name, c.mujoco_error, c.mujoco_step, c.fine_mujoco_error));
    }
  }

  void measure(int steps, int rounds, Comparison& c) {
    const auto run_mujoco = [&] {
      for (Index i = 0; i < kSinglePoints; ++i) {
        mujoco_.simulate(points_.col(i), steps);
      }
    };
    const MatrixXd few = points_.leftCols(kSinglePoints);
    const std::vector<double> times =
        measureInAlternation({{kSinglePoints, run_mujoco},
                              {kLanePoints, [&] { simulateAll(*lanes_, points_); }},
                              {kSinglePoints, [&] { simulateAll(*simbody_, few); }},
                              {kLanePoints, [&] { simulateWithDerivatives(*lanes_, points_); }}},
                             rounds, readThreadTime);
    c.mujoco_time = times[0];
    c.lane_time = times[1];
    c.simbody_time = times[2];
    c.derivative_time = times[3];
  }

  const Mechanism& mechanism_;
  const ComparedCase case_;
  const MatrixXd points_;
  const std::unique_ptr<MultibodySimulator> lanes_, simbody_;
  MujocoSimulation mujoco_;
};

}  // namespace

double Comparison::calcMujocoTimeAtEqualError() const {
  return mujoco_time * std::pow(mujoco_error / lane_error, 0.25);
}

Comparison compare(const Mechanism& mechanism, int rounds) {
  return Measured(mechanism).compare(rounds);
}

}  // namespace twinmap::bench
