#include "framework/inference/clock/clocked_fit.hpp"

#include <algorithm>
#include <limits>

#include "framework/estimation/levels.hpp"
#include "framework/estimation/refined/search.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/clock/clocked_simulator.hpp"
#include "framework/simulation/team_simulator.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// How the stamps of a recording lead to true times.
ClockedSimulator::Times makeTimes(const RecordedSamples& recorded, const std::vector<ClockFault>& faults) {
  constexpr double kReach = 0.25;  // of a mean step: near enough for a parabola where samples are
  const VectorXd& stamps = recorded.layout.times;
  const auto steps = static_cast<double>(std::max<Index>(1, stamps.size() - 1));
  return {stamps, faults, kReach * (stamps[stamps.size() - 1] - stamps[0]) / steps,
          recorded.experiment.model.simulation.duration};
}

/// About what a step of least squares may change: an eighth of the recording's length, and what makes as much
/// of it at the end.
VectorXd makeHalfWidths(const RecordedSamples& recorded, const std::vector<ClockFault>& faults) {
  constexpr double kMost = 0.125;
  const double last = recorded.layout.times[recorded.layout.times.size() - 1];
  return VectorXd::NullaryExpr(static_cast<Index>(faults.size()), [&](Index k) {
    return faults[static_cast<std::size_t>(k)].kind == ClockFaultKind::kRate ? kMost : kMost * last;
  });
}

/// The misfit of the recording about a fit, whose clock's faults are unknown too.
class ClockedMisfit {
 public:
  ClockedMisfit(const RecordedSamples& recorded, const VectorXd& point, const std::vector<ClockFault>& faults)
      : simulator_(makeClockedSimulator(recorded, faults, makeHalfWidths(recorded, faults))),
        trial_(simulator_->makeTrial(takeWithin(recorded, faults), recorded.known)),
        own_(trial_),
        fit_{point, faults, {}, {}, 0.0, {}} {}

  SearchEnd search(int max_iterations) {
    VectorXd at(fit_.point.size() + static_cast<Index>(fit_.faults.size()));
    at.head(fit_.point.size()) = fit_.point;
    for (std::size_t k = 0; k < fit_.faults.size(); ++k) {
      at[fit_.point.size() + static_cast<Index>(k)] = fit_.faults[k].size;
    }
    return twinmap::search(own_.misfit, own_.box.normalize(at), max_iterations);
  }

  /// Where a search ended; not given of one that could not begin.
  ClockedFit describe(const LocalMisfit& local) const {
    if (!local.status.ok) {
      return {};
    }
    ClockedFit fit = fit_;
    const VectorXd all = own_.box.makePoint(local.at);
    fit.point = all.head(fit.point.size());
    for (std::size_t k = 0; k < fit.faults.size(); ++k) {
      fit.faults[k].size = all[fit.point.size() + static_cast<Index>(k)];
    }
    fit.residual = local.residual;
    fit.jacobian = local.jacobian;
    for (Index k = fit.point.size(); k < fit.jacobian.cols(); ++k) {
      fit.jacobian.col(k) /= own_.box.getHalfWidths()[k];
    }
    fit.misfit = local.misfit;
    const std::vector<FeatureInfo>& infos = trial_.model->getExtractor().getInfos();
    for (const Index i : trial_.model->getWhole().features) {
      fit.infos.push_back(infos[static_cast<std::size_t>(i)]);
    }
    return fit;
  }

 private:
  std::shared_ptr<const SimulatorRefiner> simulator_;
  MeasuredTrial trial_;
  TrialMisfit own_;
  ClockedFit fit_;
};

}  // namespace

double ClockedFit::calcDegrees() const {
  return std::max(1.0, static_cast<double>(residual.size() - jacobian.cols()));
}

std::shared_ptr<const SimulatorRefiner> makeClockedSimulator(const RecordedSamples& recorded,
                                                             const std::vector<ClockFault>& faults,
                                                             const VectorXd& half_widths) {
  const ModelSpec& model = recorded.experiment.model;
  const ClockedSimulator::Times times = makeTimes(recorded, faults);
  auto simulator = std::make_unique<ClockedSimulator>(
      shareAmongThreads(makeTrustedSimulator(model, times.listAll())), times,
      static_cast<Index>(model.parameters.size() + model.nuisance.size()));
  ExperimentSpec experiment = recorded.experiment;
  for (std::size_t k = 0; k < faults.size(); ++k) {
    ParameterSpec size;
    size.name.text = "clock." + std::to_string(k + 1);
    const double half = half_widths[static_cast<Index>(k)];
    size.bounds = {faults[k].size - half, faults[k].size + half, {}};
    experiment.model.nuisance.push_back(std::move(size));
  }
  return std::make_shared<const SimulatorRefiner>(experiment, recorded.layout, std::move(simulator));
}

VectorXd takeWithin(const RecordedSamples& recorded, const std::vector<ClockFault>& faults) {
  const ClockedSimulator::Times times = makeTimes(recorded, faults);
  const FeatureExtractor extractor(recorded.experiment.features, recorded.layout);
  VectorXd features = recorded.features;
  for (Index i = 0; i < features.size(); ++i) {
    if (!times.isWithin(extractor.getInfos()[static_cast<std::size_t>(i)].time)) {
      features[i] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return features;
}

ClockedFit linearizeClocked(const RecordedSamples& recorded, const VectorXd& point,
                            const std::vector<ClockFault>& faults) {
  ClockedMisfit misfit(recorded, point, faults);
  return misfit.describe(misfit.search(0).local);
}

ClockedFit fitClock(const RecordedSamples& recorded, const VectorXd& point,
                    const std::vector<ClockFault>& faults) {
  ClockedFit fit{point, faults, {}, {}, std::numeric_limits<double>::infinity(), {}};
  for (int round = 0; round < kFewIterations; ++round) {
    ClockedMisfit misfit(recorded, fit.point, fit.faults);
    const LocalMisfit local = misfit.search(kFewIterations).local;
    const double before = fit.misfit;
    fit = misfit.describe(local);
    const bool is_gross =
        recorded.noise.outputs.empty() && isGross(fit.misfit, static_cast<double>(local.residuals));
    if (!fit.isGiven() || !(before - fit.misfit > (is_gross ? kCreeping * before : kLastGain))) {
      break;
    }
  }
  return fit;
}

}  // namespace twinmap
