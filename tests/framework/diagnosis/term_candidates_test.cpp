#include "framework/diagnosis/candidates/term_candidates.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "framework/data/features/experiment_features.hpp"
#include "framework/diagnosis/candidates/augment.hpp"
#include "framework/diagnosis/candidates/replace_name.hpp"
#include "framework/diagnosis/candidates/split_sum.hpp"
#include "framework/experiment/check/check_experiment.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/make_simulator.hpp"
#include "tests/framework/diagnosis/measured_cart.hpp"
#include "tests/framework/experiment/experiments.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::string findMechanism(const std::string& name) {
  return std::string(TWINMAP_SOURCE_DIR) + "/experiments/mechanisms/" + name + ".yaml";
}

std::vector<TermCandidate> listAtCenter(const ExperimentSpec& experiment) {
  return listCandidates(experiment,
                        calcModelSizes(experiment, calcBoxCenter(collectSampled(experiment.model))));
}

const TermCandidate& find(const std::vector<TermCandidate>& candidates, const std::string& term) {
  const auto found = std::find_if(candidates.begin(), candidates.end(),
                                  [&](const TermCandidate& one) { return one.term == term; });
  EXPECT_NE(found, candidates.end()) << term;
  return *found;
}

TEST(ReplaceName, ReplacesWholeWords) {
  EXPECT_EQ(replaceName("F - k*F2 + dF*F_x/F", "F", "(2*F)"), "(2*F) - k*F2 + dF*F_x/(2*F)");
  EXPECT_EQ(replaceName("1e3*e3", "e3", "x"), "1e3*x");
}

TEST(SplitSum, FindsSummandsWithTheirSigns) {
  using Sum = std::vector<std::string>;
  EXPECT_EQ(splitSum("u - W*sin(q - 1)"), (Sum{"u", "-(W*sin(q - 1))"}));
  EXPECT_EQ(splitSum("-(a - (b + c)) + 2e-3*d"), (Sum{"-(a)", "b", "c", "2e-3*d"}));
  EXPECT_EQ(splitSum("k*-q^-2 - - x"), (Sum{"k*-q^-2", "x"}));
  EXPECT_EQ(splitSum("(a + b)*(c + d)"), (Sum{"(a + b)*(c + d)"}));
  EXPECT_EQ(splitSum("q > 0 ? a - b : c"), (Sum{"q > 0 ? a - b : c"}));
  EXPECT_EQ(splitSum("u - (q > 0 ? a - b : c)"), (Sum{"u", "-(q > 0 ? a - b : c)"}));
  EXPECT_EQ(splitSum("F1e-F2"), (Sum{"F1e", "-(F2)"}));
}

/// The level of the friction on a coordinate with a candidate of coefficient c.
std::string writeLevel(const ExperimentSpec& experiment, const std::string& term) {
  const TermCandidate candidate = find(listAtCenter(experiment), term);
  ModelSpec model = experiment.model;
  candidate.add(model, "c", {});
  return model.system.elements.get<Friction>().front().coulomb.text;
}

// A servo on a position loop: gravity of its body and a spring are what it carries, the loop drives it.
TEST(Candidates, TellWhatACoordinateCarriesFromWhatDrivesIt) {
  const std::string file = findMechanism("released_pendulum");
  const std::string friction = "system.friction=[{coordinate: angle, model: coulomb, coulomb: 0.01}]";
  const std::string signal = "excitation={r: {unit: rad, sines: [{amplitude: 1, frequency: 1}]}}";
  const ExperimentSpec hanging = loadExperiment(file, {friction});
  EXPECT_EQ(writeLevel(hanging, "load_friction.angle"), "max(0.01 + c*abs(angle_gravity), 0)");
  const std::vector<TermCandidate> candidates = listAtCenter(hanging);
  EXPECT_TRUE(std::none_of(candidates.begin(), candidates.end(),
                           [](const TermCandidate& one) { return one.term == "load_friction.x"; }));
  const ExperimentSpec servo = loadExperiment(
      file, {friction, signal, "system.expressions={drive: 0.3*(r - angle) - 0.1*sin(angle)}",
             "system.force_laws=[{coordinate: angle, force: drive - 0.01*angle_dot - 0.2*angle}]"});
  EXPECT_EQ(writeLevel(servo, "load_friction.angle"),
            "max(0.01 + c*abs(-(0.1*sin(angle)) + -(0.2*angle) + angle_gravity), 0)");
  EXPECT_EQ(writeLevel(servo, "drive_friction.angle"), "max(0.01 + c*abs(0.3*(r - angle)), 0)");
}

// What was found beside a lag of the drive, in a model without it.
TEST(Candidates, GrowWithTheDriveThatIsThere) {
  const ExperimentSpec cart = loadExperiment(kCart);
  const TermCandidate lag = find(listAtCenter(cart), "lag.F");
  const ExperimentSpec lagging = addTerm(cart, lag, lag.size).experiment;
  const TermCandidate friction = find(listAtCenter(lagging), "drive_friction.x");
  for (const ExperimentSpec& experiment : {lagging, cart}) {
    EXPECT_NO_THROW(checkExperiment(addTerm(experiment, friction, friction.size).experiment));
  }
}

