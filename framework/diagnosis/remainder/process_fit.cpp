#include "framework/diagnosis/remainder/process_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Of a process of unit variance between its knots.
MatrixXd calcCorrelation(const VectorXd& knots, double length) {
  return MatrixXd::NullaryExpr(knots.size(), knots.size(), [&](Index i, Index j) {
    return std::exp(-std::abs(knots[i] - knots[j]) / length);
  });
}

MatrixXd joinData(const LinearizedRecordings& linear) {
  MatrixXd data(linear.residual.size(), 1 + linear.jacobian.cols());
  data << linear.residual, linear.jacobian;
  return data;
}

/// A process of a correlation length, in directions in which its parts are independent: residuals and
/// derivatives of a recording in them.
struct IndependentParts {
  VectorXd variances;   ///< k, of what a process of unit variance does
  MatrixXd projected;   ///< k x (1 + u), of [residual, jacobian]
  MatrixXd directions;  ///< k x k, of the values at the knots: those of unit variance are independent
  MatrixXd rest;        ///< (1 + u) x (1 + u), squares of [residual, jacobian] that no part reaches
  VectorXd inverses;    ///< k: 1 / variances; 0 of parts that do too little to have a direction
};

IndependentParts splitProcess(const ProcessEffect& effect, const LinearizedRecordings& linear,
                              double length) {
  const MatrixXd lower = linalg::calcCholesky(calcCorrelation(effect.knots, length)).lower;
  const MatrixXd responses = effect.responses * lower.triangularView<Eigen::Lower>();
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(responses.transpose() * responses);
  // products of doubles resolve no more
  const double least = std::sqrt(std::numeric_limits<double>::epsilon()) * eigen.values.maxCoeff();
  const VectorXd inverses = (eigen.values.array() > least).select(eigen.values.cwiseInverse(), 0.0);
  MatrixXd data = joinData(linear);
  const MatrixXd projected = eigen.vectors.transpose() * (responses.transpose() * data);
  data -= responses * (eigen.vectors * (inverses.asDiagonal() * projected));
  return {eigen.values.cwiseMax(0.0), projected, lower.triangularView<Eigen::Lower>() * eigen.vectors,
          data.transpose() * data, inverses};
}

/// Sums of one quadratic form [r, J]' V^-1 [r, J] over recordings, in the places of all unknown parameters: a
/// sum of squares, so that a parameter that hardly acts does not get information from rounding.
struct Whitened {
  double residual = 0.0, log_determinant = 0.0;
  VectorXd gradient;
  MatrixXd information;
};

void addRecording(const LinearizedRecordings& linear, const IndependentParts& parts, double variance,
                  const std::vector<Index>& places, Whitened& sum) {
  const VectorXd weights = (parts.inverses.array() / (1.0 + variance * parts.variances.array())).matrix();
  const MatrixXd inner = parts.rest + parts.projected.transpose() * weights.asDiagonal() * parts.projected;
  const Index u = linear.jacobian.cols();
  sum.residual += inner(0, 0);
  sum.log_determinant += (1.0 + variance * parts.variances.array()).log().sum();
  sum.gradient(places) += inner.col(0).tail(u);
  sum.information(places, places) += inner.bottomRightCorner(u, u);
}

/// All recordings with a process of a correlation length.
class ProcessModel {
 public:
  ProcessModel(const ProcessProblem& problem, double length) : problem_(problem), unknown_(problem.shared) {
    for (const FittedRecording& recording : problem.recordings) {
      parts_.push_back(splitProcess(recording.effects[problem.effect], recording.linear, length));
      places_.emplace_back();
      for (Index i = 0; i < recording.linear.jacobian.cols(); ++i) {
        places_.back().push_back(i < problem.shared ? i : unknown_++);
      }
    }
  }

