#include "framework/diagnosis/second_test.hpp"

#include <fmt/core.h>

#include <cmath>
#include <optional>
#include <stdexcept>

#include "framework/base/text/number_text.hpp"
#include "framework/diagnosis/candidates/term_candidates.hpp"
#include "framework/diagnosis/score_test.hpp"
#include "framework/experiment/trials/combine_trials.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// A test of a model with a term at its fit: residuals, and their derivatives by what all tests share (the
/// machine's parameters and the term's own) and by what is the test's own.
struct FittedTest {
  VectorXd residual;
  MatrixXd shared, own;
};

/// With all signals `factor` times as large, against the recordings as they are: differences between terms do
/// not depend on these.
FittedTest linearizeTest(const FittedTerm& fitted, const RecordedFeatures& recordings, double factor) {
  ExperimentSpec experiment = fitted.augmented.experiment;
  if (factor != 1.0) {
    changeTrials(experiment, [&](ExperimentSpec& one) { scaleSignals(one.model, factor); });
  }
  const auto shared = static_cast<Index>(experiment.model.parameters.size());
  const LinearizedRecordings linear = RecordingsProblem(experiment, recordings).linearize(fitted.point);
  return {linear.residual, linear.jacobian.leftCols(shared),
          linear.jacobian.rightCols(linear.jacobian.cols() - shared)};
}

std::vector<FittedTest> linearizeAll(const std::vector<const FittedTerm*>& tied,
                                     const RecordedFeatures& recordings, double factor) {
  std::vector<FittedTest> tests;
  for (const FittedTerm* fitted : tied) {
    tests.push_back(linearizeTest(*fitted, recordings, factor));
  }
  return tests;
}

/// The least difference D of chi-square without noise behind which terms are told apart in 95 % of
/// measurements: the evidence differs by D/2 with a standard deviation of sqrt(D), and ties below
/// kTiedEvidence.
double calcToldChiSquare() {
  constexpr double kQuantile = 1.645;  // of the normal distribution at 95 %
  const double root = kQuantile + std::sqrt(kQuantile * kQuantile + 2.0 * kTiedEvidence);
  return root * root;
}

/// The chi-square, less the noise, behind which a model ends that is fitted to two tests of a machine with
/// another term: its parameters, the term's own scales among them, follow by one Gauss-Newton step.
double calcSeparation(const FittedTest& first, const FittedTest& second, const FittedTest& machine_first,
                      const FittedTest& machine_second) {
  const Index n = first.residual.size(), m = second.residual.size(), p = first.shared.cols();
  MatrixXd jacobian = MatrixXd::Zero(n + m, p + first.own.cols() + second.own.cols());
  jacobian.leftCols(p) << first.shared, second.shared;
  jacobian.block(0, p, n, first.own.cols()) = first.own;
  jacobian.block(n, p + first.own.cols(), m, second.own.cols()) = second.own;
  VectorXd difference(n + m);
  difference << first.residual - machine_first.residual, second.residual - machine_second.residual;
  const VectorXd lengths =
      jacobian.colwise().norm().transpose().unaryExpr([](double x) { return x > 0.0 ? x : 1.0; });
  const MatrixXd scaled = jacobian * lengths.cwiseInverse().asDiagonal();
  return (difference - scaled * linalg::fitLinear(scaled, difference).coefficients).squaredNorm();
}

/// Whether two tests tell each of the terms from all others: any of them may be the one that is missing.
bool tells(const std::vector<FittedTest>& first, const std::vector<FittedTest>& second) {
  const double told = calcToldChiSquare();
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (std::size_t k = 0; k < first.size(); ++k) {
      if (k != i && !(calcSeparation(first[k], second[k], first[i], second[i]) > told)) {
        return false;
      }
    }
  }
  return true;
}

/// None where one of the models cannot be simulated so.
std::optional<std::vector<FittedTest>> tryTest(const std::vector<const FittedTerm*>& tied,
                                               const RecordedFeatures& recordings, double factor) {
  try {
    return linearizeAll(tied, recordings, factor);
  } catch (const std::runtime_error&) {
    return {};
  }
}

}  // namespace

std::string adviseSecondTest(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                             const std::vector<const FittedTerm*>& tied) {
  if (experiment.model.excitation.empty()) {
    return "a second test from another initial state may";
  }
  const std::vector<FittedTest> first = linearizeAll(tied, recordings, 1.0);
  for (const double factor : {2.0, 0.5, 4.0}) {
    const std::optional<std::vector<FittedTest>> second = tryTest(tied, recordings, factor);
    if (second && tells(first, *second)) {
      return fmt::format("a second test at {} times the amplitude would", toText(factor));
    }
  }
  return "no second test at half to four times the amplitude would";
}

}  // namespace twinmap
