#include "framework/diagnosis/second_test.hpp"

#include <fmt/core.h>

#include "framework/base/text/number_text.hpp"
#include "framework/diagnosis/augment.hpp"
#include "framework/diagnosis/candidates/term_candidates.hpp"
#include "framework/diagnosis/score_test.hpp"
#include "framework/experiment/trials/combine_trials.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Derivatives of a test's residuals: of the machine's parameters, of the terms, of its own unknowns.
struct TestDerivatives {
  MatrixXd machine, terms, own;
};

TestDerivatives calcTestDerivatives(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                                    const VectorXd& point, const std::vector<TermCandidate>& candidates,
                                    double factor) {
  AugmentedExperiment all = addAll(experiment, candidates);
  if (factor != 1.0) {
    changeTrials(all.experiment, [&](ExperimentSpec& one) { scaleSignals(one.model, factor); });
  }
  const auto p = static_cast<Index>(experiment.model.parameters.size());
  const RecordingsProblem problem(all.experiment, recordings);
  const MatrixXd jacobian = problem.linearize(insertAdded(point, p, VectorXd::Zero(all.added))).jacobian;
  return {jacobian.leftCols(p), jacobian.middleCols(p, all.added),
          jacobian.rightCols(jacobian.cols() - p - all.added)};
}

/// Whether chi-square of any other term is so much larger, where the first is missing by what was found.
bool tells(const TestDerivatives& first, const TestDerivatives& second, double estimate) {
  constexpr double kTold = 2.0 * (kTiedEvidence + 3.0);  // the evidence differs by twice what ties
  const Index n = first.machine.rows(), m = second.machine.rows(), p = first.machine.cols();
  MatrixXd jacobian = MatrixXd::Zero(n + m, p + first.own.cols() + second.own.cols());
  jacobian.leftCols(p) << first.machine, second.machine;
  jacobian.block(0, p, n, first.own.cols()) = first.own;
  jacobian.block(n, p + first.own.cols(), m, second.own.cols()) = second.own;
  MatrixXd terms(n + m, first.terms.cols());
  terms << first.terms, second.terms;
  const ScoreTest test(VectorXd::Zero(n + m), jacobian, terms);
  const double whole = estimate * test.calcLength(0);
  for (Index k = 1; k < terms.cols(); ++k) {
    const double likeness = test.calcLikeness(0, k);
    if (whole * whole * (1.0 - likeness * likeness) < kTold) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::string adviseSecondTest(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                             const VectorXd& point, const std::vector<TermFinding>& tied) {
  if (experiment.model.excitation.empty()) {
    return "a second test from another initial state may";
  }
  std::vector<TermCandidate> candidates;
  for (const TermFinding& finding : tied) {
    candidates.push_back(finding.candidate);
  }
  const TestDerivatives first = calcTestDerivatives(experiment, recordings, point, candidates, 1.0);
  for (const double factor : {2.0, 0.5, 4.0}) {
    const TestDerivatives second = calcTestDerivatives(experiment, recordings, point, candidates, factor);
    if (tells(first, second, tied.front().estimate)) {
      return fmt::format("a second test at {} times the amplitude would", toText(factor));
    }
  }
  return "no second test at half to four times the amplitude would";
}

}  // namespace twinmap
