#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstdlib>

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/fmu/fmu_simulator.hpp"
#include "framework/simulation/stencil.hpp"
#include "tests/framework/models/fmu/fmu_case.hpp"

namespace twinmap::testing {
namespace {

using Complex = std::complex<double>;

/// x'' = -c x - d x' + F from x(0) = start at rest: {x, d x'^2}.
std::array<Complex, 2> solve(const std::array<Complex, 4>& point, double t) {
  const auto& [c, d, start, force] = point;
  const Complex rest = force / c, decay = 0.5 * d, omega = std::sqrt(c - decay * decay);
  const Complex envelope = (start - rest) * std::exp(-decay * t);
  const Complex x = rest + envelope * (std::cos(omega * t) + decay / omega * std::sin(omega * t));
  const Complex v = -envelope * (decay * decay / omega + omega) * std::sin(omega * t);
  return {x, d * v * v};
}

ParameterSpec makeParameter(const std::string& name, double lower, double upper,
                            const std::string& unit = "") {
  return {{name, {}}, {lower, upper, {}}, unit, "", RelativeTo::kRange, {}};
}

ModelSpec makeOscillator(const std::string& fmu, std::vector<ParameterSpec> parameters) {
  ModelSpec model;
  FmuSpec& spec = model.source.emplace().fmu.emplace();
  spec.file = {findFmu(fmu), {}};
  spec.kind = FmuKind::kModelExchange;
  model.parameters = std::move(parameters);
  for (const char* name : {"x", "p"}) {
    OutputSpec output;
    output.name = {name, {}};
    output.variable = Name{name, {}};
    output.unit = name == std::string("x") ? "m" : "";
    model.outputs.push_back(output);
  }
  model.simulation.duration = 2.0;
  return model;
}

std::vector<ParameterSpec> makeAll() {
  return {makeParameter("c", 30, 50), makeParameter("d", 0.3, 0.7), makeParameter("x", 0.05, 0.2, "m"),
          makeParameter("F", -5, 5)};
}

struct Derived {
  SampleStatus status;
  Eigen::MatrixXd response, derivatives;
};

class DirectionalDerivatives : public ::testing::Test {
 protected:
  void SetUp() override { setenv("TWINMAP_WORKER", TWINMAP_EXECUTABLE, 1); }

  static const Eigen::VectorXd& getTimes() {
    static const Eigen::VectorXd kTimes = Eigen::VectorXd::LinSpaced(20, 0.1, 2.0);
    return kTimes;
  }

