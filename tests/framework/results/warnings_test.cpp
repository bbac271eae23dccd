#include "framework/results/warnings.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <utility>

#include "framework/base/log/notice.hpp"

namespace twinmap {
namespace {

constexpr int kSamples = 400;

/// Three parameters of bounds [0, 1], inferred as they should be.
RunSummary makeGoodRun() {
  RunSummary run;
  for (const char* name : {"k", "d", "m"}) {
    ParameterSpec parameter;
    parameter.name.text = name;
    parameter.bounds = {1.0, 2.0, {}};
    run.parameters.push_back(parameter);
    ParameterMetrics metrics;
    metrics.coverage95 = 0.95;
    metrics.ratio_to_limit = 1.0;
    metrics.samples = kSamples;
    run.evaluation.metrics.push_back(metrics);
  }
  run.evaluation.predictions.stddev = Eigen::MatrixXd::Constant(3, kSamples, 0.01);
  return run;
}

TEST(Warnings, ACalibratedRunHasNone) {
  EXPECT_TRUE(collectWarnings(makeGoodRun()).empty());
}

TEST(Warnings, AreToldOnceForAllParameters) {
  RunSummary run = makeGoodRun();
  run.evaluation.metrics[0].coverage95 = 0.7;
  run.evaluation.metrics[2].coverage95 = 0.81;
  const std::vector<std::string> warnings = collectWarnings(run);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("k (0.7), m (0.81)"), std::string::npos) << warnings[0];
  EXPECT_EQ(warnings[0].find("d ("), std::string::npos);
}

// The standard error of a coverage of 0.95 from 400 samples is 0.0109.
TEST(Warnings, CoverageWithinThreeStandardErrorsIsChance) {
  RunSummary run = makeGoodRun();
  run.evaluation.metrics[1].coverage95 = 0.92;
  EXPECT_TRUE(collectWarnings(run).empty());
  run.evaluation.metrics[1].coverage95 = 0.915;
  EXPECT_EQ(collectWarnings(run).size(), 1U);
}

// The fast model is not advised whose errors nobody knows.
TEST(Warnings, DoNotAdviseWhatAnotherDoubts) {
  RunSummary run = makeGoodRun();
  run.notes.warnings = {makeWarning(Notice::kStudentFar, "k", 2.0)};
  EXPECT_NE(collectWarnings(run)[0].find("Use the surrogate itself"), std::string::npos);
  run.notes.warnings.push_back(makeWarning(Notice::kSurrogateUncalibrated));
  for (const std::string& warning : collectWarnings(run)) {
    EXPECT_EQ(warning.find("Use the surrogate itself"), std::string::npos) << warning;
  }
}

// What has been done is not advised.
TEST(Warnings, OfRefinedEstimatesDoNotAdviseToRefine) {
  RunSummary run = makeGoodRun();
  const std::string happened = "cross-validation: sds were enlarged";
  run.notes.warnings = {
      {Severity::kInfo, happened + "\n  Refine the estimates on the simulator: refine=always."},
      {Severity::kInfo, "calibration\n  Refine the estimates: refine=always."},
      {Severity::kInfo, "other\n  Look at it."}};
  EXPECT_EQ(collectWarnings(run)[0], run.notes.warnings[0].text);
  MethodSummary refined;
  refined.method = "refined";
  refined.samples = refined.accepted = kSamples;
  run.evaluation.methods = {refined};
  const std::string done = "\n  Nothing need be done: the estimates are refined.";
  EXPECT_EQ(collectWarnings(run),
            (std::vector<std::string>{happened + done, "calibration" + done, "other\n  Look at it."}));
}

TEST(Warnings, TellWhereMoreSimulationsHardlyHelpAMapFarFromTheLimit) {
  RunSummary run = makeGoodRun();
  CrossValidation& found = run.training.cross_validation.emplace();
  found.half = 125;
  found.all = 250;
  found.limit_ratio = Eigen::Vector3d(2.0, 2.0, 1.05);
  found.error_ratio = Eigen::Vector3d(0.92, 0.5, 1.0);
  const std::vector<std::string> warnings = collectWarnings(run);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0],
            "from 125 to 250 training samples the errors fell by less than 30 %: k (8 %)\n"
            "  Refine the estimates instead of adding samples: refine=always.");
  run.evaluation.methods = {{"gp", 400, 400, 0, {}}, {"refined", 400, 398, 16, {}}};
  EXPECT_TRUE(collectWarnings(run).empty());  // what is answered is not the map's
  run.evaluation.methods.clear();
  found.half = 0;
  EXPECT_TRUE(collectWarnings(run).empty());
}

