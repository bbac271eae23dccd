#include "framework/diagnosis/remainder/process_effects.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/base/text/number_text.hpp"
#include "framework/diagnosis/augment.hpp"
#include "framework/diagnosis/candidates/term_candidates.hpp"
#include "framework/experiment/model/joint_type.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Knots of a force: a simulation with derivatives along each.
constexpr int kForceKnots = 40;
constexpr Index kOutputKnots = 160;

/// A force on a coordinate that is 1 at a knot and 0 at its neighbours.
TermCandidate makeKnotForce(const std::string& coordinate, double at, double interval, int number) {
  TermCandidate candidate;
  candidate.term = fmt::format("knot{}.{}", number, coordinate);
  candidate.size = 1.0;
  candidate.add = [coordinate, at, interval](ModelSpec& model, const std::string& coefficient,
                                             const std::vector<std::string>&) {
    ForceLaw<Expression> law;
    law.coordinate = {coordinate, {}};
    law.force = {fmt::format("{}*max(0, 1 - abs(t - {})/{})", coefficient, toText(at), toText(interval)), {}};
    model.system.elements.get<ForceLaw>().push_back(law);
  };
  return candidate;
}

ProcessEffect calcForceEffect(const ExperimentSpec& experiment, const RecordedFeatures& recording,
                              const VectorXd& point, const std::string& coordinate, bool is_angle) {
  const double duration = experiment.model.simulation.duration;
  ProcessEffect effect{"a force on " + coordinate,
                       is_angle ? "N m" : "N",
                       VectorXd::LinSpaced(kForceKnots, 0.0, duration),
                       {}};
  std::vector<TermCandidate> knots;
  for (int k = 0; k < kForceKnots; ++k) {
    knots.push_back(makeKnotForce(coordinate, effect.knots[k], effect.knots[1], k));
  }
  const AugmentedExperiment all = addAll(experiment, knots);
  const auto p = static_cast<Index>(experiment.model.parameters.size());
  effect.responses = RecordingsProblem(all.experiment, recording)
                         .linearize(insertAdded(point, p, VectorXd::Zero(all.added)))
                         .jacobian.middleCols(p, all.added);
  return effect;
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

std::vector<ProcessEffect> listProcessEffects(const ExperimentSpec& experiment,
                                              const RecordedFeatures& recording, const VectorXd& point,
                                              const std::vector<FeatureInfo>& infos) {
  std::vector<ProcessEffect> effects;
  for (const BodySpec& body : experiment.model.system.bodies) {
    const JointCoordinates& joint = getJointCoordinates(body.joint.type);
    for (std::size_t i = 0; i < joint.size(); ++i) {
      if (joint[i].takes_forces) {
        effects.push_back(calcForceEffect(experiment, recording, point, body.joint.coordinates[i].text,
                                          joint[i].kind == CoordinateKind::kRotation));
      }
    }
  }
  const std::vector<OutputSpec>& outputs = experiment.model.outputs;
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    effects.push_back(calcOutputEffect(infos, static_cast<int>(o), outputs[o].name.text,
                                       experiment.model.simulation.duration));
  }
  return effects;
}

}  // namespace twinmap
