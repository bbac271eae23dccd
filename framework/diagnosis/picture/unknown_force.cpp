#include "framework/diagnosis/picture/unknown_force.hpp"

#include <algorithm>
#include <cmath>

#include "framework/diagnosis/remainder/process_fit.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/decompositions.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Of a force over position or speed: a step is then 2 % of the range wide. With half as many the band of dry
/// friction held .86 of its true force instead of .99 (oscillator, 8 tests).
constexpr Index kRangeKnots = 65;

/// Over time: so many in a period of the motion, so that a step in each half of it shows; within what is
/// drawn and simulated in some tenths of a second.
constexpr double kKnotsPerPeriod = 16.0;
constexpr Index kFewestKnots = 40, kMostKnots = 320;
constexpr double kMostBytes = 256.0 * 1024 * 1024;  // of derivatives by knots

/// Correlation lengths, of a period or a range: the evidence changes little with them. Smoother processes
/// have as much of it, but bands that hold too little about a step.
constexpr double kLengthShares[] = {0.05, 0.2, 1.0};

/// Parameters, by their number, that are there: all but `count` from `first` on.
struct Dropped {
  Index first = 0, count = 0;

  std::vector<Index> listKept(Index all) const {
    std::vector<Index> kept;
    for (Index i = 0; i < all; ++i) {
      if (i < first || i >= first + count) {
        kept.push_back(i);
      }
    }
    return kept;
  }
};

/// Residuals and derivatives per half-width of a parameter.
LinearizedRecordings linearizeScaled(const RecordingsProblem& problem, const VectorXd& point) {
  LinearizedRecordings linear = problem.linearize(point);
  linear.jacobian *= (0.5 * calcWidths(problem.getUnknown())).asDiagonal();
  return linear;
}

/// Of all unknown parameters by the linear model and their bounds.
MatrixXd calcFitCovariance(const LinearizedRecordings& linear) {
  MatrixXd hessian = linear.jacobian.transpose() * linear.jacobian;
  hessian.diagonal().array() += kHalfWidthInformation;
  return linalg::solveCholesky(linalg::calcCholesky(hessian).lower,
                               MatrixXd::Identity(hessian.rows(), hessian.cols()));
}

/// What is known of the parameters by their covariance, as further residuals.
void addKnowledge(const MatrixXd& covariance, LinearizedRecordings& linear) {
  const Index n = linear.residual.size(), u = covariance.rows();
  const MatrixXd information =
      linalg::solveCholesky(linalg::calcCholesky(covariance).lower, MatrixXd::Identity(u, u));
  linear.residual.conservativeResize(n + u);
  linear.residual.tail(u).setZero();
  linear.jacobian.conservativeResize(n + u, Eigen::NoChange);
  linear.jacobian.bottomRows(u) = linalg::calcCholesky(information).lower.transpose();
}

/// One or several recordings at the fit.
class ForceProblem {
 public:
  ForceProblem(const ExperimentSpec& experiment, const RecordedFeatures& recordings, const VectorXd& point)
      : experiment_(experiment),
        recordings_(recordings),
        point_(point),
        linear_(linearizeScaled(RecordingsProblem(experiment, recordings), point)) {}

  const LinearizedRecordings& getLinear() const { return linear_; }

  /// What is known of all parameters by the fit.
  void setCovariance(const MatrixXd& covariance) { covariance_ = covariance; }