TEST(Warnings, TheMostSevereComesFirst) {
  RunSummary run = makeGoodRun();
  run.notes.warn({Severity::kInfo, "a remark"});
  run.notes.warn({Severity::kMisleading, "misleading"});
  run.evaluation.metrics[1].ratio_to_limit = 5.2;
  run.failures = {{"test", 1, Eigen::Vector3d(0, 0, 0), "step limit"}};
  const std::vector<std::string> warnings = collectWarnings(run);
  ASSERT_EQ(warnings.size(), 4U);
  EXPECT_NE(warnings[0].find("1 of the samples could not be simulated"), std::string::npos);
  EXPECT_EQ(warnings[1], "misleading");
  EXPECT_NE(warnings[2].find("d (5.2)"), std::string::npos);
  EXPECT_EQ(warnings[3], "a remark");
}

TEST(Warnings, NameWhatTheResponseSaysLittleOf) {
  RunSummary run = makeGoodRun();
  run.evaluation.predictions.stddev.row(1).setConstant(0.25);  // that of the bounds is 0.289
  const std::vector<std::string> warnings = collectWarnings(run);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("d (13 %)"), std::string::npos) << warnings[0];
}

TEST(Warnings, ParametersThatCannotBeToldApartAreNamedUnlessUndetermined) {
  RunSummary run = makeGoodRun();
  Identifiability found;
  found.correlation = Eigen::Matrix3d::Identity();
  found.correlation(1, 0) = found.correlation(0, 1) = -0.97;
  found.remaining = Eigen::Vector3d(0.1, 0.1, 0.1);
  run.evaluation.identifiability = found;
  const std::vector<std::string> warnings = collectWarnings(run);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("k and d (-0.97)"), std::string::npos) << warnings[0];
  run.evaluation.identifiability->remaining[0] = 0.9;  // told by the stage that found it
  EXPECT_TRUE(collectWarnings(run).empty());
}

TEST(Warnings, AdviceNeverContradictsItself) {
  RunSummary run = makeGoodRun();
  run.evaluation.metrics[0].coverage95 = 0.7;
  run.evaluation.metrics[1].ratio_to_limit = 5.2;
  CrossValidation& found = run.training.cross_validation.emplace();
  found.half = 125;
  found.all = 250;
  found.limit_ratio = Eigen::Vector3d(2.0, 2.0, 1.05);
  found.error_ratio = Eigen::Vector3d(0.92, 0.5, 1.0);
  for (const std::string& warning : collectWarnings(run)) {  // samples do not help: nothing says that they do
    EXPECT_EQ(warning.find("design.train.samples"), std::string::npos) << warning;
    EXPECT_NE(warning.find("refine=always"), std::string::npos) << warning;
  }
  run.evaluation.methods = {{"gp", 400, 400, 0, {}}, {"refined", 400, 398, 16, {}}};
  for (const std::string& warning : collectWarnings(run)) {  // they are refined already
    EXPECT_EQ(warning.find("refine=always"), std::string::npos) << warning;
  }
}

TEST(Warnings, BoundsThatContainZeroGiveARemark) {
  RunSummary run = makeGoodRun();
  run.parameters[1].bounds = {-1.0, 1.0, {}};
  run.evaluation.predictions.stddev.row(1).setConstant(0.02);
  const std::vector<std::string> warnings = collectWarnings(run);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("the bounds of d contain 0"), std::string::npos) << warnings[0];
  run.parameters[1].relative_to = RelativeTo::kRange;
  EXPECT_TRUE(collectWarnings(run).empty());
}

TEST(Warnings, LengthScalesAtTheirUpperBoundAreNoReasonToWarn) {
  RunSummary run = makeGoodRun();
  run.training.starts = {{"k", 0, true, 0, 0, false, "", "length_scale[1] at its upper bound 9"},
                         {"d", 0, true, 0, 0, false, "", "noise_stddev at its lower bound 1e-05"}};
  const std::vector<std::string> warnings = collectWarnings(run);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("d (noise_stddev at its lower bound 1e-05)"), std::string::npos);
  EXPECT_EQ(warnings[0].find("k ("), std::string::npos);
}

