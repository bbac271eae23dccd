#include "framework/diagnosis/remainder/remainder.hpp"

#include <algorithm>
#include <cmath>

#include "framework/diagnosis/remainder/process_effects.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// A recording at the fit.
struct FittedRecording {
  LinearizedRecordings linear;  ///< of its own unknown parameters: those of the machine, then its nuisance
  std::vector<ProcessEffect> effects;
};

/// Of a process of unit variance between its knots.
MatrixXd calcCorrelation(const VectorXd& knots, double correlation_time) {
  return MatrixXd::NullaryExpr(knots.size(), knots.size(), [&](Index i, Index j) {
    return std::exp(-std::abs(knots[i] - knots[j]) / correlation_time);
  });
}

MatrixXd joinData(const LinearizedRecordings& linear) {
  MatrixXd data(linear.residual.size(), 1 + linear.jacobian.cols());
  data << linear.residual, linear.jacobian;
  return data;
}

/// A process of a correlation time, in directions in which its parts are independent: residuals and
/// derivatives of a recording in them.
struct IndependentParts {
  VectorXd variances;  ///< m, of a process of unit variance
  MatrixXd projected;  ///< m x (1 + u), of [residual, jacobian]
};

IndependentParts splitProcess(const ProcessEffect& effect, const LinearizedRecordings& linear,
                              double correlation_time) {
  const MatrixXd covariance = calcCorrelation(effect.knots, correlation_time);
  const MatrixXd directions =
      effect.responses * linalg::calcCholesky(covariance).lower.triangularView<Eigen::Lower>();
  const linalg::SymmetricEigen eigen = linalg::calcSymmetricEigen(directions.transpose() * directions);
  return {eigen.values.cwiseMax(0.0),
          eigen.vectors.transpose() * (directions.transpose() * joinData(linear))};
}

/// Sums of one quadratic form [r, J]' V^-1 [r, J] over recordings, in the places of all unknown parameters.
struct Whitened {
  double residual = 0.0, log_determinant = 0.0;
  VectorXd gradient;
  MatrixXd information;
};

void addRecording(const LinearizedRecordings& linear, const IndependentParts& parts, double variance,
                  const std::vector<Index>& places, Whitened& sum) {
  const MatrixXd data = joinData(linear);
  // V^-1 = I - H (1/s^2 + H'H)^-1 H'
  const VectorXd weights = (variance / (1.0 + variance * parts.variances.array())).matrix();
  const MatrixXd inner =
      data.transpose() * data - parts.projected.transpose() * weights.asDiagonal() * parts.projected;
  const Index u = linear.jacobian.cols();
  sum.residual += inner(0, 0);
  sum.log_determinant += (1.0 + variance * parts.variances.array()).log().sum();
  sum.gradient(places) += inner.col(0).tail(u);
  sum.information(places, places) += inner.bottomRightCorner(u, u);
}

/// All recordings with one kind of process of a correlation time.
class ProcessModel {
 public:
  ProcessModel(const std::vector<FittedRecording>& recordings, std::size_t effect, double correlation_time,
               Index p)
      : recordings_(recordings), p_(p), unknown_(p) {
    for (const FittedRecording& recording : recordings) {
      parts_.push_back(splitProcess(recording.effects[effect], recording.linear, correlation_time));
      places_.emplace_back();
      for (Index i = 0; i < recording.linear.jacobian.cols(); ++i) {
        places_.back().push_back(i < p ? i : unknown_++);
      }
    }
  }

  /// half_widths: u, of a recording's own parameters, whose bounds count as weak information.
  Whitened whiten(double variance, const VectorXd& half_widths) const {
    Whitened sum;
    sum.gradient = VectorXd::Zero(unknown_);
    sum.information = MatrixXd::Zero(unknown_, unknown_);
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      addRecording(recordings_[k].linear, parts_[k], variance, places_[k], sum);
      for (std::size_t i = 0; i < places_[k].size(); ++i) {
        const double half = half_widths[static_cast<Index>(i)];
        sum.information(places_[k][i], places_[k][i]) =
            std::max(sum.information(places_[k][i], places_[k][i]), kHalfWidthInformation / (half * half));
      }
    }
    return sum;
  }

  Index countUnknown() const { return unknown_; }

 private:
  const std::vector<FittedRecording>& recordings_;
  const Index p_;
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

