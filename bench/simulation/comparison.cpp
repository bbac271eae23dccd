#include "bench/simulation/comparison.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "bench/simulation/measure.hpp"
#include "bench/simulation/mujoco_simulation.hpp"
#include "framework/data/features/feature_extractor.hpp"
#include "framework/experiment/experiment_file.hpp"
#include "framework/experiment/points/experiment_points.hpp"
#include "framework/models/mechanism/multibody_simulator.hpp"

namespace twinmap::bench {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kErrorPoints = 12;     // where errors are looked at
constexpr int kLanePoints = 256;     // two batches in lanes
constexpr int kSinglePoints = 4;     // of a side that simulates one after the other: some 20 ms
constexpr int kFinestSteps = 4096;   // of MuJoCo between two output times
constexpr double kAgreement = 0.05;  // of its error is left with a quarter of the step; order 4: 0.004

void check(const std::vector<SampleStatus>& statuses) {
  for (const SampleStatus& status : statuses) {
    if (!status.ok) {
      throw std::runtime_error("a simulation failed: " + status.reason);
    }
  }
}

/// Column by column, in batches.
MatrixXd simulate(MultibodySimulator& simulator, const MatrixXd& points) {
  MatrixXd responses(simulator.getLayout().getRowCount(), points.cols());
  std::vector<SampleStatus> statuses(points.cols());
  for (Index i = 0; i < points.cols(); i += simulator.getBatchSize()) {
    const Index count = std::min<Index>(simulator.getBatchSize(), points.cols() - i);
    simulator.simulate(points.middleCols(i, count), responses.middleCols(i, count), &statuses[i]);
  }
  check(statuses);
  return responses;
}

void simulateWithDerivatives(MultibodySimulator& simulator, const MatrixXd& points) {
  MatrixXd responses(simulator.getLayout().getRowCount(), points.cols()), derivatives;
  std::vector<SampleStatus> statuses(points.cols());
  for (Index i = 0; i < points.cols(); i += simulator.getBatchSize()) {
    const Index count = std::min<Index>(simulator.getBatchSize(), points.cols() - i);
    simulator.simulateWithDerivatives(points.middleCols(i, count), responses.middleCols(i, count),
                                      derivatives, &statuses[i]);
  }
  check(statuses);
}

/// A mechanism with its simulators.
class Case {
 public:
  explicit Case(const Mechanism& mechanism)
      : mechanism_(mechanism),
        experiment_(loadMechanism(mechanism, kLanePoints)),
        times_(collectTimes(experiment_.features)),
        points_(sampleTestPoints(experiment_)),
        lanes_(make(Engine::kLanes)),
        simbody_(make(Engine::kSimbody)),
        reference_(makeReference()),
        mujoco_(mechanism, calcStart(), times_) {}

  Comparison compare(int rounds) {
    Comparison c;
    c.name = mechanism_.name;
    c.directions = static_cast<int>(points_.rows());
    const MatrixXd few = points_.leftCols(kErrorPoints);
    c.lane_error = calcError([&](Index i) { return simulate(*lanes_, few.col(i)); });
    c.simbody_error = calcError([&](Index i) { return simulate(*simbody_, few.col(i)); });
    const int steps = chooseSteps(c.lane_error);
    c.mujoco_error = calcMujocoError(steps);
    c.mujoco_step = mujoco_.getInterval() / steps;
    c.fine_mujoco_error = calcMujocoError(4 * steps);
    checkAgreement(c);
    measure(steps, rounds, c);
    c.profile = measureLanes(experiment_.model, times_, points_.leftCols(lanes_->getBatchSize()));
    return c;
  }

 private:
  std::unique_ptr<MultibodySimulator> make(Engine engine) const {
    ModelSpec model = experiment_.model;
    model.simulation.engine = engine;
    return std::make_unique<MultibodySimulator>(model, times_);
  }

  MatrixXd makeReference() const {
    ModelSpec model = experiment_.model;
    model.simulation.relative_tolerance = 1e-12;
    model.simulation.absolute_tolerance = 1e-14;
    MultibodySimulator simulator(model, times_);
    return simulate(simulator, points_.leftCols(kErrorPoints));
  }

  /// Coordinates at t = 0, the same for all points: the outputs are the coordinates.
  VectorXd calcStart() const {
    MultibodySimulator simulator(experiment_.model, VectorXd::Zero(1));
    return simulate(simulator, points_.leftCols(1));
  }

  template <typename Simulate>
  double calcError(const Simulate& simulate) const {
    double largest = 0.0;
    for (Index i = 0; i < kErrorPoints; ++i) {
      const MatrixXd expected = reference_.col(i).reshaped(times_.size(), reference_.rows() / times_.size());
      const MatrixXd found = simulate(i).reshaped(expected.rows(), expected.cols());
      const auto range = expected.colwise().maxCoeff() - expected.colwise().minCoeff();
      const auto error = (found - expected).cwiseAbs().colwise().maxCoeff();
      largest = std::max(largest, error.cwiseQuotient(range).maxCoeff());
    }
    return largest;
  }

  double calcMujocoError(int steps) {
    return calcError([&](Index i) { return mujoco_.simulate(points_.col(i), steps); });
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
                              {kLanePoints, [&] { simulate(*lanes_, points_); }},
                              {kSinglePoints, [&] { simulate(*simbody_, few); }},
                              {kLanePoints, [&] { simulateWithDerivatives(*lanes_, points_); }}},
                             rounds, readThreadTime);
    c.mujoco_time = times[0];
    c.lane_time = times[1];
    c.simbody_time = times[2];
    c.derivative_time = times[3];
  }

  const Mechanism& mechanism_;
  const ExperimentSpec experiment_;
  const VectorXd times_;
  const MatrixXd points_;
  const std::unique_ptr<MultibodySimulator> lanes_, simbody_;
  const MatrixXd reference_;
  MujocoSimulation mujoco_;
};

}  // namespace

double Comparison::calcMujocoTimeAtEqualError() const {
  return mujoco_time * std::pow(mujoco_error / lane_error, 0.25);
}

ExperimentSpec loadMechanism(const Mechanism& mechanism, int points) {
  return loadExperiment(mechanism.experiment,
                        {"design.test.method=uniform", "design.test.samples=" + std::to_string(points)});
}

Comparison compare(const Mechanism& mechanism, int rounds) {
  return Case(mechanism).compare(rounds);
}

}  // namespace twinmap::bench