// Units, names and references of each are right, alone and all together.
TEST(Candidates, MakeExperimentsThatPassTheChecks) {
  for (const std::string& file :
       {kCart, kTable1, findMechanism("double_pendulum_mild"), findMechanism("spatial_arm"),
        findMechanism("released_pendulum"), findMechanism("servo_axis"), findMechanism("stick_slip"),
        findMechanism("dry_belt")}) {
    const ExperimentSpec experiment = loadExperiment(file);
    const std::vector<TermCandidate> candidates = listAtCenter(experiment);
    EXPECT_GT(candidates.size(), 20U);
    EXPECT_NO_THROW(checkExperiment(addAll(experiment, candidates).experiment)) << file;
    for (const TermCandidate& candidate : candidates) {
      const ExperimentSpec augmented = addTerm(experiment, candidate, candidate.size).experiment;
      EXPECT_NO_THROW(checkExperiment(augmented)) << file << " " << candidate.term;
    }
  }
}

TEST(Candidates, CoverCoordinatesBodiesSensorsAndSignals) {
  const std::vector<TermCandidate> candidates = listAtCenter(loadExperiment(kTable1));
  for (const char* term : {"drag.y", "coulomb.theta", "stop.y", "mass.beam2", "center_y.beam2", "tilt.x",
                           "offset.theta", "gain.y", "gain.F", "delay.M", "clipping.y"}) {
    find(candidates, term);
  }
}

// The reference of a servo stands in a named expression alone.
TEST(Candidates, ChangeSignalsInNamedExpressionsToo) {
  const ExperimentSpec servo = loadExperiment(findMechanism("servo_axis"));
  const std::vector<TermCandidate> candidates = listAtCenter(servo);
  const ExperimentSpec changed = addTerm(servo, find(candidates, "gain.r"), 0.1).experiment;
  EXPECT_NE(changed.model.system.expressions.front().value.text,
            servo.model.system.expressions.front().value.text);
}

VectorXd simulateAtCenter(const ExperimentSpec& experiment) {
  const ResponseLayout layout = makeLayout(experiment);
  MatrixXd response(layout.getRowCount(), 1);
  SampleStatus status;
  makeTrustedSimulator(experiment.model, layout.times)
      ->simulate(calcBoxCenter(experiment.model.parameters), response, &status);
  EXPECT_TRUE(status.ok) << status.reason;
  return response.col(0);
}

/// The response of the cart with a term of some size, its own scale as it is scanned.
VectorXd simulateWith(const ExperimentSpec& experiment, const TermCandidate& candidate, double size) {
  const AugmentedExperiment augmented = addTerm(experiment, candidate, 1e3 * candidate.size);
  const ResponseLayout layout = makeLayout(experiment);
  VectorXd point(augmented.experiment.model.parameters.size());
  point.head(static_cast<Index>(experiment.model.parameters.size())) =
      calcBoxCenter(experiment.model.parameters);
  auto p = static_cast<Index>(experiment.model.parameters.size());
  point[p] = size;
  for (const OwnScale& scale : candidate.own_scales) {
    point[++p] = scale.value;
  }
  MatrixXd response(layout.getRowCount(), 1);
  SampleStatus status;
  makeTrustedSimulator(augmented.experiment.model, layout.times)->simulate(point, response, &status);
  EXPECT_TRUE(status.ok) << status.reason;
  return response.col(0);
}

// With c = 1 the term is what it says.
TEST(Candidates, HoldAndLimitSignalsAndOutputs) {
  const auto load = [&](const char* more) {
    return loadExperiment(kCart,
                          {fmt::format("excitation={{F: {{unit: N, tables: [{{times: [0, 0.7, 2, 3, 5], "
                                       "values: [0, 2, -2, 1, 0]{}}}]}}}}",
                                       more)});
  };
  const ExperimentSpec bent = load("");
  const std::vector<TermCandidate> candidates = listAtCenter(bent);
  const VectorXd held = simulateAtCenter(load(", interpolation: hold"));
  EXPECT_LT((simulateWith(bent, find(candidates, "hold.F"), 1.0) - held).norm(), 1e-5 * held.norm());

  ExperimentSpec limited = bent;
  const TermCandidate& clipping = find(candidates, "clipping.F");
  EXPECT_NEAR(clipping.own_scales.front().value, 1.1, 1e-9);
  limited.model.system.elements.get<ForceLaw>().front().force.text = "min(max(F, -1.1), 1.1) - k3*x^3";
  const VectorXd clipped = simulateAtCenter(limited);
  EXPECT_LT((simulateWith(bent, clipping, 1.0) - clipped).norm(), 1e-5 * clipped.norm());
  limited.model.system.elements.get<ForceLaw>().front().force.text =
      "max(F - 0.2, 0) + min(F + 0.2, 0) - k3*x^3";
  const VectorXd dead = simulateAtCenter(limited);
  EXPECT_LT((simulateWith(bent, find(candidates, "dead_zone.F"), 1.0) - dead).norm(), 1e-5 * dead.norm());

  const TermCandidate& sensor = find(candidates, "clipping.x");
  const VectorXd motion = simulateAtCenter(bent);
  const double limit = sensor.own_scales.front().value;
  EXPECT_LT((simulateWith(bent, sensor, 1.0) - motion.cwiseMin(limit).cwiseMax(-limit)).norm(),
            1e-5 * motion.norm());
}

