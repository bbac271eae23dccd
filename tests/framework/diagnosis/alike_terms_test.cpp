#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "framework/base/random/random.hpp"
#include "framework/base/text/source_location.hpp"
#include "framework/diagnosis/diagnosis.hpp"
#include "framework/diagnosis/problem/score_test.hpp"
#include "framework/diagnosis/scored_candidates.hpp"
#include "framework/diagnosis/term_ranking.hpp"
#include "tests/framework/diagnosis/measured_cart.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd drawColumns(Index rows, Index cols) {
  const RandomStream random(3, RandomPurpose::kTestDesign);
  return MatrixXd::NullaryExpr(rows, cols, [&](Index i, Index j) {
    return random.calcNormal(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j));
  });
}

/// A rotor whose load follows it through a gear of 12 and a shaft that hardly gives.
const char* const kGear = R"(
name: gear
parameters:
  Jl: {bounds: [0.02, 0.04], unit: kg m2}
  bm: {bounds: [5e-5, 3e-4], unit: N m s/rad}
constants: {n: {value: 12, unit: "1"}}
system:
  bodies:
    rotor: {mass: 0.3, inertia: {moments: [1e-4, 1e-4, 1e-4]}, joint: {type: pin, coordinates: [phi]}}
    load: {mass: 2, inertia: {moments: [Jl, Jl, Jl]}, joint: {type: pin, coordinates: [psi]}}
  expressions:
    shaft: 25*(phi/n - psi) + 0.03*(phi_dot/n - psi_dot)
  force_laws:
    - {coordinate: phi, force: T - bm*phi_dot - shaft/n}
    - {coordinate: psi, force: shaft}
excitation: {T: {unit: N m, sines: [{amplitude: 0.08, frequency: 0.7}, {amplitude: 0.05, frequency: 3.1}]}}
outputs: {phi: {coordinate: phi}, psi: {coordinate: psi}}
simulation: {duration: 2}
features: [{samples: {outputs: [phi, psi], start: 0.02, interval: 0.02, count: 99}}]
noise: {stddev: {phi: 6e-3, psi: 1e-3}}
)";

ExperimentSpec readGear(const std::vector<std::string>& overrides) {
  return readExperiment(parseExperimentTree(kGear, "gear.yaml", overrides));
}

VectorXd measure(const ExperimentSpec& machine, const VectorXd& point) {
  const ResponseLayout layout = makeLayout(machine);
  MatrixXd response(layout.getRowCount(), 1);
  SampleStatus status;
  makeTrustedSimulator(machine.model, layout.times)->simulate(point, response, &status);
  const MatrixXd noisy =
      addNoise(response, ResponseNoise(machine.noise, layout), {7, RandomPurpose::kTestNoise});
  return makeExtractor(machine, layout).extract(noisy).col(0);
}

// The coefficient on the rotor's side is 12^4 times as small as that of the same spring on the load's.
TEST(AlikeTerms, AreTiedOnBothSidesOfAGear) {
  const VectorXd point = Eigen::Vector2d(0.03, 2e-4);
  const ExperimentSpec experiment = readGear({});
  const RecordedFeatures recordings{
      makeLayout(experiment),
      {measure(readGear({"system.force_laws[1].force=shaft - 3e-6*psi^3"}), point)},
      {}};
  const RecordingsProblem problem(experiment, recordings);
  const RecordingFit fit = problem.fit(point);
  const ScoredCandidates scored =
      scoreCandidates(experiment, recordings, fit.point, {CandidateKinds::kWithoutStates});
  const CurrentFit current{experiment, fit.point, fit.chi_square, 196.0, {}};
  double rotor = -kInfinity, load = -kInfinity;
  for (const RankedTerm& one : rankTerms(scored, current, 2)) {
    rotor = one.finding.candidate.term == "cubic_spring.phi" ? one.finding.log_evidence : rotor;
    load = one.finding.candidate.term == "cubic_spring.psi" ? one.finding.log_evidence : load;
  }
  EXPECT_GT(load, 10.0);
  EXPECT_NEAR(rotor, load, kTiedEvidence);
}

// A coefficient and its scale that make up for each other: with the prior of the scale, the volume of both is
// the root of the determinant of their covariance, in the scale's prior sd.
TEST(AlikeTerms, CountTheVolumeOfCoefficientAndScales) {
  constexpr Index kResiduals = 40;
  MatrixXd jacobian = drawColumns(kResiduals, 3);
  jacobian.col(2) = 0.4 * jacobian.col(1) + 0.05 * jacobian.col(2);
  TermCandidate candidate;
  candidate.own_scales = {{"speed", "m/s", 2.0, 5.0}};
  const VectorXd point = Eigen::Vector3d(1.0, 1.0, 2.0);
  const LinearizedRecordings linear =
      addScalePriors({VectorXd::Zero(kResiduals), jacobian, {0}}, 1, candidate, point);
  ASSERT_EQ(linear.residual.size(), kResiduals + 1);
  EXPECT_EQ(linear.starts.back(), kResiduals);
  const double prior = 2.0 * std::log(5.0) / std::sqrt(3.0);
  EXPECT_NEAR(linear.jacobian(kResiduals, 2), 1.0 / prior, 1e-12);

  const double first = jacobian.col(0).squaredNorm();
  const VectorXd c = jacobian.col(1) - jacobian.col(0) * (jacobian.col(0).dot(jacobian.col(1)) / first);
  const VectorXd s = jacobian.col(2) - jacobian.col(0) * (jacobian.col(0).dot(jacobian.col(2)) / first);
  const double cc = c.squaredNorm(), cs = c.dot(s), ss = s.squaredNorm() + 1.0 / (prior * prior);
  const double determinant = cc * ss - cs * cs;
  const double coefficient = std::sqrt(ss / determinant);  // its sd, the scale unknown
  EXPECT_NEAR(std::log(coefficient) + calcScalesEvidence(linear, 1, candidate, point),
              -0.5 * std::log(determinant) - std::log(prior), 1e-9);
}