/// The best size and correlation time of one process.
struct BestProcess {
  double log_evidence = -kInfinity, variance = 0.0, correlation_time = 0.0;
};

/// What the freedom of both costs: their logarithms are known to about a third within a prior of some units.
constexpr double kLogCostOfProcess = 3.0;

BestProcess searchProcess(const std::vector<FittedRecording>& recordings, std::size_t effect, Index p,
                          const VectorXd& half_widths, double duration) {
  // sizes from what hardly shows to a thousand times that, in steps of a half; few correlation times: the
  // evidence changes little with them
  constexpr int kSizes = 24;
  constexpr double kStep = 1.6;
  BestProcess best;
  for (const double share : {0.02, 0.06, 0.2}) {
    const ProcessModel model(recordings, effect, share * duration, p);
    const double scale = recordings.front().effects[effect].responses.norm();
    double stddev = 0.1 * std::sqrt(static_cast<double>(recordings.front().linear.residual.size())) /
                    std::max(scale, 1e-300);
    const double none = calcRestricted(model.whiten(0.0, half_widths));
    for (int i = 0; i < kSizes; ++i, stddev *= kStep) {
      const double variance = stddev * stddev;
      const double gain = calcRestricted(model.whiten(variance, half_widths)) - none - kLogCostOfProcess;
      if (gain > best.log_evidence) {
        best = {gain, variance, share * duration};
      }
    }
  }
  return best;
}

void setEstimate(const std::vector<FittedRecording>& recordings, std::size_t effect, const BestProcess& best,
                 const VectorXd& point, Index p, const VectorXd& half_widths, Remainder& remainder) {
  const ProcessModel model(recordings, effect, best.correlation_time, p);
  const Whitened sum = model.whiten(best.variance, half_widths);
  const linalg::Cholesky factor = linalg::calcCholesky(sum.information);
  const VectorXd step = linalg::solveCholesky(factor.lower, sum.gradient);
  const MatrixXd covariance =
      linalg::solveCholesky(factor.lower, MatrixXd::Identity(sum.information.rows(), sum.information.cols()));
  remainder.mean = point.head(p) + step.head(p);
  remainder.stddevs = covariance.diagonal().head(p).cwiseSqrt();
  const FittedRecording& first = recordings.front();
  const VectorXd left =
      first.linear.residual - first.linear.jacobian * step.head(first.linear.jacobian.cols());
  const ProcessEffect& process = first.effects[effect];
  const MatrixXd prior = best.variance * calcCorrelation(process.knots, best.correlation_time);
  // the process given what is left: K G' (I + G K G')^-1 r
  const MatrixXd lower = linalg::calcCholesky(prior).lower.triangularView<Eigen::Lower>();
  const MatrixXd directions = process.responses * lower;
  MatrixXd inner = directions.transpose() * directions;
  inner.diagonal().array() += 1.0;
  remainder.process = lower * linalg::solvePositiveDefinite(inner, directions.transpose() * left);
  remainder.times = process.knots;
}

/// The machine's parameters by each recording alone, around the common fit.
void widenByScatter(const std::vector<FittedRecording>& recordings, const VectorXd& point, Index p,
                    const VectorXd& half_widths, Remainder& remainder) {
  constexpr std::size_t kFewest = 3;  // of two the scatter is not known
  if (recordings.size() < kFewest) {
    return;
  }
  const auto n = static_cast<Index>(recordings.size());
  MatrixXd estimates(p, n), stddevs(p, n);
  for (Index k = 0; k < n; ++k) {
    const LinearizedRecordings& linear = recordings[static_cast<std::size_t>(k)].linear;
    MatrixXd information = linear.jacobian.transpose() * linear.jacobian;
    information.diagonal().array() += kHalfWidthInformation / half_widths.array().square();
    const linalg::Cholesky factor = linalg::calcCholesky(information);
    const VectorXd step = linalg::solveCholesky(factor.lower, linear.jacobian.transpose() * linear.residual);
    const MatrixXd covariance =
        linalg::solveCholesky(factor.lower, MatrixXd::Identity(information.rows(), information.cols()));
    estimates.col(k) = point.head(p) + step.head(p);
    stddevs.col(k) = covariance.diagonal().head(p).cwiseSqrt();
  }
  for (Index i = 0; i < p; ++i) {
    const RandomEffects effects = calcRandomEffects(estimates.row(i), stddevs.row(i));
    remainder.stddevs[i] = std::max(remainder.stddevs[i], effects.stddev);
  }
}

