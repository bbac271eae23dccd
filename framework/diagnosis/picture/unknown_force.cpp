#include "framework/diagnosis/picture/unknown_force.hpp"

#include <algorithm>
#include <cmath>

#include "framework/diagnosis/problem/score_test.hpp"
#include "framework/diagnosis/remainder/process_fit.hpp"
#include "framework/estimation/bounded_information.hpp"
#include "framework/estimation/refined/measured_misfit.hpp"
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

/// Correlation lengths, of a period or a range: the evidence changes little with them. Smoother processes
/// have as much of it, but bands that hold too little about a step.
constexpr double kLengthShares[] = {0.05, 0.2, 1.0};

/// Parameters, by their number, that are not there.
struct Dropped {
  Index first = 0, count = 0;

  std::vector<Index> listKept(Index all) const { return listOthers(all, first, count); }
};

/// Residuals and derivatives per half-width of a parameter.
LinearizedRecordings linearizeScaled(const RecordingsProblem& problem, const VectorXd& point) {
  LinearizedRecordings linear = problem.linearize(point);
  linear.jacobian *= (0.5 * calcWidths(problem.getUnknown())).asDiagonal();
  return linear;
}

/// What is known of the first parameters by their covariance, as further residuals.
void addKnowledge(const MatrixXd& covariance, FittedRecording& fitted) {
  LinearizedRecordings& linear = fitted.linear;
  const Index n = linear.residual.size(), known = covariance.rows();
  const MatrixXd information = linalg::invertPositiveDefinite(covariance);
  linear.residual.conservativeResize(n + known);
  linear.residual.tail(known).setZero();
  linear.jacobian.conservativeResize(n + known, Eigen::NoChange);
  linear.jacobian.bottomRows(known).setZero();
  linear.jacobian.bottomLeftCorner(known, known) = linalg::calcCholesky(information).lower.transpose();
  MatrixXd& responses = fitted.effects[0].responses;
  responses.conservativeResize(n + known, Eigen::NoChange);
  responses.bottomRows(known).setZero();
}

/// Of what a force is a function.
struct ForceArgument {
  std::string quantity;
  VectorXd knots;
  double scale = 1.0;  ///< of its correlation lengths
};

/// One or several recordings at the fit.
class LinearFit {
 public:
  LinearFit(const ExperimentSpec& experiment, const RecordedFeatures& recordings, const VectorXd& point)
      : experiment_(experiment),
        recordings_(recordings),
        point_(point),
        linear_(linearizeScaled(RecordingsProblem(experiment, recordings), point)) {}

  const LinearizedRecordings& getLinear() const { return linear_; }

  /// With a force on a coordinate; in the place of a term's, if there is one, whose parameters are dropped.
  FittedRecording addForce(const ForcedCoordinate& coordinate, const ForceArgument& argument,
                           const TermForce* term, const Dropped& dropped) const {
    FittedRecording fitted;
    fitted.linear.residual = linear_.residual;
    fitted.linear.jacobian = linear_.jacobian(Eigen::all, dropped.listKept(linear_.jacobian.cols()));
    fitted.half_widths = VectorXd::Ones(fitted.linear.jacobian.cols());  // linearizeScaled()
    if (term != nullptr) {
      fitted.linear.residual += calcForceEffect(experiment_, recordings_, point_, coordinate, term->force);
    }
    fitted.effects.push_back(
        calcForceEffect(experiment_, recordings_, point_, coordinate, argument.quantity, argument.knots));
    return fitted;
  }

 private:
  const ExperimentSpec& experiment_;
  RecordedFeatures recordings_;
  VectorXd point_;
  LinearizedRecordings linear_;
};

/// The force of each recording. shared: of their parameters, the first ones.
std::vector<ForceCurve> estimateForces(const std::vector<FittedRecording>& fitted, Index shared,
                                       const ForceArgument& argument) {
  const ProcessProblem problem{fitted, 0, shared};
  std::vector<double> lengths;
  for (const double share : kLengthShares) {
    lengths.push_back(share * argument.scale);
  }
  const BestProcess best = searchProcess(problem, lengths);
  const ProcessEstimate estimate = estimateProcess(problem, best);
  std::vector<ForceCurve> curves;
  for (std::size_t k = 0; k < fitted.size(); ++k) {
    curves.push_back({argument.knots, estimate.means[k], estimate.stddevs[k], std::sqrt(best.variance),
                      best.log_evidence});
  }
  return curves;
}

/// Half of the times at which a speed changes its sign; at least one.
double countPeriods(const VectorXd& speed) {
  int changes = 0;
  for (Index i = 1; i < speed.size(); ++i) {
    changes += speed[i] * speed[i - 1] < 0.0 ? 1 : 0;
  }
  return std::max(1.0, 0.5 * changes);
}

RecordedFeatures takeFirst(const RecordedFeatures& recordings, std::size_t count) {
  RecordedFeatures first = recordings;
  first.features.resize(std::min(count, first.features.size()));
  return first;
}