// A torsion spring of the load, which explains all; a force on the cart could be as good.
TEST(AlikeTerms, AreNotBeatenByAForceThatMayBeAnything) {
  const std::string kCrane = std::string(TWINMAP_SOURCE_DIR) + "/experiments/crane/crane.yaml";
  const ExperimentSpec experiment = loadExperiment(kCrane);
  const ExperimentSpec machine =
      loadExperiment(kCrane, {"system.force_laws=[{coordinate: y, force: F - k_cubic*y^3}, {coordinate: "
                              "theta, force: -0.18*theta}]"});
  VectorXd point(8);
  point << 2.09, 0.492, 0.42, 112.0, 90.0, 18900.0, 3.04, 0.0213;
  const Diagnosis diagnosis =
      diagnose(experiment, {makeLayout(experiment), {measure(machine, point)}, {}}, {});
  ASSERT_EQ(diagnosis.found, 1U);
  EXPECT_TRUE(diagnosis.after.isExplained());
  EXPECT_FALSE(diagnosis.process.has_value());
  EXPECT_STREQ(diagnosis.getStatus(), "ok");
}

// A rotor that a bristle brakes: its best fit without it is so far off that the linear model there does not
// show how well the bristle explains the recording.
TEST(AlikeTerms, AreFittedFromWhereOneOfThemFits) {
  const std::string kRotor =
      std::string(TWINMAP_SOURCE_DIR) + "/experiments/mechanisms/unbalanced_rotor.yaml";
  const ExperimentSpec experiment = loadExperiment(kRotor);
  const ExperimentSpec machine =
      loadExperiment(kRotor, {"system.states={z: {derivative: (angle_dot - abs(angle_dot)*z/(1 + "
                              "0.5*exp(-(angle_dot/0.21)^2)))/0.033, "
                              "unit: \"1\"}}",
                              "system.force_laws=[{coordinate: angle, force: -0.08*z}]"});
  const VectorXd measured = measure(machine, Eigen::Vector3d(-0.06, 1.7, 0.009));
  const Diagnosis diagnosis = diagnose(experiment, {makeLayout(experiment), {measured}, {}}, {});
  ASSERT_EQ(diagnosis.found, 1U);
  EXPECT_TRUE(diagnosis.after.isExplained());
  const DiagnosisStep& step = diagnosis.steps.front();
  std::set<std::string> tied;
  for (std::size_t i = 0; i < step.tied; ++i) {
    tied.insert(step.ranked[i].candidate.term);
  }
  EXPECT_TRUE(tied.count("lugre.angle"));
  EXPECT_TRUE(tied.count("presliding.angle"));
}

/// Of a block on a belt: its parameters are k, Fs, Fc, d.
const Eigen::Vector4d kBelt(80.0, 3.5, 2.1, 0.5);

Diagnosis diagnoseBelt(const std::vector<std::string>& model, const std::vector<std::string>& machine) {
  const std::string belt = std::string(TWINMAP_SOURCE_DIR) + "/experiments/mechanisms/dry_belt.yaml";
  const ExperimentSpec experiment = loadExperiment(belt, model);
  return diagnose(experiment, {makeLayout(experiment), {measure(loadExperiment(belt, machine), kBelt)}, {}},
                  {});
}

const std::vector<std::string> kCreeps{"system.friction[0].model=regularised",
                                       "system.friction[0].onset_speed=2e-3"};

// Friction that creeps where the model's sticks, and the other way about: the parameters are right with it.
TEST(AlikeTerms, AreOtherLawsOfTheModelsFriction) {
  for (const auto& [model, machine] :
       {std::pair(std::vector<std::string>(), kCreeps), std::pair(kCreeps, std::vector<std::string>())}) {
    const Diagnosis diagnosis = diagnoseBelt(model, machine);
    EXPECT_EQ(diagnosis.listTerms(), std::vector<std::string>{"regularised_law.x"});
    EXPECT_STREQ(diagnosis.getStatus(), "ok");
    ASSERT_TRUE(diagnosis.averaged.isGiven());
    const VectorXd off = (diagnosis.averaged.mean - kBelt).cwiseQuotient(diagnosis.averaged.stddev);
    EXPECT_LT(off.cwiseAbs().maxCoeff(), 3.5) << off;
  }
}

