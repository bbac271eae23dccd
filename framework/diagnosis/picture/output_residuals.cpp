#include "framework/diagnosis/picture/output_residuals.hpp"

#include <algorithm>

#include "framework/estimation/levels.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Residuals of one output of one recording whose times rise.
struct Sequence {
  int output = -1;  ///< counted on over the recordings
  std::vector<Index> places;
};

std::vector<Sequence> listSequences(const std::vector<FeatureInfo>& infos) {
  std::vector<Sequence> sequences;
  for (std::size_t i = 0; i < infos.size(); ++i) {
    const bool goes_on = !sequences.empty() && sequences.back().output == infos[i].output &&
                         infos[i].time > infos[static_cast<std::size_t>(sequences.back().places.back())].time;
    if (!goes_on) {
      sequences.push_back({infos[i].output, {}});
    }
    sequences.back().places.push_back(static_cast<Index>(i));
  }
  sequences.erase(
      std::remove_if(sequences.begin(), sequences.end(),
                     [](const Sequence& one) { return one.output < 0 || one.places.size() < kFewestTested; }),
      sequences.end());
  return sequences;
}

VectorXd interpolate(const VectorXd& times, const VectorXd& values, const VectorXd& at) {
  VectorXd found(at.size());
  for (Index i = 0; i < at.size(); ++i) {
    const auto next = std::upper_bound(times.begin() + 1, times.end() - 1, at[i]);
    const Index k = next - times.begin();
    const double share = (at[i] - times[k - 1]) / (times[k] - times[k - 1]);
    found[i] = values[k - 1] + share * (values[k] - values[k - 1]);
  }
  return found;
}

bool hasFewTimes(const RecordedFeatures& recordings) {
  for (std::size_t k = 0; k < recordings.features.size(); ++k) {
    if (recordings.getLayout(k).times.size() < 2) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<OutputResidual> listOutputResiduals(const Diagnosis& diagnosis, const ExperimentSpec& experiment,
                                                const RecordedFeatures& recordings, const FitMotion& motion,
                                                std::size_t count) {
  const VectorXd &before = diagnosis.before.posterior.residual, &after = diagnosis.after.posterior.residual;
  const std::vector<FeatureInfo> infos = RecordingsProblem(experiment, recordings).listInfos();
  const std::size_t outputs = recordings.layout.output_names.size();
  std::vector<RecordedMotion> moved;
  std::vector<OutputResidual> residuals;
  if (before.size() != static_cast<Index>(infos.size()) || after.size() != before.size() ||
      hasFewTimes(recordings)) {
    return residuals;  // noise of fewer dimensions than features: no residual belongs to one sample
  }
  for (std::size_t k = 0; k < std::min(count, recordings.features.size()); ++k) {
    moved.push_back(motion.simulate(k, recordings.getLayout(k).times));
  }
  for (const Sequence& sequence : listSequences(infos)) {
    OutputResidual one{static_cast<std::size_t>(sequence.output) % outputs,
                       static_cast<std::size_t>(sequence.output) / outputs,
                       {},
                       {},
                       {},
                       {},
                       {}};
    if (one.recording >= moved.size()) {
      continue;
    }
    const auto n = static_cast<Index>(sequence.places.size());
    one.times = VectorXd::NullaryExpr(n, [&](Index i) {
      return infos[static_cast<std::size_t>(sequence.places[static_cast<std::size_t>(i)])].time;
    });
    one.before = before(sequence.places);
    one.after = diagnosis.found > 0 ? VectorXd(after(sequence.places)) : VectorXd();
    const std::vector<MovingCoordinate>& own = moved[one.recording].coordinates;
    const VectorXd& times = recordings.getLayout(one.recording).times;
    one.positions.resize(n, static_cast<Index>(own.size()));
    one.speeds.resize(n, static_cast<Index>(own.size()));
    for (std::size_t c = 0; c < own.size(); ++c) {
      one.positions.col(static_cast<Index>(c)) = interpolate(times, own[c].position, one.times);
      one.speeds.col(static_cast<Index>(c)) = interpolate(times, own[c].speed, one.times);
    }
    residuals.push_back(std::move(one));
  }
  return residuals;
}

}  // namespace twinmap
