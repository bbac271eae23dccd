#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <fstream>
#include <sstream>

#include "framework/base/text/source_location.hpp"
#include "framework/diagnosis/candidates/augment.hpp"
#include "framework/diagnosis/diagnosis.hpp"
#include "framework/diagnosis/scored_candidates.hpp"
#include "tests/framework/diagnosis/measured_cart.hpp"

namespace twinmap {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// What the cart lacks: c times this.
const char* const kDrag = "-abs(x_dot)*x_dot";
constexpr double kTrueDrag = 0.4;

std::string makeForce(double drag) {
  return "F - k3*x^3 + (" + std::to_string(drag) + ")*(" + kDrag + ")";
}

/// The cart under its chirp at two amplitudes; what is `own` is a trial's beside it.
std::string writeTrials(const std::string& own = "") {
  std::ifstream file(kCart);
  std::stringstream text;
  text << file.rdbuf() << "\ntrials:\n";
  for (const auto& [name, amplitude] : {std::pair("soft", "1"), std::pair("hard", "4")}) {
    text << "  " << name << ": {excitation: {F: {unit: N, chirps: [{amplitude: " << amplitude
         << ", start_frequency: 0.5, end_frequency: 5, end: 4}]}}" << own << "}\n";
  }
  return text.str();
}

ExperimentSpec readCombined(const std::vector<std::string>& overrides = {}) {
  return readExperiment(parseExperimentTree(writeTrials(), "trials.yaml", overrides));
}

/// The features of a trial, without noise.
VectorXd simulateTrial(const std::string& trial, const VectorXd& point, double drag) {
  const ExperimentSpec machine =
      readCombined({"trial=" + trial, "system.force_laws[0].force=" + makeForce(drag),
                    "simulation.relative_tolerance=1e-10", "simulation.absolute_tolerance=1e-12"});
  const ResponseLayout layout = makeLayout(machine);
  MatrixXd response(layout.getRowCount(), 1);
  SampleStatus status;
  makeTrustedSimulator(machine.model, layout.times)->simulate(point, response, &status);
  return makeExtractor(machine, layout).extract(response).col(0);
}

constexpr double kNoise = 1e-4;  // of the cart

RecordedFeatures measureTrials(const ExperimentSpec& combined, double drag) {
  RecordedFeatures recordings = makeEmptyRecordings(combined, {});
  for (std::size_t t = 0; t < 2; ++t) {
    VectorXd& features = recordings.features[t];
    const ExperimentSpec& trial = combined.trials[t].experiment;
    const ResponseLayout& layout = recordings.setups[t].layout;
    features = makeExtractor(trial, layout)
                   .extract(addNoise(simulateTrial(combined.trials[t].name, kTrueCart, drag),
                                     ResponseNoise(trial.noise, layout),
                                     {static_cast<std::uint64_t>(11 + t), RandomPurpose::kTestNoise}))
                   .col(0);
  }
  return recordings;
}

/// Residuals of both trials and their derivatives along k, d, k3 and the drag, by central differences.
struct StackedTrials {
  VectorXd residual;
  MatrixXd jacobian;
};

StackedTrials stackTrials(const RecordedFeatures& recordings, const VectorXd& point) {
  const Index n = recordings.features[0].size();
  StackedTrials stacked{VectorXd(2 * n), MatrixXd(2 * n, 4)};
  for (std::size_t t = 0; t < 2; ++t) {
    const std::string trial = t == 0 ? "soft" : "hard";
    const Index first = static_cast<Index>(t) * n;
    stacked.residual.segment(first, n) = (recordings.features[t] - simulateTrial(trial, point, 0.0)) / kNoise;
    for (Index j = 0; j < 4; ++j) {
      const double step = j < 3 ? 1e-5 * point[j] : 1e-5;
      VectorXd above = point, below = point;
      if (j < 3) {
        above[j] += step;
        below[j] -= step;
      }
      const double drag = j < 3 ? 0.0 : step;
      stacked.jacobian.col(j).segment(first, n) =
          (simulateTrial(trial, above, drag) - simulateTrial(trial, below, -drag)) / (2.0 * step * kNoise);
    }
  }
  return stacked;
}

TEST(TrialsDiagnosis, ScoresAddUpOverTrials) {
  const ExperimentSpec combined = readCombined();
  const RecordedFeatures recordings = measureTrials(combined, kTrueDrag);
  const ScoredCandidates scored =
      scoreCandidates(combined, recordings, kTrueCart, {CandidateKinds::kWithoutStates});
  std::size_t drag = 0;
  while (scored.candidates[drag].term != "drag.x") {
    ++drag;
  }
  // least squares with the term among the parameters
  const StackedTrials stacked = stackTrials(recordings, kTrueCart);
  const VectorXd steps = stacked.jacobian.colPivHouseholderQr().solve(stacked.residual);
  const VectorXd last = VectorXd::Unit(4, 3);
  const MatrixXd information = stacked.jacobian.transpose() * stacked.jacobian;
  const double stddev = std::sqrt(information.ldlt().solve(last)[3]);
  EXPECT_NEAR(scored.scores[drag].estimate, steps[3], 1e-3 * std::abs(steps[3]));
  EXPECT_NEAR(scored.scores[drag].stddev, stddev, 1e-3 * stddev);
  for (Index i = 0; i < 3; ++i) {
    EXPECT_NEAR(
        scored.scores[drag].shifts[i],
        (stacked.jacobian.leftCols(3).colPivHouseholderQr().solve(-steps[3] * stacked.jacobian.col(3)))[i],
        1e-3 * kTrueCart[i]);
  }
}

TEST(TrialsDiagnosis, NamesWhatTrialsTellTogether) {
  const ExperimentSpec combined = readCombined();
  const Diagnosis diagnosis = diagnose(combined, measureTrials(combined, kTrueDrag), {});
  ASSERT_EQ(diagnosis.found, 1U);
  const TermFinding& found = diagnosis.steps[0].ranked[0];
  EXPECT_EQ(found.candidate.term, "drag.x");
  EXPECT_NEAR(found.estimate, kTrueDrag, 4.0 * found.stddev);
  EXPECT_TRUE(diagnosis.after.isExplained());
  for (Index i = 0; i < 3; ++i) {
    EXPECT_NEAR(diagnosis.averaged.mean[i], kTrueCart[i], 4.0 * diagnosis.averaged.stddev[i]);
  }
}

TEST(TrialsDiagnosis, FindsNothingWhereNothingIsMissing) {
  const ExperimentSpec combined = readCombined();
  const Diagnosis diagnosis = diagnose(combined, measureTrials(combined, 0.0), {});
  EXPECT_EQ(diagnosis.found, 0U);
  EXPECT_TRUE(diagnosis.after.isExplained());
}

TEST(TrialsDiagnosis, WritesTheTermIntoAllTrials) {
  const ExperimentSpec combined = readCombined();
  DiagnosisOptions options;
  options.accepted = {"drag.x"};
  const Diagnosis diagnosis = diagnose(combined, measureTrials(combined, kTrueDrag), options);
  requireSharedSystem(diagnosis.corrected);
  const ExperimentSpec read =
      readExperiment(parseExperimentTree(writeExperiment(diagnosis.corrected), "corrected.yaml"));
  ASSERT_EQ(read.trials.size(), 2U);
  for (const TrialExperiment& trial : read.trials) {
    ASSERT_EQ(trial.experiment.model.parameters.size(), 4U);
    EXPECT_EQ(trial.experiment.model.parameters[3].name.text, "drag_x");
  }
}

// What begins where the trial does is another machine in each.
TEST(TrialsDiagnosis, SaysWhereTrialsWouldNeedOtherMachines) {
  ExperimentSpec combined = readCombined();
  requireSharedSystem(combined);
  combined.trials[1].experiment.model.system.bodies[0].mass.text = "2";
  EXPECT_THROW(requireSharedSystem(combined), ExperimentError);
}

}  // namespace
}  // namespace twinmap
