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
ClockedSimulator::Times makeTimes(const RecordedSamples& recorded, const std::vector<NuisanceSize>& faults) {
  constexpr double kReach = 0.25;  // of a mean step: near enough for a parabola where samples are
  const VectorXd& stamps = recorded.layout.times;
  const auto steps = static_cast<double>(std::max<Index>(1, stamps.size() - 1));
  return {stamps, faults, kReach * (stamps[stamps.size() - 1] - stamps[0]) / steps,
          recorded.experiment.model.simulation.duration};
}

/// About what a step of least squares may change: an eighth of the recording's length, and what makes as much
/// of it at the end.
VectorXd makeHalfWidths(const RecordedSamples& recorded, const std::vector<NuisanceSize>& faults) {
  constexpr double kMost = 0.125;
  const double last = recorded.layout.times[recorded.layout.times.size() - 1];
  return VectorXd::NullaryExpr(static_cast<Index>(faults.size()), [&](Index k) {
    return isRate(faults[static_cast<std::size_t>(k)]) ? kMost : kMost * last;
  });
}

/// A point with its linear model, also in half-widths.
struct Linearized {
  ClockedFit fit;
  LocalMisfit local;
  VectorXd half_widths;
};

Linearized linearize(const RecordedSamples& recorded, const VectorXd& point,
                     const std::vector<NuisanceSize>& faults) {
  const auto simulator = makeClockedSimulator(recorded, faults, makeHalfWidths(recorded, faults));
  const VectorXd features = takeWithin(recorded, faults);
  const MeasuredTrial trial = simulator->makeTrial(features, recorded.known);
  TrialMisfit own(trial);
  LocalMisfit local = own.linearize(appendSizes(point, faults));
  const VectorXd half_widths = own.box.getHalfWidths();
  ClockedFit fit{point, faults, local.residual, local.jacobian, local.misfit, {}};
  for (Index k = point.size(); k < fit.jacobian.cols(); ++k) {
    fit.jacobian.col(k) /= half_widths[k];
  }
  const std::vector<FeatureInfo>& infos = trial.model->getExtractor().getInfos();
  for (const Index i : trial.model->getWhole().features) {
    fit.infos.push_back(infos[static_cast<std::size_t>(i)]);
  }
  return {std::move(fit), std::move(local), half_widths};
}

/// A step's share from a point on, within the bounds of the model's parameters.
Linearized step(const RecordedSamples& recorded, const Linearized& from, const VectorXd& way) {
  const Index u = from.fit.point.size();
  VectorXd point = from.fit.point + way.head(u);
  const std::vector<ParameterSpec> unknown = collectUnknown(recorded.experiment.model);
  for (Index i = 0; i < u; ++i) {
    const Bounds& bounds = unknown[static_cast<std::size_t>(i)].bounds;
    point[i] = std::clamp(point[i], bounds.lower, bounds.upper);
  }
  std::vector<NuisanceSize> faults = from.fit.faults;
  for (std::size_t k = 0; k < faults.size(); ++k) {
    faults[k].value += way[u + static_cast<Index>(k)];
  }
  return linearize(recorded, point, faults);
}

}  // namespace

double ClockedFit::calcDegrees() const {
  return std::max(1.0, static_cast<double>(residual.size() - jacobian.cols()));
}

std::shared_ptr<const SimulatorRefiner> makeClockedSimulator(const RecordedSamples& recorded,
                                                             const std::vector<NuisanceSize>& faults,
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
    size.bounds = {faults[k].value - half, faults[k].value + half, {}};
    experiment.model.nuisance.push_back(std::move(size));
  }
  return std::make_shared<const SimulatorRefiner>(experiment, recorded.layout, std::move(simulator));
}

VectorXd appendSizes(const VectorXd& point, const std::vector<NuisanceSize>& faults) {
  VectorXd all(point.size() + static_cast<Index>(faults.size()));
  all.head(point.size()) = point;
  for (std::size_t k = 0; k < faults.size(); ++k) {
    all[point.size() + static_cast<Index>(k)] = faults[k].value;
  }
  return all;
}

VectorXd takeWithin(const RecordedSamples& recorded, const std::vector<NuisanceSize>& faults) {
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
                            const std::vector<NuisanceSize>& faults) {
  const Linearized at = linearize(recorded, point, faults);
  return at.local.status.ok ? at.fit : ClockedFit{};
}

ClockedFit fitClock(const RecordedSamples& recorded, const VectorXd& point,
                    const std::vector<NuisanceSize>& faults) {
  Linearized at = linearize(recorded, point, faults);
  if (!at.local.status.ok) {
    return {};
  }
  for (int iteration = 0; iteration < kFewIterations; ++iteration) {
    const Eigen::MatrixXd lower = linalg::calcCholesky(at.local.calcHessian()).lower;
    const VectorXd way = linalg::solveCholesky(lower, at.local.descent).cwiseProduct(at.half_widths);
    const double before = at.local.misfit;
    if (!way.allFinite()) {
      return {};  // of a misfit beyond numbers
    }
    double share = 1.0;
    for (int halving = 0; halving < kFewIterations; ++halving, share *= 0.5) {
      Linearized there = step(recorded, at, share * way);
      if (there.local.status.ok && there.local.misfit < at.local.misfit) {
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
  return at.fit;
}

}  // namespace twinmap
