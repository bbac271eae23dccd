#include "framework/diagnosis/second_test.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "framework/base/text/number_text.hpp"
#include "framework/diagnosis/candidates/term_candidates.hpp"
#include "framework/diagnosis/problem/score_test.hpp"
#include "framework/estimation/bounded_information.hpp"
#include "framework/experiment/model/parameter_box.hpp"
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
FittedTest linearizeTest(const FittedTerm& fitted, const RecordedFeatures& recordings, double factor,
                         const VectorXd& point) {
  ExperimentSpec experiment = fitted.augmented.experiment;
  if (factor != 1.0) {
    changeTrials(experiment, [&](ExperimentSpec& one) { scaleSignals(one.model, factor); });
  }
  const auto shared = static_cast<Index>(experiment.model.parameters.size());
  const LinearizedRecordings linear = RecordingsProblem(experiment, recordings).linearize(point);
  return {linear.residual, linear.jacobian.leftCols(shared),
          linear.jacobian.rightCols(linear.jacobian.cols() - shared)};
}

std::vector<FittedTest> linearizeAll(const std::vector<const FittedTerm*>& tied,
                                     const RecordedFeatures& recordings, double factor) {
  std::vector<FittedTest> tests;
  for (const FittedTerm* fitted : tied) {
    tests.push_back(linearizeTest(*fitted, recordings, factor, fitted->point));
  }
  return tests;
}

/// The least difference D of chi-square without noise behind which terms are told apart in 95 % of
/// measurements: the evidence differs by D/2 with a standard deviation of sqrt(D), and ties below
/// kTiedEvidence.
double calcToldChiSquare() {
  const double quantile = boost::math::quantile(boost::math::normal(), 0.95);
  const double root = quantile + std::sqrt(quantile * quantile + 2.0 * kTiedEvidence);
  return root * root;
}

/// What moves the second test's response most of all that changes shared parameters by one standard deviation
/// as the first test leaves them, within their bounds.
VectorXd calcLargestChange(const FittedTerm& fitted, const FittedTest& first, const FittedTest& second) {
  const std::vector<ParameterSpec>& parameters = fitted.augmented.experiment.model.parameters;
  const VectorXd half_widths = 0.5 * calcWidths(parameters);
  const MatrixXd covariance = BoundedInformation(first.shared, half_widths).calcCovariance();
  const MatrixXd root = half_widths.asDiagonal() * linalg::calcCholesky(covariance).lower;
  const MatrixXd moves = second.shared * root;
  VectorXd change = root * linalg::calcSymmetricEigen(moves.transpose() * moves).vectors.rightCols(1);
  double fits = 1.0;
  for (Index i = 0; i < change.size(); ++i) {
    const Bounds& bounds = parameters[static_cast<std::size_t>(i)].bounds;
    const double room = change[i] > 0.0 ? bounds.upper - fitted.point[i] : fitted.point[i] - bounds.lower;
    fits = std::min(fits,
                    std::max(room, 0.0) / std::max(std::abs(change[i]), std::numeric_limits<double>::min()));
  }
  return fits * change;
}

/// Whether what the first test leaves open changes the second one's response as the linear model has it, by
/// half at least or up to the noise. Else, as where a pendulum goes over the top, no fit to both is sure to
/// end where it should.
bool isPredictable(const FittedTerm& fitted, const RecordedFeatures& recordings, double factor,
                   const FittedTest& first, const FittedTest& second) {
  constexpr double kShare = 0.5, kNoise = 2.0;
  VectorXd moved = fitted.point;
  const VectorXd change = calcLargestChange(fitted, first, second);
  moved.head(change.size()) += change;
  const VectorXd linear = second.shared * change;
  const FittedTest there = linearizeTest(fitted, recordings, factor, moved);
  const double missed = (second.residual - there.residual - linear).norm();
  return missed < std::max(kShare * linear.norm(), kNoise);
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

/// Also not where one of the models cannot be simulated so.
bool tellsWith(double factor, const std::vector<const FittedTerm*>& tied, const RecordedFeatures& recordings,
               const std::vector<FittedTest>& first) {
  try {
    const std::vector<FittedTest> second = linearizeAll(tied, recordings, factor);
    bool told = tells(first, second);
    for (std::size_t i = 0; i < tied.size() && told; ++i) {
      told = isPredictable(*tied[i], recordings, factor, first[i], second[i]);
    }
    return told;
  } catch (const std::runtime_error&) {
    return false;
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
    if (tellsWith(factor, tied, recordings, first)) {
      return fmt::format("a second test at {} times the amplitude would", toText(factor));
    }
  }
  return "no second test at half to four times the amplitude would";
}

}  // namespace twinmap