class ForceEstimator {
 public:
  ForceEstimator(const Diagnosis& diagnosis, const RecordedFeatures& recordings, const FitMotion& motion,
                 std::size_t count)
      : diagnosis_(diagnosis),
        motion_(motion),
        p_(static_cast<Index>(diagnosis.corrected.model.parameters.size())),
        experiment_(diagnosis.corrected) {
    experiment_.noise = diagnosis.noise;
    const ExperimentSpec& experiment = experiment_;
    const VectorXd& point = diagnosis.after.posterior.best;
    const MatrixXd jacobian = linearizeScaled(RecordingsProblem(experiment, recordings), point).jacobian;
    covariance_ = BoundedInformation(jacobian.transpose() * jacobian).calcCovariance();
    const RecordedFeatures drawn = takeFirst(recordings, count);
    const auto own = static_cast<Index>(experiment.model.nuisance.size() * drawn.features.size());
    together_.emplace(experiment, drawn, point.head(p_ + own));
    fine_times_ = VectorXd::LinSpaced(kMotionSamples, 0.0, experiment.model.simulation.duration);
    for (std::size_t k = 0; k < drawn.features.size(); ++k) {
      const SingleRecording one = takeRecording(experiment, recordings, point, k);
      single_.emplace_back(experiment, one.recording, one.point);
      moved_.push_back(motion.simulate(k, fine_times_));
    }
  }

  /// force: number of a term's force; none: beside the corrected model.
  UnknownForce estimate(std::size_t c, const std::optional<std::size_t>& number) const {
    UnknownForce force;
    force.coordinate = c;
    const TermForce* term = number ? &motion_.getTermForces()[*number] : nullptr;
    const ForceArgument over_time = makeTimeArgument(c);
    const std::vector<ForceCurve> curves = estimateOverTime(c, over_time, term);
    for (std::size_t k = 0; k < single_.size(); ++k) {
      force.recordings.push_back({curves[k], motion_.simulate(k, over_time.knots).coordinates[c], fine_times_,
                                  moved_[k].coordinates[c], number ? moved_[k].forces[*number] : VectorXd()});
    }
    const std::string& name = motion_.getCoordinates()[c].name;
    force.over_position = estimateTogether(c, makeRangeArgument(name, c, &MovingCoordinate::position), term);
    force.over_speed =
        estimateTogether(c, makeRangeArgument(name + "_dot", c, &MovingCoordinate::speed), term);
    return force;
  }

 private:
  /// A force along each recording.
  std::vector<ForceCurve> estimateOverTime(std::size_t c, const ForceArgument& argument,
                                           const TermForce* term) const {
    const Dropped dropped = dropTerm(term);
    std::vector<FittedRecording> fitted;
    for (const LinearFit& fit : single_) {
      fitted.push_back(fit.addForce(motion_.getCoordinates()[c], argument, term, dropped));
    }
    addKnowledgeOf(dropped, fitted.front());
    return estimateForces(fitted, p_ - dropped.count, argument);
  }

  /// The same force in all recordings.
  ForceCurve estimateTogether(std::size_t c, const ForceArgument& argument, const TermForce* term) const {
    const Dropped dropped = dropTerm(term);
    std::vector<FittedRecording> fitted{
        together_->addForce(motion_.getCoordinates()[c], argument, term, dropped)};
    addKnowledgeOf(dropped, fitted.front());
    return estimateForces(fitted, fitted.front().linear.jacobian.cols(), argument).front();
  }

  /// In the place of a term, what the fit with it says of the machine's parameters that are left.
  void addKnowledgeOf(const Dropped& dropped, FittedRecording& fitted) const {
    if (dropped.count > 0) {
      const std::vector<Index> kept = dropped.listKept(p_);
      addKnowledge(covariance_(kept, kept), fitted);
    }
  }

  Dropped dropTerm(const TermForce* term) const {
    if (term == nullptr) {
      return {};
    }
    const FoundTerm& found = diagnosis_.terms[term->term];
    return {found.first, found.candidate.countCoefficients()};
  }

  /// As fine as the fastest recording needs.
  ForceArgument makeTimeArgument(std::size_t c) const {
    double periods = 1.0;
    for (const RecordedMotion& moved : moved_) {
      periods = std::max(periods, countPeriods(moved.coordinates[c].speed));
    }
    const double most =
        static_cast<double>(kNumbersTogether) / static_cast<double>(together_->getLinear().residual.size());
    const Index knots =
        std::clamp(static_cast<Index>(std::min(kKnotsPerPeriod * periods, most)), kFewestKnots, kMostKnots);
    const double duration = fine_times_[fine_times_.size() - 1];
    return {"t", VectorXd::LinSpaced(knots, 0.0, duration), duration / periods};
  }

  ForceArgument makeRangeArgument(const std::string& quantity, std::size_t c,
                                  VectorXd MovingCoordinate::*values) const {
    double lower = kInfinity, upper = -kInfinity;
    for (const RecordedMotion& moved : moved_) {
      lower = std::min(lower, (moved.coordinates[c].*values).minCoeff());
      upper = std::max(upper, (moved.coordinates[c].*values).maxCoeff());
    }
    return {quantity, VectorXd::LinSpaced(kRangeKnots, lower, upper), upper - lower};
  }

  const Diagnosis& diagnosis_;
  const FitMotion& motion_;
  const Index p_;
  ExperimentSpec experiment_;
  MatrixXd covariance_;  // of all unknown parameters, in half-widths
  VectorXd fine_times_;
  std::optional<LinearFit> together_;
  std::vector<LinearFit> single_;  // each recording alone
  std::vector<RecordedMotion> moved_;
};

}  // namespace

bool UnknownForce::mayBe(const ForceCurve& curve) const {
  return curve.log_evidence > std::max(0.0, getEvidenceOverTime() - kTiedEvidence);
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