  /// A force on a coordinate as a function of a quantity, scale: of its correlation lengths. In the place of
  /// a term, without its parameters and with its force (n) in the residual, the others are known as the fit
  /// knows them; else they are free within their bounds.
  ForceCurve estimate(const ForcedCoordinate& coordinate, const std::string& quantity, const VectorXd& knots,
                      double scale, const Dropped& dropped, const VectorXd& term_effect) const {
    const std::vector<Index> kept = dropped.listKept(linear_.jacobian.cols());
    std::vector<FittedRecording> fitted(1);
    LinearizedRecordings& linear = fitted[0].linear;
    linear = {linear_.residual + term_effect, linear_.jacobian(Eigen::all, kept), {}};
    if (dropped.count > 0) {
      addKnowledge(covariance_(kept, kept), linear);
    }
    fitted[0].effects.push_back(
        calcForceEffect(experiment_, recordings_, point_, coordinate, quantity, knots));
    MatrixXd& responses = fitted[0].effects[0].responses;
    const Index n = responses.rows(), all = linear.residual.size();
    responses.conservativeResize(all, Eigen::NoChange);
    responses.bottomRows(all - n).setZero();
    const auto u = static_cast<Index>(kept.size());
    const ProcessProblem problem{fitted, 0, u, VectorXd::Ones(u)};
    std::vector<double> lengths;
    for (const double share : kLengthShares) {
      lengths.push_back(share * scale);
    }
    const BestProcess best = searchProcess(problem, lengths);
    const ProcessEstimate estimate = estimateProcess(problem, best);
    return {knots, estimate.means.front(), estimate.stddevs.front(), std::sqrt(best.variance),
            best.log_evidence};
  }

  /// What the force of a term does to the residual (n).
  VectorXd calcEffect(const ForcedCoordinate& coordinate, const Expression& force) const {
    return calcForceEffect(experiment_, recordings_, point_, coordinate, force);
  }

 private:
  const ExperimentSpec& experiment_;
  RecordedFeatures recordings_;
  VectorXd point_;
  LinearizedRecordings linear_;
  MatrixXd covariance_;
};

/// Half of the times at which a speed changes its sign; at least one.
double countPeriods(const VectorXd& speed) {
  int changes = 0;
  for (Index i = 1; i < speed.size(); ++i) {
    changes += speed[i] * speed[i - 1] < 0.0 ? 1 : 0;
  }
  return std::max(1.0, 0.5 * changes);
}

VectorXd spreadKnots(const VectorXd& values) {
  return VectorXd::LinSpaced(kRangeKnots, values.minCoeff(), values.maxCoeff());
}

double calcRange(const VectorXd& values) {
  return values.maxCoeff() - values.minCoeff();
}

VectorXd append(const VectorXd& values, const VectorXd& more) {
  VectorXd all(values.size() + more.size());
  all << values, more;
  return all;
}

class ForceEstimator {
 public:
  ForceEstimator(const Diagnosis& diagnosis, const RecordedFeatures& recordings, const FitMotion& motion,
                 std::size_t count)
      : diagnosis_(diagnosis),
        motion_(motion),
        together_(diagnosis.corrected, recordings, diagnosis.after.posterior.best) {
    constexpr Index kFineSamples = 1001;  // some tens in the shortest period
    fine_times_ = VectorXd::LinSpaced(kFineSamples, 0.0, diagnosis.corrected.model.simulation.duration);
    for (std::size_t k = 0; k < std::min(count, recordings.features.size()); ++k) {
      const SingleRecording one =
          takeRecording(diagnosis.corrected, recordings, diagnosis.after.posterior.best, k);
      single_.emplace_back(diagnosis.corrected, one.recording, one.point);
      moved_.push_back(motion.simulate(k, fine_times_));
    }
    if (diagnosis.found > 0) {
      holdParameters();
    }
  }

