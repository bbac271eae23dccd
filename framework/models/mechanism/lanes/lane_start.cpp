#include "framework/models/mechanism/lanes/lane_start.hpp"

#include "framework/experiment/model/parameter_box.hpp"
#include "framework/models/mechanism/equilibrium.hpp"

namespace twinmap {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Parameters = Eigen::Ref<const VectorXd>;

LaneStart::LaneStart(const ModelSpec& spec, const LaneModel& model, const VectorXd& box_center)
    : spec_(spec), model_(model), box_center_(box_center), start_(model.start), rest_(model) {
  if (model.loops) {
    assembly_.emplace(*model.loops);
  }
}

void LaneStart::fill(const Parameters& parameters, lanes::Sample& sample) {
  // the values, then their derivatives with respect to each parameter
  const MatrixXd all =
      start_.calc({parameters})
          .reshaped(model_.start.outputs.size() / (1 + model_.directions), 1 + model_.directions);
  sample.parameters.assign(parameters.begin(), parameters.end());
  sample.end = spec_.simulation.duration;
  fillInitial(parameters, all.topRows(model_.counts.states), sample);
  fillPhases(all.bottomRows(all.rows() - model_.counts.states), sample);
}

void LaneStart::fillInitial(const Parameters& parameters, MatrixXd states, lanes::Sample& sample) {
  const VectorXd none = VectorXd::Zero(model_.coordinate_count);
  if (box_center_.size() > 0) {
    states.setZero();
    states.col(0) = insertSpeeds(box_center_, none);
    assemble(parameters, states);
  } else if (spec_.initial.equilibrium) {
    rest_.setParameters(parameters);
    assemble(parameters, states);
    const MatrixXd start = takeEquilibrium(states);
    const VectorXd equilibrium = twinmap::solveEquilibrium(rest_, start.col(0));
    if (model_.directions > 0) {
      const MatrixXd slopes = rest_.calcSlopes(equilibrium, start.rightCols(model_.directions));
      for (int k = 0; k < model_.directions; ++k) {
        states.col(1 + k) = insertSpeeds(slopes.col(k), none);
      }
    }
    states.col(0) = insertSpeeds(equilibrium, none);
    if (assembly_) {
      assembly_->requireClosed(parameters, equilibrium.head(model_.coordinate_count));
    }
  } else {
    assemble(parameters, states);
  }
  sample.initial.assign(states.data(), states.data() + states.size());
}

void LaneStart::assemble(const Parameters& parameters, MatrixXd& states) {
  if (assembly_) {
    assembly_->assemble(parameters, states);
  }
}

MatrixXd LaneStart::takeEquilibrium(const MatrixXd& states) const {
  const Index n = model_.coordinate_count, m = model_.getFirstOrderCount();
  MatrixXd rows(n + m, states.cols());
  rows << states.topRows(n), states.bottomRows(m);
  return rows;
}

void LaneStart::fillPhases(const MatrixXd& events, lanes::Sample& sample) const {
  const RecordedExcitation& excitation = model_.excitation;
  const std::vector<double> times(events.col(0).begin(), events.col(0).end());
  const std::vector<Boundary> boundaries = calcBoundaries(excitation, times, spec_.simulation.duration);
  sample.phases.clear();
  for (std::size_t i = 0; i + 1 < boundaries.size(); ++i) {
    sample.phases.push_back({boundaries[i].time, std::vector<double>(excitation.input_count), {}});
    lanes::Phase& phase = sample.phases.back();
    fillPhaseInputs(excitation, times, phase.begin, phase.inputs.data());
    if (boundaries[i].event >= 0 && model_.directions > 0) {
      const VectorXd slopes = events.row(boundaries[i].event).tail(model_.directions);
      phase.begin_slopes.assign(slopes.begin(), slopes.end());
    }
  }
}

VectorXd LaneStart::solveEquilibrium(const Parameters& parameters) {
  rest_.setParameters(parameters);
  MatrixXd states = start_.calc({parameters}).head(model_.counts.states);
  if (box_center_.size() > 0) {
    states = insertSpeeds(box_center_, VectorXd::Zero(model_.coordinate_count));
  }
  assemble(parameters, states);
  return twinmap::solveEquilibrium(rest_, takeEquilibrium(states));
}

VectorXd solveBoxCenter(ModelContext& context, const LaneModel& model) {
  const std::optional<EquilibriumSpec>& equilibrium = context.model.initial.equilibrium;
  if (!equilibrium || equilibrium->at != EquilibriumAt::kBoxCenter) {
    return {};
  }
  context.numbers.update(calcBoxCenter(collectSampled(context.model)));
  const VectorXd none;
  return LaneStart(context.model, model, none).solveEquilibrium(calcEquilibriumPoint(context));
}

}  // namespace twinmap
