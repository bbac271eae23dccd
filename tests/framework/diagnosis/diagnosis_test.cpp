#include "framework/diagnosis/diagnosis.hpp"

#include <gtest/gtest.h>

#include <set>

#include "framework/base/text/source_location.hpp"
#include "framework/diagnosis/text/diagnosis_text.hpp"
#include "framework/experiment/files/experiment_file.hpp"
#include "tests/framework/diagnosis/measured_cart.hpp"

namespace twinmap {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Diagnosis diagnoseCart(const std::vector<VectorXd>& features, const std::vector<std::string>& accepted = {},
                       const std::vector<std::string>& overrides = {}) {
  const ExperimentSpec experiment = loadExperiment(kCart, overrides);
  const RecordedFeatures recordings{makeLayout(experiment), features, {}};
  DiagnosisOptions options;
  options.accepted = accepted;
  return diagnose(experiment, recordings, options);
}

std::set<std::string> nameTerms(const Diagnosis& diagnosis) {
  const std::vector<std::string> names = diagnosis.listTerms();
  return {names.begin(), names.end()};
}

DiagnosisStep makeStep(double p_value, bool fitted, double log_evidence) {
  TermFinding finding;
  finding.candidate.term = "drag.x";
  finding.z = 15.2;
  finding.p_value = p_value;
  finding.fitted = fitted;
  finding.log_evidence = log_evidence;
  DiagnosisStep step;
  step.tested = 99;
  step.ranked = {finding};
  return step;
}

TEST(Diagnosis, SaysWhichRuleTookATermOutThatStandsOut) {
  const std::string found = "None of 99 candidates found: drag.x stands out (z +15.2), but ";
  const auto says = [](const DiagnosisStep& step) { return describeStep(step, 1, 0.01); };
  EXPECT_EQ(says(makeStep(1e-9, false, -INFINITY)), found + "no fit with it succeeded\n");
  EXPECT_EQ(says(makeStep(1e-9, true, -2.0)),
            found + "a fit with it explains no more than its freedom would of noise\n");
  EXPECT_EQ(says(makeStep(1e-9, true, 7.0)),
            found + "not out of what remains with it, which is not noise either\n");
  EXPECT_NE(says(makeStep(0.3, false, 1.0)).find("found (|z| above "), std::string::npos);
}

TEST(Diagnosis, DoesNotCallAModelExplainedThatLacksWhatStandsOut) {
  Diagnosis diagnosis;
  diagnosis.before.posterior.chi_square = 2116;
  diagnosis.before.posterior.degrees = 1987;
  EXPECT_EQ(describeBefore(diagnosis), describeFit(diagnosis.before));
  diagnosis.found = 1;
  EXPECT_EQ(describeBefore(diagnosis),
            "chi-square 2116 of 1987 degrees of freedom, within the noise by its size, but a missing term "
            "stands out");
  diagnosis.before.test.chi_square_p = 0.0;
  EXPECT_EQ(describeBefore(diagnosis), "chi-square 2116 of 1987 degrees of freedom, model_mismatch");
}

TEST(Diagnosis, SaysWhereTheSearchForAScaleEnded) {
  Diagnosis diagnosis;
  diagnosis.shared = 1;
  for (const char* name : {"k", "stribeck_x", "stribeck_x_scale"}) {
    diagnosis.corrected.model.parameters.emplace_back();
    diagnosis.corrected.model.parameters.back().name.text = name;
  }
  diagnosis.after.posterior.beyond = {0, 2, 3};  // the last is of a recording alone
  EXPECT_TRUE(diagnosis.listTermsAtBounds().empty());
  diagnosis.found = 1;
  EXPECT_EQ(diagnosis.listTermsAtBounds(), std::vector<std::string>{"stribeck_x_scale"});
}

TEST(Diagnosis, FindsNothingWhereNothingIsMissing) {
  const Diagnosis diagnosis = diagnoseCart({measureCart(kSound)});
  EXPECT_EQ(diagnosis.found, 0U);
  EXPECT_TRUE(diagnosis.after.isExplained());
  ASSERT_EQ(diagnosis.steps.size(), 1U);
  EXPECT_FALSE(diagnosis.steps[0].found);
  EXPECT_NE(makeDiagnosisTable(diagnosis, "m.csv").find("None of"), std::string::npos);
}

TEST(Diagnosis, FindsDryFriction) {
  const Diagnosis diagnosis = diagnoseCart({measureCart(kWithFriction)});
  EXPECT_FALSE(diagnosis.before.isExplained());
  ASSERT_EQ(diagnosis.found, 1U);
  EXPECT_EQ(diagnosis.steps[0].ranked[0].candidate.term, "coulomb.x");
  EXPECT_TRUE(diagnosis.after.isExplained());
  const TermFinding& friction = diagnosis.steps[0].ranked[0];
  EXPECT_NEAR(friction.estimate, 0.03, 4.0 * friction.stddev);
  EXPECT_GT(friction.share, 0.9);
  // the damping had taken up the friction
  EXPECT_GT(diagnosis.before.posterior.mean[1] - kTrueCart[1], 5.0 * diagnosis.before.posterior.stddev[1]);
  for (Eigen::Index i = 0; i < 3; ++i) {
    EXPECT_NEAR(diagnosis.averaged.mean[i], kTrueCart[i], 4.0 * diagnosis.averaged.stddev[i]);
  }
}

TEST(Diagnosis, FindsAnotherStart) {
  const Diagnosis diagnosis = diagnoseCart({measureCart(kSound, 0, {"initial.coordinates={x: 0.01}"})});
  EXPECT_EQ(diagnosis.listTerms(), std::vector<std::string>{"start.x"});
  const SimulatorPosterior& after = diagnosis.after.posterior;
  EXPECT_NEAR(after.mean[3], 0.01, 4.0 * after.stddev[3]);
  EXPECT_LT(((after.mean.head(3) - kTrueCart).cwiseQuotient(after.stddev.head(3))).cwiseAbs().maxCoeff(),
            4.0);
}

TEST(Diagnosis, LooksForWhatCanBe) {
  const ExperimentSpec experiment = loadExperiment(kCart);
  const RecordedFeatures recordings{makeLayout(experiment), {measureCart(kWithFriction)}, {}};
  DiagnosisOptions options;
  options.candidates.without = {"coulomb.x", "stribeck"};
  const Diagnosis without = diagnose(experiment, recordings, options);
  ASSERT_FALSE(without.steps.empty());
  for (const TermFinding& one : without.steps.front().ranked) {
    EXPECT_NE(one.candidate.term, "coulomb.x");
    EXPECT_NE(one.candidate.term, "stribeck.x");
  }
  options.candidates = {CandidateKinds::kAll, {"drag"}, {}};
  const Diagnosis only = diagnose(experiment, recordings, options);
  EXPECT_EQ(only.steps.front().tested, 1);
  options.candidates.only = {"drga"};
  EXPECT_THROW(diagnose(experiment, recordings, options), ExperimentError);
}

TEST(Diagnosis, ExplainsRecordingsTogether) {
  const Diagnosis one = diagnoseCart({measureCart(kWithFriction)});
  const Diagnosis two = diagnoseCart({measureCart(kWithFriction), measureCart(kWithFriction, 1)});
  ASSERT_EQ(two.found, 1U);
  EXPECT_NEAR(two.steps[0].ranked[0].stddev / one.steps[0].ranked[0].stddev, std::sqrt(0.5), 0.1);
}

TEST(Diagnosis, WritesTheCorrectedExperiment) {
  const Diagnosis diagnosis = diagnoseCart({measureCart(kWithFriction)}, {"coulomb.x"});
  const ExperimentSpec read =
      readExperiment(parseExperimentTree(writeExperiment(diagnosis.corrected), "corrected.yaml"));
  ASSERT_EQ(read.model.parameters.size(), 5U);
  EXPECT_EQ(read.model.parameters[3].name.text, "coulomb_x");
  EXPECT_EQ(read.model.parameters[4].name.text, "coulomb_x_scale");
}

// Friction, and a sensor that reads 0.4 mm too much.
TEST(Diagnosis, FindsTwoTerms) {
  const Diagnosis diagnosis = diagnoseCart({(measureCart(kWithFriction).array() + 4e-4).matrix()});
  EXPECT_TRUE(diagnosis.after.isExplained());
  const std::set<std::string> found = nameTerms(diagnosis);
  EXPECT_EQ(found, (std::set<std::string>{"coulomb.x", "offset.x"}));
  for (Eigen::Index i = 0; i < 3; ++i) {
    EXPECT_NEAR(diagnosis.averaged.mean[i], kTrueCart[i], 4.0 * diagnosis.averaged.stddev[i]);
  }
}

// Friction and a spring of fifth order: alone, a friction with a bristle explains some of both.
TEST(Diagnosis, NamesRivalsOfATermThatMayStandInForOthers) {
  const Diagnosis diagnosis = diagnoseCart({measureCart("F - k3*x^3 - 0.03*tanh(x_dot/0.01) - 4e5*x^5")});
  EXPECT_TRUE(diagnosis.after.isExplained());
  std::set<std::string> named = nameTerms(diagnosis);
  EXPECT_EQ(named.size(), 2U);
  EXPECT_TRUE(named.count("quintic_spring.x"));
  for (const DiagnosisStep& step : diagnosis.steps) {
    for (const TermRival& rival : step.rivals) {
      named.insert(rival.rival);
    }
  }
  EXPECT_TRUE(named.count("coulomb.x"));
}

// Drag, and a drive that follows its command late: found together, each may be another of its kind.
TEST(Diagnosis, NamesRivalsOfTwoTermsFoundTogether) {
  const Diagnosis diagnosis = diagnoseCart({measureCart(
      "f - k3*x^3 - 4*x_dot*abs(x_dot)", 0, {"system.states={f: {derivative: (F - f)/0.012, unit: N}}"})});
  ASSERT_TRUE(diagnosis.steps.front().partner.has_value());
  std::set<std::string> named = nameTerms(diagnosis);
  for (const TermRival& rival : diagnosis.steps.front().rivals) {
    named.insert(rival.rival);
  }
  EXPECT_TRUE(named.count("drag.x"));
  EXPECT_TRUE(named.count("lag.F"));
  EXPECT_GT(named.size(), 2U);
  for (Eigen::Index i = 0; i < 3; ++i) {
    EXPECT_NEAR(diagnosis.averaged.mean[i], kTrueCart[i], 4.0 * diagnosis.averaged.stddev[i]);
  }
}

// A flexible term explains what a random force of this size leaves; a force that may be anything needs less
// freedom where it is fast, and as much where it is slow.
TEST(Diagnosis, WeighsARandomForceAgainstAllTerms) {
  const Diagnosis fast =
      diagnoseCart({measureCart("F - k3*x^3 + 0.006*(sin(11*t) + sin(17.3*t + 1) + sin(23.1*t + 2))")});
  EXPECT_TRUE(fast.after.isExplained());
  ASSERT_TRUE(fast.process.has_value());
  EXPECT_EQ(fast.process->what, "a force on x");
  EXPECT_FALSE(fast.process_ties);
  EXPECT_STREQ(fast.getStatus(), "model_incomplete");

  const Diagnosis slow =
      diagnoseCart({measureCart("F - k3*x^3 + 0.006*(sin(5*t) + sin(7.3*t + 1) + sin(9.1*t + 2))")});
  ASSERT_TRUE(slow.process.has_value());
  EXPECT_TRUE(slow.process_ties);
  EXPECT_STREQ(slow.getStatus(), "ok");
  EXPECT_NE(makeDiagnosisTable(slow, "m.csv").find("A random process explains as much as all terms found"),
            std::string::npos);
}

constexpr const char* kSwept = "F - k3*x^3 + 0.05*sin(9*t^2)";

TEST(Diagnosis, TestsTermsOfTheFile) {
  const Diagnosis with = diagnoseCart({measureCart(kSwept)}, {},
                                      {"candidates.sweep={coordinate: x, force: sin(9*t^2), unit: N}"});
  EXPECT_STREQ(with.getStatus(), "ok");
  EXPECT_EQ(with.listTerms(), std::vector<std::string>{"sweep"});
  EXPECT_NEAR(with.steps[0].ranked[0].estimate, 0.05, 4.0 * with.steps[0].ranked[0].stddev);
  EXPECT_TRUE(with.corrected.candidates.empty());  // it is a parameter now
}

// What remains is a force, and with it the intervals hold again.
TEST(Diagnosis, WidensIntervalsByWhatRemains) {
  const Diagnosis diagnosis = diagnoseCart({measureCart(kSwept)});
  EXPECT_STREQ(diagnosis.getStatus(), "model_incomplete");
  ASSERT_TRUE(diagnosis.remainder.has_value());
  EXPECT_GT(diagnosis.remainder->log_evidence, 10.0);
  for (Eigen::Index i = 0; i < 3; ++i) {
    EXPECT_GT(diagnosis.remainder->stddevs[i], diagnosis.before.posterior.stddev[i]);
    EXPECT_NEAR(diagnosis.remainder->mean[i], kTrueCart[i], 4.0 * diagnosis.remainder->stddevs[i]);
  }
}

// The residual's size is the noise's, with friction first and then without.
TEST(Diagnosis, FindsWhatIsMissingWhereTheSizeOfTheNoiseIsUnknown) {
  const std::vector<std::string> unknown{"noise.stddev.x=unknown"};
  const Diagnosis diagnosis = diagnoseCart({measureCart(kWithFriction)}, {}, unknown);
  EXPECT_EQ(diagnosis.listTerms(), std::vector<std::string>{"coulomb.x"});
  const double stddev = loadExperiment(kCart).noise.stddev[0].stddev;
  EXPECT_NEAR(diagnosis.noise.stddev[0].stddev / stddev, 1.0, 0.25);  // of 100 samples 3.5 sds
  EXPECT_TRUE(diagnosis.corrected.noise.stddev[0].stddev.unknown);
  EXPECT_NE(makeDiagnosisTable(diagnosis, "m.csv").find("Noise as the residual has it: sd "),
            std::string::npos);
  const Diagnosis sound = diagnoseCart({measureCart(kSound)}, {}, unknown);
  EXPECT_EQ(sound.found, 0U);
  EXPECT_NEAR(sound.noise.stddev[0].stddev / stddev, 1.0, 0.25);
}

TEST(Diagnosis, RefusesTermsThatTheParametersTakeUp) {
  for (const char* term : {"damping.x", "nonsense.x"}) {
    EXPECT_THROW(diagnoseCart({measureCart(kSound)}, {term}), ExperimentError) << term;
  }
}

TEST(BlindSpots, NeedTheSizeOfTheNoise) {
  const ExperimentSpec experiment = loadExperiment(kCart, {"noise.stddev.x=unknown"});
  const ResponseLayout layout = makeLayout(experiment);
  const VectorXd none = VectorXd::Zero(makeExtractor(experiment, layout).getFeatureCount());
  EXPECT_THROW(calcBlindSpots(experiment, {layout, {none}, {}}, 0.01), ExperimentError);
}

// Drag of the size that is noticed: z is then 1.645 above the critical one, by the linear model.
TEST(BlindSpots, SayWhatIsNoticed) {
  const ExperimentSpec experiment = loadExperiment(kCart);
  const ResponseLayout layout = makeLayout(experiment);
  const VectorXd none = VectorXd::Zero(makeExtractor(experiment, layout).getFeatureCount());
  const std::vector<BlindSpot> spots = calcBlindSpots(experiment, {layout, {none}, {}}, 0.01);
  for (const BlindSpot& spot : spots) {
    if (spot.candidate.term == "damping.x") {
      EXPECT_TRUE(std::isinf(spot.noticed));
    }
    if (spot.candidate.term == "drag.x") {
      EXPECT_GT(spot.noticed, 0.0);
      EXPECT_LT(spot.shifts[1], -3.0);  // the damping hides it: it has moved far before
    }
  }
  EXPECT_NE(makeBlindSpotTable(spots, experiment.model.parameters).find("never"), std::string::npos);
}

}  // namespace
}  // namespace twinmap