  Whitened whiten(double variance) const {
    Whitened sum;
    sum.gradient = VectorXd::Zero(unknown_);
    sum.information = MatrixXd::Zero(unknown_, unknown_);
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      addRecording(problem_.recordings[k].linear, parts_[k], variance, places_[k], sum);
      for (std::size_t i = 0; i < places_[k].size(); ++i) {
        const bool is_counted = k > 0 && static_cast<Index>(i) < problem_.shared;
        const double half = problem_.recordings[k].half_widths[static_cast<Index>(i)];
        sum.information(places_[k][i], places_[k][i]) +=
            is_counted ? 0.0 : kHalfWidthInformation / (half * half);
      }
    }
    return sum;
  }

  /// The process of recording k where the parameters are `step` from the fit, which is known so well.
  void estimate(std::size_t k, double variance, ProcessEstimate& estimate) const {
    const IndependentParts& parts = parts_[k];
    const VectorXd own = estimate.step(places_[k]);
    const MatrixXd own_covariance = estimate.covariance(places_[k], places_[k]);
    // each part given the parameters, then what these leave open
    const VectorXd weights = (variance / (1.0 + variance * parts.variances.array())).matrix();
    const MatrixXd slopes = weights.asDiagonal() * parts.projected.rightCols(own.size());
    estimate.means.push_back(parts.directions *
                             (weights.cwiseProduct(parts.projected.col(0)) - slopes * own));
    const MatrixXd by_parameters = parts.directions * slopes;
    const VectorXd variances = parts.directions.cwiseAbs2() * weights +
                               (by_parameters * own_covariance).cwiseProduct(by_parameters).rowwise().sum();
    estimate.stddevs.push_back(variances.cwiseMax(0.0).cwiseSqrt());
  }

 private:
  const ProcessProblem& problem_;
  Index unknown_;
  std::vector<IndependentParts> parts_;
  std::vector<std::vector<Index>> places_;
};

/// log of the restricted likelihood.
double calcRestricted(const Whitened& sum) {
  const linalg::Cholesky factor = linalg::calcCholesky(sum.information);
  const VectorXd step = linalg::solveCholesky(factor.lower, sum.gradient);
  return -0.5 * (sum.residual - sum.gradient.dot(step)) - 0.5 * sum.log_determinant -
         factor.lower.diagonal().array().log().sum();
}

/// What the freedom of both costs: their logarithms are known to about a third within a prior of some units.
constexpr double kLogCostOfProcess = 3.0;

}  // namespace

BestProcess searchProcess(const ProcessProblem& problem, const std::vector<double>& lengths) {
  // sizes from what hardly shows to some thousand times that, in steps of a half
  constexpr int kSizes = 24;
  constexpr double kStep = 1.6;
  double scale = 0.0, residuals = 0.0;
  for (const FittedRecording& recording : problem.recordings) {
    if (const double own = recording.effects[problem.effect].responses.norm(); own > scale) {
      scale = own;
      residuals = static_cast<double>(recording.linear.residual.size());
    }
  }
  BestProcess best;
  for (const double length : lengths) {
    const ProcessModel model(problem, length);
    double stddev = 0.1 * std::sqrt(residuals) / std::max(scale, 1e-300);
    const double none = calcRestricted(model.whiten(0.0));
    for (int i = 0; i < kSizes; ++i, stddev *= kStep) {
      const double variance = stddev * stddev;
      const double gain = calcRestricted(model.whiten(variance)) - none - kLogCostOfProcess;
      if (gain > best.log_evidence) {
        best = {gain, variance, length};
      }
    }
  }
  return best;
}

ProcessEstimate estimateProcess(const ProcessProblem& problem, const BestProcess& best) {
  const ProcessModel model(problem, best.correlation_length);
  const Whitened sum = model.whiten(best.variance);
  ProcessEstimate estimate;
  estimate.covariance = linalg::invertPositiveDefinite(sum.information);
  estimate.step = linalg::solvePositiveDefinite(sum.information, sum.gradient);
  for (std::size_t k = 0; k < problem.recordings.size(); ++k) {
    model.estimate(k, best.variance, estimate);
  }
  return estimate;
}

}  // namespace twinmap