  static Derived derive(FmuSimulator& simulator, const Eigen::VectorXd& point) {
    Derived derived;
    derived.response.resize(simulator.getLayout().getRowCount(), 1);
    simulator.simulateWithDerivatives(point, derived.response, derived.derivatives, &derived.status);
    return derived;
  }
};

TEST_F(DirectionalDerivatives, AreThoseOfTheClosedForm) {
  FmuSimulator simulator(makeOscillator("oscillator_3", makeAll()), getTimes(), 0);
  ASSERT_TRUE(simulator.hasDerivatives());
  const Eigen::Vector4d point(44.0, 0.4, 0.12, 2.0);
  const Derived derived = derive(simulator, point);
  ASSERT_TRUE(derived.status.ok) << derived.status.reason;
  constexpr double kImaginary = 1e-20;  // of the complex step, whose derivative is exact
  const Eigen::Index times = getTimes().size();
  for (int k = 0; k < 4; ++k) {
    std::array<Complex, 4> complex{point[0], point[1], point[2], point[3]};
    complex[k] += Complex(0.0, kImaginary);
    const double largest = derived.derivatives.col(k).lpNorm<Eigen::Infinity>();
    for (Eigen::Index i = 0; i < times; ++i) {
      const std::array<Complex, 2> truth = solve(complex, getTimes()[i]);
      EXPECT_NEAR(derived.derivatives(i, k), truth[0].imag() / kImaginary, 3e-6 * largest) << k << " " << i;
      EXPECT_NEAR(derived.derivatives(times + i, k), truth[1].imag() / kImaginary, 3e-6 * largest)
          << k << " " << i;
    }
  }
}

TEST_F(DirectionalDerivatives, BelongToTheResponseThatSimulateGives) {
  FmuSimulator simulator(makeOscillator("oscillator_3", makeAll()), getTimes(), 0);
  const Eigen::Vector4d point(44.0, 0.4, 0.12, 2.0);
  Eigen::MatrixXd response(simulator.getLayout().getRowCount(), 1);
  SampleStatus status;
  simulator.simulate(point, response, &status);
  EXPECT_EQ(response, derive(simulator, point).response);
}

TEST_F(DirectionalDerivatives, ThatAreWrongAreFoundAndReplacedByDifferences) {
  FmuSimulator right(makeOscillator("oscillator_3", makeAll()), getTimes(), 0);
  FmuSimulator wrong(makeOscillator("oscillator_wrong", makeAll()), getTimes(), 0);
  const Eigen::Vector4d point(44.0, 0.4, 0.12, 2.0);
  const Eigen::MatrixXd exact = derive(right, point).derivatives;
  const Derived differences = derive(wrong, point);
  ASSERT_TRUE(differences.status.ok) << differences.status.reason;
  for (int k = 0; k < 4; ++k) {
    EXPECT_LT((exact - differences.derivatives).col(k).lpNorm<Eigen::Infinity>(),
              1e-5 * exact.col(k).lpNorm<Eigen::Infinity>());
    EXPECT_NE(exact.col(k), differences.derivatives.col(k));
  }
}

TEST_F(DirectionalDerivatives, OfFmi2AreThoseByInputsAndStartValuesOnly) {
  EXPECT_FALSE(FmuSimulator(makeOscillator("oscillator_2", makeAll()), getTimes(), 0).hasDerivatives());
  const std::vector<ParameterSpec> all = makeAll();
  FmuSimulator simulator(makeOscillator("oscillator_2", {all[2], all[3]}), getTimes(), 0);
  ASSERT_TRUE(simulator.hasDerivatives());
  const Derived derived = derive(simulator, Eigen::Vector2d(0.12, 2.0));
  ASSERT_TRUE(derived.status.ok) << derived.status.reason;
  std::array<Complex, 4> complex{40.0, 0.5, 0.12, Complex(2.0, 1e-20)};
  EXPECT_NEAR(derived.derivatives(19, 1), solve(complex, 2.0)[0].imag() / 1e-20, 1e-7);
}

TEST_F(DirectionalDerivatives, AreNotOfferedWhereAParameterIsAlsoPartOfAnExpression) {
  ModelSpec model = makeOscillator("oscillator_3", makeAll());
  model.outputs[0].gain = {"1 + c / 100", {}};
  EXPECT_FALSE(FmuSimulator(model, getTimes(), 0).hasDerivatives());
}

TEST_F(DirectionalDerivatives, AreNotOfferedInCoSimulation) {
  ModelSpec model = makeOscillator("oscillator_3", makeAll());
  model.source->fmu->kind = FmuKind::kCoSimulation;
  EXPECT_FALSE(FmuSimulator(model, getTimes(), 0).hasDerivatives());
}

/// Derivatives of x by c and d in Co-Simulation at some points, from neighbours as the framework makes them:
/// around their centre, or each by itself.
Eigen::MatrixXd calcByNeighbours(const std::string& fmu, const Eigen::VectorXd& times, bool around = true) {
  const std::vector<ParameterSpec> parameters{makeParameter("c", 30, 50), makeParameter("d", 0.3, 0.7)};
  ModelSpec model = makeOscillator(fmu, parameters);
  FmuSpec& spec = *model.source->fmu;
  spec.kind = FmuKind::kCoSimulation;
  spec.step = 0.1;
  FmuSimulator simulator(model, times, 0);
  constexpr int kPoints = 5;
  Eigen::MatrixXd derivatives(kPoints * times.size(), 2);
  for (int i = 0; i < kPoints; ++i) {
    const Eigen::Vector2d point(36.0 + 2.1 * i, 0.35 + 0.07 * i);
    const Eigen::MatrixXd points = makeNeighbours(parameters, point);
    Eigen::MatrixXd responses(simulator.getLayout().getRowCount(), points.cols());
    std::vector<SampleStatus> statuses(points.cols());
    around ? simulator.simulateAround(points, responses, statuses.data())
           : simulator.simulate(points, responses, statuses.data());
    EXPECT_TRUE(statuses.back().ok) << statuses.back().reason;
    derivatives.middleRows(i * times.size(), times.size()) =
        calcDifferences(responses, parameters, point).topRows(times.size());
  }
  return derivatives;
}

TEST_F(DirectionalDerivatives, OfANoisySolverAreDifferencesOverWiderSteps) {
  const Eigen::MatrixXd smooth = calcByNeighbours("oscillator_3", getTimes());
  const Eigen::MatrixXd around = calcByNeighbours("oscillator_noisy", getTimes());
  const Eigen::MatrixXd alone = calcByNeighbours("oscillator_noisy", getTimes(), false);
  const auto calcError = [&](const Eigen::MatrixXd& derivatives, int k) {
    return (derivatives - smooth).col(k).lpNorm<Eigen::Infinity>() / smooth.col(k).lpNorm<Eigen::Infinity>();
  };
  for (int k = 0; k < 2; ++k) {
    EXPECT_LT(calcError(around, k), 0.01) << k;
    EXPECT_LT(calcError(around, k), 0.1 * calcError(alone, k)) << k;
  }
}

}  // namespace
}  // namespace twinmap::testing