  /// force: number of a term's force; none: beside the corrected model.
  UnknownForce estimate(std::size_t c, const std::optional<std::size_t>& number) const {
    const ForcedCoordinate& coordinate = motion_.getCoordinates()[c];
    const TermForce* term = number ? &motion_.getTermForces()[*number] : nullptr;
    const Dropped dropped = term == nullptr ? Dropped{} : dropTerm(diagnosis_.terms[term->term]);
    const auto estimateOver = [&](const ForceProblem& problem, const std::string& quantity,
                                  const VectorXd& knots, double scale) {
      const VectorXd effect = term == nullptr ? VectorXd::Zero(problem.getLinear().residual.size()).eval()
                                              : problem.calcEffect(coordinate, term->force);
      return problem.estimate(coordinate, quantity, knots, scale, dropped, effect);
    };
    UnknownForce force;
    force.coordinate = c;
    VectorXd positions, speeds;
    for (std::size_t k = 0; k < single_.size(); ++k) {
      const MovingCoordinate& moved = moved_[k].coordinates[c];
      const double periods = countPeriods(moved.speed);
      const double duration = fine_times_[fine_times_.size() - 1];
      const VectorXd times = VectorXd::LinSpaced(countKnots(periods, single_[k]), 0.0, duration);
      force.recordings.push_back({estimateOver(single_[k], "t", times, duration / periods),
                                  motion_.simulate(k, times).coordinates[c], fine_times_, moved,
                                  number ? moved_[k].forces[*number] : VectorXd()});
      positions = append(positions, moved.position);
      speeds = append(speeds, moved.speed);
    }
    force.over_position =
        estimateOver(together_, coordinate.name, spreadKnots(positions), calcRange(positions));
    force.over_speed =
        estimateOver(together_, coordinate.name + "_dot", spreadKnots(speeds), calcRange(speeds));
    return force;
  }

 private:
  void holdParameters() {
    const MatrixXd covariance = calcFitCovariance(together_.getLinear());
    together_.setCovariance(covariance);
    const auto p = static_cast<Index>(diagnosis_.corrected.model.parameters.size());
    const auto own = static_cast<Index>(diagnosis_.corrected.model.nuisance.size());
    for (std::size_t k = 0; k < single_.size(); ++k) {
      std::vector<Index> mine;
      for (Index i = 0; i < p + own; ++i) {
        mine.push_back(i < p ? i : i + static_cast<Index>(k) * own);
      }
      single_[k].setCovariance(covariance(mine, mine));
    }
  }

  static Dropped dropTerm(const FoundTerm& term) {
    return {term.first, 1 + static_cast<Index>(term.candidate.own_scales.size())};
  }

  static Index countKnots(double periods, const ForceProblem& problem) {
    const double most =
        kMostBytes / (sizeof(double) * static_cast<double>(problem.getLinear().residual.size()));
    return std::clamp(static_cast<Index>(std::min(kKnotsPerPeriod * periods, most)), kFewestKnots,
                      kMostKnots);
  }

  const Diagnosis& diagnosis_;
  const FitMotion& motion_;
  VectorXd fine_times_;
  ForceProblem together_;
  std::vector<ForceProblem> single_;  // each recording alone
  std::vector<RecordedMotion> moved_;
};

}  // namespace

double UnknownForce::calcEvidenceOverTime() const {
  double evidence = 0.0;
  for (const ForceOverTime& one : recordings) {
    evidence += one.force.log_evidence;
  }
  return evidence;
}

bool UnknownForce::mayBe(const ForceCurve& curve) const {
  return curve.log_evidence > std::max(0.0, calcEvidenceOverTime() - kTiedEvidence);
}

std::vector<UnknownForce> estimateUnknownForces(const Diagnosis& diagnosis,
                                                const RecordedFeatures& recordings, const FitMotion& motion,
                                                std::size_t count) {
  const ForceEstimator estimator(diagnosis, recordings, motion, count);
  std::vector<UnknownForce> forces;
  for (std::size_t c = 0; c < motion.getCoordinates().size(); ++c) {
    const std::size_t before = forces.size();
    for (std::size_t f = 0; f < motion.getTermForces().size(); ++f) {
      if (motion.getTermForces()[f].coordinate == c) {
        forces.push_back(estimator.estimate(c, f));
        forces.back().term = motion.getTermForces()[f].term;
      }
    }
    if (forces.size() == before || !diagnosis.after.isExplained()) {
      forces.push_back(estimator.estimate(c, std::nullopt));
    }
  }
  std::stable_partition(forces.begin(), forces.end(),
                        [](const UnknownForce& force) { return force.term.has_value(); });
  return forces;
}

}  // namespace twinmap