/// Phrases of which the warnings of one run hold one at most.
constexpr std::pair<const char*, const char*> kContradictions[] = {
    {"refine=always", "set refine=never"},
    {"refine=always", "the noise of a feature is 0"},
    {"refine=always", "passed the test of their refinement"},
    {"refine=always", "the estimates are refined"},
    {"Nothing need be done: the estimates are refined", "contain too few of the true values"},
    {"Nothing need be done: the estimates are refined", "exceeds the information limit"},
    {"Nothing need be done: the estimates are refined", "refined estimates differ"},
    {"the enlarged intervals hold", "contain too few of the true values"},
    {"Use the surrogate itself", "the fast model is unreliable"},
    {"Use the surrogate itself", "Train on simulations alone"},
    {"instead of adding samples", "design.train.samples"},
    {"excite the machine differently", "exceeds the information limit"}};

using Change = std::function<void(RunSummary&)>;

/// What may be said of a run, by what it is made of.
std::vector<Change> listChanges() {
  const auto note = [](Warning warning) {
    return [warning](RunSummary& run) { run.notes.warnings.push_back(warning); };
  };
  const auto method = [](int accepted) {
    return [accepted](RunSummary& run) {
      run.evaluation.methods = {{"gp", kSamples, kSamples, 0, {}}, {"refined", kSamples, accepted, 16, {}}};
      if (accepted < kSamples) {
        run.notes.warnings.push_back(makeWarning(Notice::kFewRefined, accepted, kSamples, "nonlinear"));
      }
    };
  };
  return {method(kSamples),
          method(kSamples / 2),
          note(makeWarning(Notice::kCannotRefine, "no noise")),
          note(makeWarning(Notice::kNoLimit)),
          note(makeWarning(Notice::kSurrogateUncalibrated)),
          note(makeWarning(Notice::kSurrogateRescaled, "k")),
          note(makeWarning(Notice::kTeacherFar, 3.0, 10000)),
          note(makeWarning(Notice::kStudentFar, "k", 2.0)),
          note(makeWarning(Notice::kPosteriorsUnreliable, 5, 20)),
          note(makeWarning(Notice::kPosteriorDiffers, 5, 20)),
          [](RunSummary& run) { run.evaluation.metrics[0].coverage95 = 0.7; },
          [](RunSummary& run) { run.evaluation.metrics[1].coverage95 = 1.0; },
          [](RunSummary& run) { run.evaluation.metrics[2].ratio_to_limit = 5.2; },
          [](RunSummary& run) { run.evaluation.predictions.stddev.row(2).setConstant(0.25); },
          [](RunSummary& run) {
            CrossValidation& found = run.training.cross_validation.emplace();
            found.half = 125;
            found.all = 250;
            found.limit_ratio = Eigen::Vector3d(2.0, 2.0, 1.05);
            found.error_ratio = Eigen::Vector3d(0.92, 0.5, 1.0);
          }};
}

std::string join(const std::vector<std::string>& warnings) {
  std::string text;
  for (const std::string& warning : warnings) {
    text += warning + "\n";
  }
  return text;
}

// Each beside each other, and all three of them.
TEST(Warnings, OfARunDoNotContradictEachOther) {
  const std::vector<Change> changes = listChanges();
  for (std::size_t i = 0; i < changes.size(); ++i) {
    for (std::size_t j = i; j < changes.size(); ++j) {
      for (std::size_t k = j; k < changes.size(); ++k) {
        RunSummary run = makeGoodRun();
        changes[i](run);
        changes[j](run);
        changes[k](run);
        const std::string text = join(collectWarnings(run));
        for (const auto& [one, other] : kContradictions) {
          ASSERT_FALSE(text.find(one) != std::string::npos && text.find(other) != std::string::npos)
              << "'" << one << "' beside '" << other << "'\n"
              << text;
        }
      }
    }
  }
}

TEST(Warnings, AreKnownByTheirWords) {
  const std::string student = describeNotice(Notice::kStudentFar, "k", 2.0);
  EXPECT_TRUE(saysNotice(student, Notice::kStudentFar));
  EXPECT_FALSE(saysNotice(student, Notice::kTeacherFar));
  EXPECT_TRUE(saysNotice(describeNotice(Notice::kFewRefined, 3, 4, "failed"), Notice::kFewRefined));
  EXPECT_FALSE(
      saysNotice("look: " + describeNotice(Notice::kSurrogateUncalibrated), Notice::kSurrogateUncalibrated));
}

}  // namespace
}  // namespace twinmap