TEST(AlikeTerms, AreNotFoundWhereTheLawIsRight) {
  for (const std::vector<std::string>& law : {std::vector<std::string>(), kCreeps}) {
    EXPECT_EQ(diagnoseBelt(law, law).found, 0U);
  }
}

/// A slide that is driven against a stop; a drive with play; a ball that falls on a floor.
const char* const kTouching[] = {R"(
name: stopped
parameters:
  k: {bounds: [500, 2e4]}
  d: {bounds: [0.2, 3], unit: N s/m}
system:
  bodies: {slide: {mass: 0.8, joint: {type: slider, coordinates: [x]}}}
  springs: [{coordinate: x, stiffness: 40}]
  dampers: [{coordinate: x, damping: d}]
  stops: [{coordinate: x, above: 0.01, stiffness: k, dissipation: 0.4}]
  force_laws: [{coordinate: x, force: F}]
excitation: {F: {unit: N, sines: [{amplitude: 2.5, frequency: 1.9}]}}
outputs: {x: {coordinate: x}}
simulation: {duration: 3}
features: [{samples: {outputs: [x], start: 0.02, interval: 0.01, count: 280}}]
noise: {stddev: {x: 1e-4}}
)",
                                 R"(
name: play
parameters:
  k: {bounds: [10, 400]}
  d: {bounds: [0.01, 0.1], unit: N m s/rad}
system:
  bodies: {load: {mass: 2, inertia: {moments: [0.01, 0.01, 0.01]}, joint: {type: pin, coordinates: [q]}}}
  dampers: [{coordinate: q, damping: d}]
  backlash: [{coordinate: q, gap: 0.04, stiffness: k, dissipation: 0.2}]
  force_laws: [{coordinate: q, force: T}]
excitation: {T: {unit: N m, sines: [{amplitude: 1, frequency: 1.3}, {amplitude: 0.4, frequency: 2.9}]}}
outputs: {q: {coordinate: q}}
simulation: {duration: 3}
features: [{samples: {outputs: [q], start: 0.02, interval: 0.01, count: 280}}]
noise: {stddev: {q: 3e-4}}
)",
                                 R"(
name: floor
parameters:
  k: {bounds: [1e3, 1e5]}
  d: {bounds: [0.01, 0.2], unit: N s/m}
system:
  gravity: [0, 0, -9.81]
  bodies: {ball: {mass: 0.3, joint: {type: slider, axis: [0, 0, 1], coordinates: [z]}}}
  dampers: [{coordinate: z, damping: d}]
  contacts: [{body: ball, plane: {normal: [0, 0, 1]}, stiffness: k, dissipation: 0.3}]
initial: {coordinates: {z: 0.2}}
outputs: {z: {coordinate: z}}
simulation: {duration: 1.2}
features: [{samples: {outputs: [z], start: 0.005, interval: 0.005, count: 230}}]
noise: {stddev: {z: 1e-4}}
)"};
const char* const kListsOfContacts[] = {"stops", "backlash", "contacts"};

Diagnosis diagnoseContact(int which, const std::string& change, const VectorXd& point) {
  const auto read = [&](const std::vector<std::string>& overrides) {
    return readExperiment(parseExperimentTree(kTouching[which], "touching.yaml", overrides));
  };
  const ExperimentSpec experiment = read({});
  std::vector<std::string> changes;
  if (!change.empty()) {
    changes.push_back(std::string("system.") + kListsOfContacts[which] + "[0]." + change);
  }
  return diagnose(experiment, {makeLayout(experiment), {measure(read(changes), point)}, {}}, {});
}

// Spheres press with the power 1.5 of the depth.
TEST(AlikeTerms, AreOtherPowersOfAContact) {
  const double hertz[] = {6e4, 300.0, 4e5}, damping[] = {0.8, 0.04, 0.05};
  for (int i = 0; i < 3; ++i) {
    const Diagnosis found = diagnoseContact(i, "exponent=1.5", Eigen::Vector2d(hertz[i], damping[i]));
    ASSERT_EQ(found.found, 1U) << i;
    EXPECT_EQ(found.listTerms().front().rfind("contact_power.", 0), 0U) << found.listTerms().front();
    EXPECT_NEAR(found.steps.front().ranked.front().estimate, 0.5, 0.05) << i;
    EXPECT_STREQ(found.getStatus(), "ok");
  }
}

TEST(AlikeTerms, AreContactsThatLoseMoreEnergy) {
  const Eigen::Vector2d point(80.0, 0.04);
  const Diagnosis found = diagnoseContact(1, "dissipation=1.5", point);
  EXPECT_EQ(found.listTerms(), std::vector<std::string>{"contact_loss.q"});
  const Eigen::Array2d off = (found.averaged.mean - point).cwiseQuotient(found.averaged.stddev);
  EXPECT_LT(off.abs().maxCoeff(), 3.5) << off;
  EXPECT_EQ(diagnoseContact(1, "", point).found, 0U);
}

}  // namespace
}  // namespace twinmap
