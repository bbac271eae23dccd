// Simulation in lanes against MuJoCo's Runge-Kutta method at equal error, and against Simbody; one thread,
// processor time. Then what a second thread brings, on the wall. See bench/README.md.
// Usage: mujoco_benchmark [rounds]

#include <fmt/core.h>

#include <cstdlib>
#include <exception>
#include <stdexcept>

#include "bench/simulation/measure.hpp"
#include "bench/simulation/mujoco_simulation.hpp"
#include "bench/simulation/report.hpp"
#include "framework/design/experiment_points.hpp"
#include "framework/features/feature_extractor.hpp"
#include "framework/multibody/multibody_simulator.hpp"
#include "framework/simulation/sample_generator.hpp"
#include "framework/spec/experiment_file.hpp"
#include "framework/spec/parameter_box.hpp"

namespace twinmap::bench {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kErrorPoints = 12;     // where errors are looked at
constexpr int kLanePoints = 256;     // two batches in lanes
constexpr int kSinglePoints = 4;     // of a side that simulates one after the other: some 20 ms
constexpr int kThreadPoints = 8192;  // some 0.4 s on one thread, long beside starting a thread
constexpr int kFinestSteps = 4096;   // of MuJoCo between two output times
constexpr double kAgreement = 0.05;  // of its error is left with a quarter of the step; order 4: 0.004

ExperimentSpec load(const Mechanism& mechanism, int points) {
  return loadExperiment(mechanism.experiment,
                        {"design.test.method=uniform", "design.test.samples=" + std::to_string(points)});
}

/// Column by column, in batches.
MatrixXd simulate(MultibodySimulator& simulator, const MatrixXd& points) {
  MatrixXd responses(simulator.getLayout().getRowCount(), points.cols());
  std::vector<SampleStatus> statuses(points.cols());
  for (Index i = 0; i < points.cols(); i += simulator.getBatchSize()) {
    const Index count = std::min<Index>(simulator.getBatchSize(), points.cols() - i);
    simulator.simulate(points.middleCols(i, count), responses.middleCols(i, count), &statuses[i]);
  }
  for (const SampleStatus& status : statuses) {
    if (!status.ok) {
      throw std::runtime_error(status.reason);
    }
  }
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
}

/// A mechanism with its simulators.
class Case {
 public:
  explicit Case(const Mechanism& mechanism)
      : mechanism_(mechanism),
        experiment_(load(mechanism, kLanePoints)),
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

void compareThreads(const Mechanism& mechanism, int rounds) {
  const ExperimentSpec experiment = load(mechanism, kThreadPoints);
  const MultibodySimulator simulator(experiment.model, collectTimes(experiment.features));
  const MatrixXd points = sampleTestPoints(experiment);
  const auto run = [&](int threads) {
    GeneratorOptions options;
    options.threads = threads;
    return Side{kThreadPoints,
                [&simulator, &points, options] { generateSamples(simulator, points, options); }};
  };
  const std::vector<double> times = measureInAlternation({run(1), run(2)}, rounds, readWallTime);
  fmt::print("\n{}, {} samples, on the wall: {:.1f} us a sample on one thread, {:.1f} on two: {:.2f} times\n",
             mechanism.name, kThreadPoints, times[0], times[1], times[0] / times[1]);
}

void run(int rounds) {
  fmt::print("MuJoCo {}; medians of {} rounds in alternation\n\n", mj_versionString(), rounds);
  const std::vector<Mechanism> mechanisms = makeMechanisms();
  std::vector<Comparison> comparisons;
  for (const Mechanism& mechanism : mechanisms) {
    comparisons.push_back(Case(mechanism).compare(rounds));
  }
  printComparisons(comparisons);
  printLanes(comparisons);
  printPrograms(comparisons, measureMultiplyAdds(kLanePoints), measureSines(kLanePoints));
  compareThreads(mechanisms.front(), rounds);
}

}  // namespace
}  // namespace twinmap::bench

int main(int count, char** arguments) {
  constexpr int kFewestRounds = 5;
  try {
    twinmap::bench::run(std::max(kFewestRounds, count > 1 ? std::atoi(arguments[1]) : 7));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
