#include "framework/diagnosis/change_or_term.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "framework/diagnosis/best_term.hpp"
#include "framework/diagnosis/missing_term.hpp"
#include "framework/diagnosis/problem/sensor_faults.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "kernels/linalg/order.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// The residuals of the first recordings.
Index countResiduals(const RecordingsProblem& problem, std::size_t recordings) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < recordings; ++k) {
    count += problem.get().trials[k].model->getWhole().features.size();
  }
  return static_cast<Index>(count);
}

/// Each recording's own unknown parameters as it explains them alone, beside the machine's of one of them.
MatrixXd listStarts(const RecordingsProblem& problem, const ExperimentSpec& experiment,
                    const ChangeRecordings& recordings) {
  const auto p = static_cast<Index>(experiment.model.parameters.size());
  const std::size_t count = recordings.inferred.size();
  VectorXd base(static_cast<Index>(problem.getUnknown().size()));
  MatrixXd machines(p, static_cast<Index>(count));
  for (std::size_t k = 0; k < count; ++k) {
    const ExperimentSpec own = recordings.all.makeExperiment(experiment, k);
    const VectorXd point = findExplanation(recordings.inferred[k], collectUnknown(own.model));
    base(problem.get().trials[k].unknown) = point;
    machines.col(static_cast<Index>(k)) = point.head(p);
  }
  MatrixXd starts = base.replicate(1, machines.cols());
  starts.topRows(p) = machines;
  return starts;
}

/// With the faults of sensors that each recording shows alone.
RecordedFeatures takeSensors(const ChangeRecordings& recordings) {
  std::vector<RecordingInference> alone;
  for (const InferredMeasurement& one : recordings.inferred) {
    alone.push_back({"", one, {}});
  }
  RecordedFeatures taken = recordings.all;
  takeFaults(alone, {true, true, false}, taken);
  return taken;
}

/// One weighing on its way.
class Weighing {
 public:
  Weighing(const ExperimentSpec& experiment, const ChangeRecordings& recordings)
      : recordings_(takeSensors(recordings)),
        before_(recordings.before),
        sizes_(calcWidths(experiment.model.parameters)) {
    const RecordingsProblem problem(experiment, recordings_);
    current_ = fitFrom(experiment, recordings_, listStarts(problem, experiment, recordings));
    if (current_.point.size() == 0) {
      throw std::runtime_error("the recordings cannot be simulated");
    }
  }

  ChangeOrTerm run() {
    weighed_.change = weigh(current_);
    weighed_.rival = findRival(CandidateKinds::kWithoutStates);
    if (!weighed_.rival || !weighed_.rival->term.explains) {
      if (std::optional<ChangeRival> other = findRival(CandidateKinds::kAll)) {
        weighed_.rival = std::move(other);
      }
    }
    return weighed_;
  }

 private:
  ChangeEvidence weigh(const CurrentFit& fit) const {
    const RecordingsProblem problem(fit.experiment, recordings_);
    return weighChange(problem.linearize(fit.point), countResiduals(problem, before_), sizes_);
  }

  std::optional<ChangeRival> findRival(CandidateKinds kinds) {
    const Index p = sizes_.size();
    const ScoredCandidates scored =
        scoreCandidates(current_.experiment, recordings_, current_.point, {kinds});
    weighed_.tested = scored.tested;
    std::vector<RankedTerm> ranked = rankTerms(scored, current_, p);
    fitBest(current_, recordings_, scored, p, ranked);
    std::stable_sort(ranked.begin(), ranked.end(), hasMoreEvidence);
    for (const RankedTerm& one : ranked) {
      const std::optional<double> left = one.finding.fitted ? weighBeside(one) : std::nullopt;
      if (left) {
        ChangeRival rival{describeMissing(one, ranked, current_.chi_square), calcOverChange(one), *left};
        rival.term.explains = explains(current_, recordings_, one.fitted);
        return rival;
      }
    }
    return {};
  }

  /// The log evidence of a term over that of the change. Before the recordings some term is as likely missing
  /// as some parameter has changed, and each of them as likely as the others.
  double calcOverChange(const RankedTerm& term) const {
    const double parameters = static_cast<double>(sizes_.size()), terms = std::max(weighed_.tested, 1);
    return term.finding.log_evidence - weighed_.change.log_evidence - std::log(terms / parameters);
  }

  /// The evidence that is left of a change beside a term; none where that cannot be a rival.
  std::optional<double> weighBeside(const RankedTerm& term) const {
    constexpr double kLeft = 0.1;
    const double change = weighed_.change.log_evidence;
    if (!(term.finding.log_evidence > kTiedEvidence && calcOverChange(term) > 0.0)) {
      return {};
    }
    const double left = weigh(addFitted(current_, term)).log_evidence;
    return left > std::max(kTiedEvidence, kLeft * change) ? std::nullopt : std::make_optional(left);
  }

  const RecordedFeatures recordings_;
  const std::size_t before_;
  const VectorXd sizes_;
  CurrentFit current_;
  ChangeOrTerm weighed_;
};

}  // namespace

ChangeEvidence weighChange(const LinearizedRecordings& linear, Index after, const VectorXd& sizes) {
  const Index n = linear.residual.size();
  MatrixXd given = linear.jacobian;
  std::vector<Index> left = listIndices(sizes.size());
  ChangeEvidence all;
  while (!left.empty()) {
    MatrixXd changes = linear.jacobian(Eigen::all, left);
    changes.topRows(after).setZero();
    const ScoreTest test(linear.residual, given, changes);
    double most = 0.0;
    Index best = -1;
    for (Index i = 0; i < changes.cols(); ++i) {
      const double size = sizes[left[static_cast<std::size_t>(i)]];
      const TermScore score = test.calcScore(i, size);
      const double evidence = calcLogEvidence(score.z * score.z, {score.estimate, score.stddev, size});
      if (score.visible && evidence > most) {
        most = evidence;
        best = i;
      }
    }
    if (best < 0) {
      break;
    }
    given.conservativeResize(n, given.cols() + 1);
    given.rightCols(1) = changes.col(best);
    all.log_evidence += most;
    all.parameters.push_back(static_cast<std::size_t>(left[static_cast<std::size_t>(best)]));
    left.erase(left.begin() + best);
  }
  return all;
}

ChangeOrTerm weighChangeOrTerm(const ExperimentSpec& experiment, const ChangeRecordings& recordings) {
  requireSystem(experiment);
  return Weighing(experiment, recordings).run();
}

}  // namespace twinmap
