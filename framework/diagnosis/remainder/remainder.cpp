#include "framework/diagnosis/remainder/remainder.hpp"

#include <algorithm>
#include <cmath>

#include "framework/diagnosis/problem/score_test.hpp"
#include "framework/diagnosis/remainder/process_fit.hpp"
#include "framework/estimation/bounded_information.hpp"
#include "framework/estimation/levels.hpp"
#include "framework/experiment/model/parameter_box.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// The machine's parameters by each recording alone, around the common fit.
void widenByScatter(const std::vector<FittedRecording>& recordings, const VectorXd& point, Index p,
                    Remainder& remainder) {
  constexpr std::size_t kFewest = 3;  // of two the scatter is not known
  if (recordings.size() < kFewest) {
    return;
  }
  const auto n = static_cast<Index>(recordings.size());
  MatrixXd estimates(p, n), stddevs(p, n);
  for (Index k = 0; k < n; ++k) {
    const FittedRecording& recording = recordings[static_cast<std::size_t>(k)];
    const LinearizedRecordings& linear = recording.linear;
    const VectorXd& scale = recording.half_widths;
    const BoundedInformation information(linear.jacobian, scale);
    const VectorXd step =
        scale.asDiagonal() *
        information.solve(scale.asDiagonal() * (linear.jacobian.transpose() * linear.residual));
    estimates.col(k) = point.head(p) + step.head(p);
    stddevs.col(k) = scale.cwiseProduct(information.calcCovariance().diagonal().cwiseSqrt()).head(p);
  }
  for (Index i = 0; i < p; ++i) {
    const RandomEffects effects = calcRandomEffects(estimates.row(i), stddevs.row(i));
    remainder.stddevs[i] = std::max(remainder.stddevs[i], effects.stddev);
  }
}

/// The same effects in the same order for all: of an output that a trial does not have, one that does
/// nothing.
void alignEffects(std::vector<FittedRecording>& recordings) {
  std::vector<ProcessEffect> all;
  const auto find = [](std::vector<ProcessEffect>& effects, const std::string& what) {
    return std::find_if(effects.begin(), effects.end(),
                        [&](const ProcessEffect& one) { return one.what == what; });
  };
  for (const FittedRecording& recording : recordings) {
    for (const ProcessEffect& effect : recording.effects) {
      if (find(all, effect.what) == all.end()) {
        all.push_back(effect);
      }
    }
  }
  for (FittedRecording& recording : recordings) {
    std::vector<ProcessEffect> aligned = all;
    for (ProcessEffect& effect : aligned) {
      const auto own = find(recording.effects, effect.what);
      if (own != recording.effects.end()) {
        effect = *own;
      } else {
        effect.responses = MatrixXd::Zero(recording.linear.residual.size(), effect.knots.size());
      }
    }
    recording.effects = std::move(aligned);
  }
}

std::vector<FittedRecording> fitRecordings(const ExperimentSpec& experiment,
                                           const RecordedFeatures& recordings, const VectorXd& point) {
  std::vector<FittedRecording> fitted;
  for (std::size_t k = 0; k < recordings.features.size(); ++k) {
    const SingleRecording one = takeRecording(experiment, recordings, point, k);
    const RecordingsProblem problem(one.experiment, one.recording);
    fitted.push_back({problem.linearize(one.point),
                      listProcessEffects(one.experiment, one.recording, one.point, problem.listInfos()),
                      0.5 * calcWidths(problem.getUnknown())});
  }
  alignEffects(fitted);
  return fitted;
}

/// The best of each effect.
std::vector<BestProcess> searchProcesses(const std::vector<FittedRecording>& recordings, Index shared,
                                         double duration) {
  std::vector<BestProcess> processes;
  for (std::size_t e = 0; e < recordings.front().effects.size(); ++e) {
    // few correlation times: the evidence changes little with them
    processes.push_back(
        searchProcess({recordings, e, shared}, {0.02 * duration, 0.06 * duration, 0.2 * duration}));
  }
  return processes;
}

/// Means (from the fit) and standard deviations over all processes, by evidence; names those that are tied
/// with the best one.
void averageProcesses(const std::vector<FittedRecording>& recordings, Index shared,
                      const std::vector<BestProcess>& processes, Index p, Remainder& remainder) {
  double sum = 0.0;
  VectorXd mean = VectorXd::Zero(p), square = VectorXd::Zero(p);
  for (std::size_t e = 0; e < processes.size(); ++e) {
    const double less = remainder.log_evidence - processes[e].log_evidence;
    if (!(2.0 * less < kBasinAbove)) {
      continue;
    }
    const ProcessEstimate estimate = estimateProcess({recordings, e, shared}, processes[e]);
    const VectorXd step = estimate.step.head(p);
    const double weight = std::exp(-less);
    sum += weight;
    mean += weight * step;
    square += weight * (step.cwiseAbs2() + estimate.covariance.diagonal().head(p));
    const std::string& what = recordings.front().effects[e].what;
    if (less < kTiedEvidence && what != remainder.what) {
      remainder.rivals.push_back(what);
    }
  }
  remainder.mean = mean / sum;
  remainder.stddevs = (square / sum - remainder.mean.cwiseAbs2()).cwiseSqrt();
}

}  // namespace

std::optional<Remainder> findRemainder(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                                       const VectorXd& point, Index p) {
  const std::vector<FittedRecording> fitted = fitRecordings(experiment, recordings, point);
  const auto all = static_cast<Index>(experiment.model.parameters.size());
  const std::vector<BestProcess> processes =
      searchProcesses(fitted, all, experiment.model.simulation.duration);
  const auto best = std::max_element(
      processes.begin(), processes.end(),
      [](const BestProcess& a, const BestProcess& b) { return a.log_evidence < b.log_evidence; });
  if (best == processes.end() || !(best->log_evidence > 0.0)) {
    return {};
  }
  const auto chosen = static_cast<std::size_t>(best - processes.begin());
  const ProcessEffect& effect = fitted.front().effects[chosen];
  Remainder remainder{effect.what,       {}, effect.unit, std::sqrt(best->variance), best->correlation_length,
                      best->log_evidence};
  remainder.times = effect.knots;
  remainder.process = estimateProcess({fitted, chosen, all}, *best).means.front();
  averageProcesses(fitted, all, processes, p, remainder);
  remainder.mean += point.head(p);
  widenByScatter(fitted, point, p, remainder);
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
