#include "framework/inference/clock/clocked_fit.hpp"

#include <algorithm>

#include "framework/estimation/levels.hpp"
#include "framework/experiment/model/parameter_box.hpp"
#include "framework/inference/clock/clocked_simulator.hpp"
#include "framework/simulation/team_simulator.hpp"
#include "kernels/linalg/decompositions.hpp"

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

/// A point with its linear model, in half-widths.
struct Linearized {
  LocalMisfit local;
  VectorXd half_widths;
  std::vector<FeatureInfo> infos;
};

Linearized linearize(const RecordedSamples& recorded, const VectorXd& point,
                     const std::vector<ClockFault>& faults) {
  const auto simulator = makeClockedSimulator(recorded, faults, makeHalfWidths(recorded, faults));
  const VectorXd features = takeWithin(recorded, faults);
  const MeasuredTrial trial = simulator->makeTrial(features, recorded.known);
  TrialMisfit own(trial);
  VectorXd at(point.size() + static_cast<Index>(faults.size()));
  at.head(point.size()) = point;
  for (std::size_t k = 0; k < faults.size(); ++k) {
    at[point.size() + static_cast<Index>(k)] = faults[k].size;
  }
  Linearized made{own.linearize(at), own.box.getHalfWidths(), {}};
  const std::vector<FeatureInfo>& infos = trial.model->getExtractor().getInfos();
  for (const Index i : trial.model->getWhole().features) {
    made.infos.push_back(infos[static_cast<std::size_t>(i)]);
  }
  return made;
}

ClockedFit toFit(const Linearized& at, const VectorXd& point, const std::vector<ClockFault>& faults) {
  ClockedFit fit{point, faults, at.local.residual, at.local.jacobian, at.local.misfit, at.infos};
  for (Index k = point.size(); k < fit.jacobian.cols(); ++k) {
    fit.jacobian.col(k) /= at.half_widths[k];
  }
  return fit;
}

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
  const Linearized at = linearize(recorded, point, faults);
  return at.local.status.ok ? toFit(at, point, faults) : ClockedFit{};
}

ClockedFit fitClock(const RecordedSamples& recorded, const VectorXd& point,
                    const std::vector<ClockFault>& faults) {
  ClockedFit fit{point, faults, {}, {}, 0.0, {}};
  Linearized at = linearize(recorded, point, faults);
  if (!at.local.status.ok) {
    return {};
  }
  for (int step = 0; step < kFewIterations; ++step) {
    const Eigen::MatrixXd lower = linalg::calcCholesky(at.local.calcHessian()).lower;
    const VectorXd way = linalg::solveCholesky(lower, at.local.descent).cwiseProduct(at.half_widths);
    const double before = at.local.misfit;
    if (!way.allFinite()) {
      return {};  // of a misfit beyond numbers
    }
    double share = 1.0;
    for (int halving = 0; halving < kFewIterations; ++halving, share *= 0.5) {
      ClockedFit next = fit;
      next.point += share * way.head(point.size());
      const std::vector<ParameterSpec> unknown = collectUnknown(recorded.experiment.model);
      for (Index i = 0; i < point.size(); ++i) {
        const Bounds& bounds = unknown[static_cast<std::size_t>(i)].bounds;
        next.point[i] = std::clamp(next.point[i], bounds.lower, bounds.upper);
      }
      for (std::size_t k = 0; k < faults.size(); ++k) {
        next.faults[k].size += share * way[point.size() + static_cast<Index>(k)];
      }
      Linearized there = linearize(recorded, next.point, next.faults);
      if (there.local.status.ok && there.local.misfit < at.local.misfit) {
        fit = std::move(next);
        at = std::move(there);
        break;
      }
    }
    const bool is_gross =
        recorded.noise.outputs.empty() && isGross(at.local.misfit, static_cast<double>(at.local.residuals));
    if (before - at.local.misfit <= (is_gross ? kCreeping * before : kLastGain)) {
      break;
    }
  }
  return toFit(at, fit.point, fit.faults);
}

}  // namespace twinmap