// Of two tests, one four times as large: from the smaller one's limits to the larger one's.
TEST(Candidates, LimitsSpanTheExtentsOfAllTrials) {
  const ExperimentSpec experiment = loadExperiment(kCart);
  ModelSizes sizes = calcModelSizes(experiment, kTrueCart);
  sizes.signals.front() = {4.0, 1.0};
  std::vector<double> limits;
  for (const TermCandidate& one : listSignalCandidates(experiment.model, sizes)) {
    if (one.term == "clipping.F") {
      limits.push_back(one.own_scales.front().value);
    }
  }
  ASSERT_EQ(limits.size(), 5U);
  EXPECT_NEAR(limits.front(), 0.55, 1e-12);
  EXPECT_NEAR(limits.back(), 0.88 * 4.0, 1e-12);
  EXPECT_LE(limits[1] / limits[0], 1.6);
}

// Exact derivatives at 0 against differences of simulations, each with the term alone.
TEST(Candidates, AreStartsWhereTheseAreNotUnknownAnyway) {
  const auto count_starts = [](const ExperimentSpec& experiment) {
    const std::vector<TermCandidate> candidates = listAtCenter(experiment);
    return std::count_if(candidates.begin(), candidates.end(),
                         [](const TermCandidate& one) { return one.term.rfind("start", 0) == 0; });
  };
  EXPECT_EQ(count_starts(loadExperiment(kCart)), 2);
  const std::vector<std::string> unknown{"nuisance.x0={bounds: [-1, 1], unit: m}",
                                         "initial.coordinates={x: 2*x0}"};
  EXPECT_EQ(count_starts(loadExperiment(kCart, unknown)), 1);
}

TEST(Candidates, HaveExactDerivatives) {
  const ExperimentSpec experiment =
      loadExperiment(kCart, {"simulation.relative_tolerance=1e-10", "simulation.absolute_tolerance=1e-13"});
  const std::vector<TermCandidate> candidates = listAtCenter(experiment);
  const AugmentedExperiment all = addAll(experiment, candidates);
  const ResponseLayout layout = makeLayout(experiment);
  MatrixXd response(layout.getRowCount(), 1), derivatives;
  SampleStatus status;
  makeTrustedSimulator(all.experiment.model, layout.times)
      ->simulateWithDerivatives(calcBoxCenter(all.experiment.model.parameters), response, derivatives,
                                &status);
  ASSERT_TRUE(status.ok) << status.reason;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const VectorXd exact = derivatives.col(3 + static_cast<Index>(i));
    const double step = 1e-3 * candidates[i].size;  // a hundred times what kinks leave of the tolerance
    const VectorXd differences =
        (simulateWith(experiment, candidates[i], step) - simulateWith(experiment, candidates[i], -step)) /
        (2.0 * step);
    EXPECT_LT((exact - differences).norm(), 1e-4 * exact.norm() + 1e-9) << candidates[i].term;
  }
}

// Where a signal begins and ends within the simulation, and its values jump there.
TEST(Candidates, DelaysHaveExactDerivativesAwayFromZero) {
  const ExperimentSpec experiment = loadExperiment(
      kCart, {"simulation.relative_tolerance=1e-10", "simulation.absolute_tolerance=1e-13",
              "excitation.F.sines=[{amplitude: 1, frequency: 1.3, phase: 1, start: 0.4, end: 3}]"});
  const TermCandidate late = find(listAtCenter(experiment), "delay.F");
  const AugmentedExperiment augmented = addTerm(experiment, late, 1e3 * late.size);
  const ResponseLayout layout = makeLayout(experiment);
  VectorXd point = calcBoxCenter(augmented.experiment.model.parameters);
  for (const double delay : {0.0123, 0.003, -0.0071}) {
    point[3] = delay;
    MatrixXd response(layout.getRowCount(), 1), derivatives;
    SampleStatus status;
    makeTrustedSimulator(augmented.experiment.model, layout.times)
        ->simulateWithDerivatives(point, response, derivatives, &status);
    ASSERT_TRUE(status.ok) << status.reason;
    constexpr double kStep = 1e-6;
    const VectorXd differences =
        (simulateWith(experiment, late, delay + kStep) - simulateWith(experiment, late, delay - kStep)) /
        (2.0 * kStep);
    EXPECT_LT((derivatives.col(3) - differences).norm(), 1e-4 * differences.norm()) << delay;
  }
}

}  // namespace
}  // namespace twinmap
