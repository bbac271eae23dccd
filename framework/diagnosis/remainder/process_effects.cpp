#include "framework/diagnosis/remainder/process_effects.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/base/text/number_text.hpp"
#include "framework/diagnosis/candidates/augment.hpp"
#include "framework/diagnosis/candidates/term_candidates.hpp"
#include "framework/experiment/model/elements/force_elements.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Knots of a force, and those that are simulated together: a derivative along each.
constexpr Index kForceKnots = 40;
constexpr Index kOutputKnots = 160;

/// A force on a coordinate, by its expression.
TermCandidate makeForceCandidate(const std::string& coordinate, const std::string& force) {
  TermCandidate candidate;
  candidate.term = "process." + coordinate;
  candidate.add = [coordinate, force](ModelSpec& model, const std::string& coefficient,
                                      const std::vector<std::string>&) {
    ForceLaw<Expression> law;
    law.coordinate = {coordinate, {}};
    law.force = {fmt::format("{}*({})", coefficient, force), {}};
    model.system.elements.get<ForceLaw>().push_back(law);
  };
  return candidate;
}

/// The derivatives of all residuals along coefficients of forces that are not there.
MatrixXd calcDerivatives(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                         const VectorXd& point, const std::vector<TermCandidate>& forces) {
  const AugmentedExperiment all = addAll(experiment, forces);
  const auto p = static_cast<Index>(experiment.model.parameters.size());
  return RecordingsProblem(all.experiment, recordings)
      .linearize(insertAdded(point, p, VectorXd::Zero(all.added)))
      .jacobian.middleCols(p, all.added);
}

ProcessEffect calcOutputEffect(const std::vector<FeatureInfo>& infos, int output, const std::string& name,
                               double duration) {
  Index count = 0;
  for (const FeatureInfo& info : infos) {
    count += info.output == output ? 1 : 0;
  }
  const Index knots = std::clamp<Index>(count / 3, 2, kOutputKnots);
  ProcessEffect effect{"an error of output " + name, "noise sd", VectorXd::LinSpaced(knots, 0.0, duration),
                       MatrixXd::Zero(static_cast<Index>(infos.size()), knots)};
  const double interval = effect.knots[1];
  for (std::size_t i = 0; i < infos.size(); ++i) {
    if (infos[i].output == output) {
      const double at = std::clamp(infos[i].time / interval, 0.0, static_cast<double>(knots - 1));
      const auto before = std::min(static_cast<Index>(at), knots - 2);
      const double share = at - static_cast<double>(before);
      effect.responses(static_cast<Index>(i), before) = 1.0 - share;
      effect.responses(static_cast<Index>(i), before + 1) = share;
    }
  }
  return effect;
}

}  // namespace

ProcessEffect calcForceEffect(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                              const VectorXd& point, const ForcedCoordinate& coordinate,
                              const std::string& quantity, const VectorXd& knots) {
  ProcessEffect effect{"a force on " + coordinate.name, coordinate.getForceUnit(), knots, {}};
  const double interval = knots[1] - knots[0];
  for (Index first = 0; first < knots.size(); first += kForceKnots) {
    const Index count = std::min(kForceKnots, knots.size() - first);
    std::vector<TermCandidate> forces;
    for (Index k = first; k < first + count; ++k) {
      forces.push_back(makeForceCandidate(
          coordinate.name,
          fmt::format("max(0, 1 - abs({} - ({}))/{})", quantity, toText(knots[k]), toText(interval))));
    }
    const MatrixXd derivatives = calcDerivatives(experiment, recordings, point, forces);
    effect.responses.conservativeResize(derivatives.rows(), first + count);
    effect.responses.rightCols(count) = derivatives;
  }
  return effect;
}

VectorXd calcForceEffect(const ExperimentSpec& experiment, const RecordedFeatures& recordings,
                         const VectorXd& point, const ForcedCoordinate& coordinate, const Expression& force) {
  return calcDerivatives(experiment, recordings, point, {makeForceCandidate(coordinate.name, force.text)});
}

std::vector<ProcessEffect> listProcessEffects(const ExperimentSpec& experiment,
                                              const RecordedFeatures& recording, const VectorXd& point,
                                              const std::vector<FeatureInfo>& infos) {
  std::vector<ProcessEffect> effects;
  const double duration = experiment.model.simulation.duration;
  const VectorXd knots = VectorXd::LinSpaced(kForceKnots, 0.0, duration);
  for (const ForcedCoordinate& coordinate : listForcedCoordinates(experiment.model.system)) {
    effects.push_back(calcForceEffect(experiment, recording, point, coordinate, "t", knots));
  }
  const std::vector<OutputSpec>& outputs = experiment.model.outputs;
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    effects.push_back(calcOutputEffect(infos, static_cast<int>(o), outputs[o].name.text, duration));
  }
  return effects;
}

}  // namespace twinmap
