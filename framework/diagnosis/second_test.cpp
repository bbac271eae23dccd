#include "framework/diagnosis/second_test.hpp"

#include <fmt/core.h>

#include <cmath>

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

/// The least difference D of chi-square without noise behind which terms are told apart in 95 % of
/// measurements: the evidence differs by D/2 with a standard deviation of sqrt(D), and ties below
/// kTiedEvidence.
double calcToldChiSquare() {
  constexpr double kQuantile = 1.645;  // of the normal distribution at 95 %
  const double root = kQuantile + std::sqrt(kQuantile * kQuantile + 2.0 * kTiedEvidence);
  return root * root;
}

/// Whether both tests tell each of the terms from all others, where it is missing by what was found: any of
/// them may be the one.
bool tells(const TestDerivatives& first, const TestDerivatives& second,
           const std::vector<TermFinding>& tied) {
  const Index n = first.machine.rows(), m = second.machine.rows(), p = first.machine.cols();
  MatrixXd jacobian = MatrixXd::Zero(n + m, p + first.own.cols() + second.own.cols());
  jacobian.leftCols(p) << first.machine, second.machine;
  jacobian.block(0, p, n, first.own.cols()) = first.own;
  jacobian.block(n, p + first.own.cols(), m, second.own.cols()) = second.own;
  MatrixXd terms(n + m, first.terms.cols());
  terms << first.terms, second.terms;
  const ScoreTest test(VectorXd::Zero(n + m), jacobian, terms);
  const double told = calcToldChiSquare();
  for (Index i = 0; i < terms.cols(); ++i) {
    const double whole = tied[static_cast<std::size_t>(i)].estimate * test.calcLength(i);
    for (Index k = 0; k < terms.cols(); ++k) {
      const double likeness = test.calcLikeness(i, k);
      if (k != i && whole * whole * (1.0 - likeness * likeness) < told) {
        return false;
      }
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
    if (tells(first, second, tied)) {
      return fmt::format("a second test at {} times the amplitude would", toText(factor));
    }
  }
  return "no second test at half to four times the amplitude would";
}

}  // namespace twinmap