std::vector<FittedRecording> fitRecordings(const ExperimentSpec& experiment,
                                           const RecordedFeatures& recordings, const VectorXd& point) {
  const auto p = static_cast<Index>(experiment.model.parameters.size());
  const auto own = static_cast<Index>(experiment.model.nuisance.size());
  std::vector<FittedRecording> fitted;
  for (std::size_t k = 0; k < recordings.features.size(); ++k) {
    const RecordedFeatures one = recordings.select({k});
    VectorXd at(p + own);
    at << point.head(p), point.segment(p + static_cast<Index>(k) * own, own);
    const RecordingsProblem problem(experiment, one);
    fitted.push_back({problem.linearize(at), listProcessEffects(experiment, one, at, problem.listInfos())});
  }
  return fitted;
}

}  // namespace

std::optional<Remainder> findRemainder(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                                       const VectorXd& point, Index p) {
  const std::vector<FittedRecording> fitted = fitRecordings(experiment, recordings, point);
  const auto all = static_cast<Index>(experiment.model.parameters.size());
  const VectorXd half_widths = 0.5 * calcWidths(collectUnknown(experiment.model));
  BestProcess best;
  std::size_t effect = 0;
  for (std::size_t e = 0; e < fitted.front().effects.size(); ++e) {
    const BestProcess process =
        searchProcess(fitted, e, all, half_widths, experiment.model.simulation.duration);
    if (process.log_evidence > best.log_evidence) {
      best = process;
      effect = e;
    }
  }
  if (!(best.log_evidence > 0.0)) {
    return {};
  }
  Remainder remainder;
  remainder.what = fitted.front().effects[effect].what;
  remainder.unit = fitted.front().effects[effect].unit;
  remainder.stddev = std::sqrt(best.variance);
  remainder.correlation_time = best.correlation_time;
  remainder.log_evidence = best.log_evidence;
  setEstimate(fitted, effect, best, point, all, half_widths, remainder);
  widenByScatter(fitted, point, all, half_widths, remainder);
  remainder.mean.conservativeResize(p);
  remainder.stddevs.conservativeResize(p);
  return remainder;
}

Index Remainder::findOutside(const std::vector<ParameterSpec>& parameters) const {
  for (Index i = 0; i < mean.size(); ++i) {
    const Bounds& bounds = parameters[static_cast<std::size_t>(i)].bounds;
    if (mean[i] < bounds.lower - stddevs[i] || mean[i] > bounds.upper + stddevs[i]) {
      return i;
    }
  }
  return -1;
}

RandomEffects calcRandomEffects(const VectorXd& estimates, const VectorXd& stddevs) {
  const VectorXd weights = stddevs.cwiseAbs2().cwiseInverse();
  const double sum = weights.sum(), common = weights.dot(estimates) / sum;
  const double scatter = weights.dot((estimates.array() - common).square().matrix());
  const double free = static_cast<double>(estimates.size() - 1);
  const double scale = sum - weights.squaredNorm() / sum;
  RandomEffects effects;
  const double between = scale > 0.0 ? std::max(0.0, (scatter - free) / scale) : 0.0;
  const VectorXd wider = (stddevs.cwiseAbs2().array() + between).inverse().matrix();
  effects.mean = wider.dot(estimates) / wider.sum();
  effects.stddev = 1.0 / std::sqrt(wider.sum());
  effects.between = std::sqrt(between);
  return effects;
}

}  // namespace twinmap
